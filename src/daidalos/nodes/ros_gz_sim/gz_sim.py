"""`gz_sim`: the simulator with gz's command line; it begins paused unless it is told to run."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from rclpy.utilities import remove_ros_args

from daidalos.description.resolve import default_model_path
from daidalos.nodes.gazebo_ros.gzserver import serve
from daidalos.nodes.packages import package_share


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Read gz's arguments; one word may hold several, as launch files write them."""
    parser = argparse.ArgumentParser(prog="gz_sim", description="Simulate a world.")
    parser.add_argument("world", nargs="?", default="", help="an SDF file; an empty world by default")
    parser.add_argument("-r", dest="run", action="store_true", help="let time go on from the start")
    parser.add_argument("-s", dest="server", action="store_true", help="no view, which is served apart anyway")
    parser.add_argument("-v", "--verbose", nargs="?", const=3, type=int, default=1, help="how much to say, 0 to 4")
    parser.add_argument("-z", dest="rate", type=float, help="accepted, without effect")
    parser.add_argument("--iterations", type=int, help="accepted, without effect")
    parser.add_argument("--seed", type=int, default=0, help="of all random numbers")
    parser.add_argument("--headless-rendering", action="store_true", help="accepted: nothing else is done")
    parser.add_argument("--physics-engine", help="accepted, without effect")
    parser.add_argument("--render-engine", help="accepted, without effect")
    parser.add_argument("--force-version", help="accepted, without effect")
    return parser.parse_args([part for word in words for part in shlex.split(_apart(word))])


def _apart(words: str) -> str:
    """Write ``-v4`` as ``-v 4``."""
    return " ".join(f"-v {word[2:]}" if word[:2] == "-v" and word[2:].isdigit() else word for word in words.split())


def find_world(name: str) -> Path | None:
    """Return the file of a world: as it is, in gz's resource paths, or among packages' worlds; None is empty.

    Raises
    ------
    FileNotFoundError
    """
    if name in ("", "empty.sdf"):
        return None
    places = [Path(), *default_model_path(), *_worlds()]
    found = next((place / name for place in places if (place / name).is_file()), None)
    if found is None:
        raise FileNotFoundError(f"there is no world file '{name}'")
    return found


def _worlds() -> list[Path]:
    return [Path(share) / "worlds" for share in map(package_share, ("ros_gz_sim", "turtlebot3_gazebo")) if share]


def main() -> int:
    """Run the node."""
    arguments = parse(remove_ros_args(sys.argv)[1:])
    try:
        world = find_world(arguments.world)
    except FileNotFoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return serve(world, not arguments.run, arguments.seed)


if __name__ == "__main__":
    sys.exit(main())
