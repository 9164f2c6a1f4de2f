"""`ros2 security create_enclave`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.keystore import Keystore


class CreateEnclaveVerb(Verb):
    """Create enclave."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("ROOT", type=Path, help="root path of keystore")
        parser.add_argument("NAME", help="enclave name")

    def main(self, *, args: Namespace) -> Status:
        """Create the enclave's certificate, and print how to use it."""
        keystore = Keystore(args.ROOT)
        keystore.require()
        folder = keystore.enclave(args.NAME)
        if folder.exists():
            return f"The enclave '{args.NAME}' exists already in '{args.ROOT}'"
        print(f"creating key for enclave: '{args.NAME}'")
        print("creating cert and key")
        keystore.create_enclave(args.NAME)
        print(f"enter it with ZENOH_SESSION_CONFIG_URI={folder.resolve() / 'session.json5'}")
        return 0
