"""`ros2 security create_keystore`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.keystore import Keystore


class CreateKeystoreVerb(Verb):
    """Create keystore."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("ROOT", type=Path, help="root path of keystore")

    def main(self, *, args: Namespace) -> Status:
        """Create the keystore."""
        keystore = Keystore(args.ROOT)
        if keystore.exists:
            return f"'{args.ROOT}' is already a keystore"
        keystore.create()
        print(f"creating keystore: {args.ROOT}")
        print("creating new CA key/cert pair")
        print(f"all done! enjoy your keystore in {args.ROOT}")
        return 0
