"""`plotjuggler`: opens the studio at its plots."""

from daidalos.nodes.studio_window import parse, read_arrangement, run_studio, studio_parser
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.plotjuggler_layout import read_plotjuggler


def main() -> int:
    """Serve the studio and open it."""
    parser = studio_parser("plotjuggler", "Values over time, in the studio.")
    parser.add_argument("-l", "--layout", metavar="FILE", help="a layout file (.xml)")
    parser.add_argument("-n", "--nosplash", action="store_true", help="accepted, and not needed")
    parser.add_argument("-t", "--test", action="store_true", help="accepted, and without effect")
    arguments = parse(parser)
    arrangement: Arrangement | None = None
    details: dict[str, str] = {}
    if arguments.layout:
        arrangement, details = read_arrangement(arguments.layout, read_plotjuggler, parser)
    return run_studio("plotjuggler", "plot", arguments, arrangement, **details)
