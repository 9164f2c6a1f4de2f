"""`ros2 security list_enclaves`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.keystore import Keystore


class ListEnclavesVerb(Verb):
    """List enclaves in keystore."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("ROOT", type=Path, help="root path of keystore")

    def main(self, *, args: Namespace) -> Status:
        """Print the names of the enclaves."""
        keystore = Keystore(args.ROOT)
        keystore.require()
        for name in keystore.enclaves():
            print(name)
        return 0
