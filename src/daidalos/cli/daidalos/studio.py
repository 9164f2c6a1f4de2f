"""`daidalos studio`: the studio on the running graph, and beside a bag that is played."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint

if TYPE_CHECKING:
    from daidalos.studio.arrangement import Arrangement

_PLAYER_PANEL = "bag_player"


class StudioVerb:
    """Open the studio on the graph, on a bag, with a layout or at a panel."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos studio`."""
        parser.add_argument(
            "--port", type=int, default=8765, metavar="N", help="the page's, or the next free one above (default: 8765)"
        )
        parser.add_argument("--host", metavar="ADDRESS", help="address to listen on (default: this machine alone)")
        parser.add_argument("--layout", type=Path, metavar="FILE", help="file of RViz (.rviz) or PlotJuggler (.xml)")
        parser.add_argument("--bag", type=Path, metavar="BAG", help="bag to play, again and again, with its time line")
        parser.add_argument("--open", metavar="PANEL", help="open one panel, such as plot or graph")
        parser.add_argument(
            "--no-browser", dest="headless", action="store_true", help="print the page's address, open nothing"
        )
        self._parser = parser

    def main(self, *, args: argparse.Namespace) -> int:
        """Serve the studio until Ctrl-C."""
        from daidalos.distribution import complete_environment

        panel = _check_panel(args.open) if args.open else ""
        companion = _player_command(args.bag) if args.bag else None
        arrangement: Arrangement | None = None
        details: dict[str, str] = {}
        if args.layout:
            arrangement, details = self._read_layout(args.layout)
            panel = panel or ("plot" if arrangement.tabs else "scene")
        complete_environment()
        from daidalos.nodes.studio_window import run_studio
        from daidalos.studio.guarded_server import LOOPBACK

        return run_studio(
            "daidalos_studio",
            panel,
            args,
            arrangement,
            front=_PLAYER_PANEL if companion and not panel else "",
            hosts=(args.host,) if args.host else LOOPBACK,
            companion=companion,
            **details,
        )

    def _read_layout(self, path: Path) -> tuple[Arrangement, dict[str, str]]:
        from daidalos.nodes.studio_window import read_arrangement
        from daidalos.studio.plotjuggler_layout import read_plotjuggler
        from daidalos.studio.rviz_config import read_rviz

        readers = {".rviz": read_rviz, ".xml": read_plotjuggler}
        if path.suffix not in readers:
            raise UserError(
                f"'{path}': expected a file .rviz or .xml; the page itself opens its layouts by File > Open"
            )
        return read_arrangement(str(path), readers[path.suffix], self._parser)


def _check_panel(name: str) -> str:
    """Return the name of a panel of the page or of an installed package; refuse any other."""
    from daidalos.common.extensions import listing
    from daidalos.studio.extensions import PANELS

    known = [each for extension in listing(PANELS) for each in extension.names]
    if name not in known:
        raise UserError(f"there is no panel '{name}'{hint(name, known)}")
    return name


def _player_command(bag: Path) -> list[str]:
    """Return the command that plays a bag, after a look whether it can be read."""
    from daidalos.bags.errors import BagError
    from daidalos.bags.reader import BagReader

    if not bag.exists():
        raise UserError(f"there is no bag at '{bag}'")
    words = ["-m", "daidalos.cli.ros2", "bag", "play", str(bag), "--loop", "--disable-keyboard-controls"]
    words += ["--progress-bar-update-rate", "0"]
    try:
        with BagReader(bag) as reader:
            if not reader.metadata.message_count:
                raise UserError(f"the bag '{bag}' holds no messages")
            if "/clock" not in reader.topics:  # else there would be two clocks
                words.append("--clock")
    except BagError as error:
        raise UserError(str(error)) from None
    return [sys.executable, *words]
