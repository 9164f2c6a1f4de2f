"""`rviz2`: the studio, opened at its 3-D view."""

from daidalos.nodes.studio_window import parse, read_arrangement, run_studio, studio_parser
from daidalos.studio.rviz_config import read_rviz


def main() -> int:
    """Serve the studio and open it."""
    parser = studio_parser("rviz2", "The robot's world in 3-D, in the studio.")
    parser.add_argument("-d", "--display-config", metavar="FILE", help="a display config file (.rviz)")
    parser.add_argument("-f", "--fixed-frame", metavar="FRAME", default="", help="the fixed frame")
    parser.add_argument("-l", "--ogre-log", action="store_true", help="accepted, and without effect")
    parser.add_argument("-s", "--splash-screen", metavar="FILE", help="accepted, and without effect")
    parser.add_argument("--fullscreen", action="store_true", help="accepted; browsers have a key for that")
    arguments = parse(parser)
    details = {"fixed_frame": arguments.fixed_frame} if arguments.fixed_frame else {}
    arrangement = None
    if arguments.display_config:
        arrangement, named = read_arrangement(arguments.display_config, read_rviz, parser)
        details |= named
    return run_studio("rviz", "scene", arguments, arrangement, **details)
