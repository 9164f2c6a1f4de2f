"""`ros2 security generate_artifacts`."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.keystore import Keystore
from daidalos.cli.ros2.keystore.policy import access_control, enclave_paths


class GenerateArtifactsVerb(Verb):
    """Generate keys and permission files from a list of identities and policy files."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("-k", "--keystore-root-path", type=Path, help="root path of keystore")
        parser.add_argument(
            "-e", "--enclaves", nargs="*", default=[], help="list of identities, aka ROS security enclaves"
        )
        parser.add_argument(
            "-p", "--policy-files", nargs="*", type=Path, default=[], help="list of policy xml file paths"
        )

    def main(self, *, args: Namespace) -> Status:
        """Create missing enclaves, and set the permissions of all enclaves in the policies."""
        root = args.keystore_root_path or os.environ.get("ROS_SECURITY_KEYSTORE")
        if not root:
            raise CliError("Neither --keystore-root-path nor ROS_SECURITY_KEYSTORE names the keystore")
        keystore = Keystore(Path(root))
        policies = {name: file for file in args.policy_files for name in enclave_paths(file)}
        if not keystore.exists:
            print(f"{root} is not a keystore, creating new keystore")
            keystore.create()
        for name in dict.fromkeys([*args.enclaves, *policies]):
            if name not in keystore.enclaves():
                print(f"creating key for enclave: '{name}'")
                keystore.create_enclave(name)
        for name, file in policies.items():
            print(f"creating permission file for enclave: '{name}'")
            keystore.configure_enclave(name, access_control(file, name))
        return 0
