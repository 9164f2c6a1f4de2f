"""`rviz2`: the studio, opened at its 3-D view."""

import sys
from pathlib import Path

from daidalos.nodes.studio_window import parse, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    parser = studio_parser("rviz2", "The robot's world in 3-D, in the studio.")
    parser.add_argument("-d", "--display-config", metavar="FILE", help="a display config file (.rviz)")
    parser.add_argument("-f", "--fixed-frame", metavar="FRAME", default="", help="the fixed frame")
    parser.add_argument("-l", "--ogre-log", action="store_true", help="accepted, and without effect")
    parser.add_argument("-s", "--splash-screen", metavar="FILE", help="accepted, and without effect")
    parser.add_argument("--fullscreen", action="store_true", help="accepted; browsers have a key for that")
    arguments = parse(parser)
    config = arguments.display_config
    if config:
        if not Path(config).is_file():
            parser.error(f"there is no file '{config}'")
        print(f"rviz2: displays of '{config}' are not taken over; the studio shows what it finds", file=sys.stderr)
    details = {"fixed_frame": arguments.fixed_frame} if arguments.fixed_frame else {}
    return run_studio("rviz", "scene", arguments, **details)


if __name__ == "__main__":
    sys.exit(main())
