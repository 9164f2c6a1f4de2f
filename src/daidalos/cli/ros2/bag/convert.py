"""`ros2 bag convert`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.bags.errors import BagError
from daidalos.cli.ros2.bag.arguments import STORAGES, error, existing_file, input_bags, warn
from daidalos.cli.ros2.extension import Status, Verb


class ConvertVerb(Verb):
    """Given an input bag, write out a new bag with different settings."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        parser.add_argument(
            "-i",
            "--input",
            required=True,
            action="append",
            nargs="+",
            metavar=("uri", "storage_id"),
            help="Path, and perhaps the storage, of an input bag; may be given more than once. Storages are: "
            f"{', '.join(STORAGES)}",
        )
        parser.add_argument(
            "-o",
            "--output-options",
            required=True,
            type=existing_file,
            metavar="FILE",
            help="YAML file with the list 'output_bags': 'uri' of each, and its storage, compression and topics",
        )

    def main(self, *, args: Namespace) -> Status:
        """Write the bags."""
        from rosbag2_py._rewrite import bag_rewrite

        inputs = input_bags(args.input)
        try:
            with _Bar() as bar:
                notes = bag_rewrite(inputs, args.output_options, bar.show)
        except (BagError, ValueError) as fault:
            raise error(str(fault)) from None
        for note in notes:
            warn(note)
        return 0


class _Bar:
    """Progress bar on the terminal."""

    def __enter__(self) -> _Bar:
        import sys

        from rich.console import Console
        from rich.progress import Progress

        self._progress = Progress(
            console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty(), refresh_per_second=5
        )
        self._task = self._progress.add_task("messages", total=None)
        self._progress.start()
        return self

    def show(self, done: int, total: int) -> None:
        """Show the number of messages written."""
        self._progress.update(self._task, completed=done, total=total)

    def __exit__(self, *error: object) -> None:
        self._progress.stop()
