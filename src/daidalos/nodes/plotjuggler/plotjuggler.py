"""`plotjuggler`: the studio, opened at its plots."""

import sys
from pathlib import Path

from daidalos.nodes.studio_window import parse, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    parser = studio_parser("plotjuggler", "Values over time, in the studio.")
    parser.add_argument("-l", "--layout", metavar="FILE", help="a layout file (.xml)")
    parser.add_argument("-n", "--nosplash", action="store_true", help="accepted, and not needed")
    parser.add_argument("-t", "--test", action="store_true", help="accepted, and without effect")
    arguments = parse(parser)
    if arguments.layout:
        if not Path(arguments.layout).is_file():
            parser.error(f"there is no file '{arguments.layout}'")
        print(f"plotjuggler: curves of '{arguments.layout}' are not taken over", file=sys.stderr)
    return run_studio("plotjuggler", "plot", arguments)


if __name__ == "__main__":
    sys.exit(main())
