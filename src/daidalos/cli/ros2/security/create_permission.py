"""`ros2 security create_permission`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.keystore import Keystore
from daidalos.cli.ros2.keystore.policy import access_control
from daidalos.common.suggestions import did_you_mean


class CreatePermissionVerb(Verb):
    """Create permission."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("ROOT", type=Path, help="root path of keystore")
        parser.add_argument("NAME", help="enclave name")
        parser.add_argument("POLICY_FILE_PATH", type=Path, help="path of the policy xml file")

    def main(self, *, args: Namespace) -> Status:
        """Restrict the enclave's sessions to the permissions of the policy."""
        keystore = Keystore(args.ROOT)
        keystore.require()
        if args.NAME not in keystore.enclaves():
            return f"There is no enclave '{args.NAME}' in '{args.ROOT}'{did_you_mean(args.NAME, keystore.enclaves())}"
        keystore.configure_enclave(args.NAME, access_control(args.POLICY_FILE_PATH, args.NAME))
        print(f"creating permission file for enclave: '{args.NAME}'")
        return 0
