"""`gz_sim`: simulator with gz's command line; it starts paused unless told to run."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence

from daidalos.nodes.gazebo_ros._worlds import find_world
from daidalos.nodes.gazebo_ros.gzserver import Start, serve
from daidalos.nodes.runner import program_arguments

_DEBUG = 4
_WITH_VALUE = (
    *("--gui-config", "--initial-sim-time", "--network-role", "--network-secondaries", "--playback", "--record-path"),
    *("--record-topic", "--record-period", "--physics-engine", "--render-engine", "--render-engine-gui"),
    *("--render-engine-server", "--render-engine-api-backend", "--render-engine-gui-api-backend"),
    *("--render-engine-server-api-backend", "--force-version"),
)
_ALONE = (
    *("--headless-rendering", "--levels", "--log-overwrite", "--log-compress", "--record", "--record-resources"),
    *("--wait-for-assets", "--same-process"),
)


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Read gz's arguments; one word may hold several, as launch files write them."""
    parser = argparse.ArgumentParser(prog="gz_sim", description="Simulate a world.")
    parser.add_argument("world", nargs="?", default="", help="an SDF file; an empty world by default")
    parser.add_argument("-r", dest="run", action="store_true", help="let time go on from the start")
    parser.add_argument("-s", dest="server", action="store_true", help="no view, which is served apart anyway")
    parser.add_argument("-v", "--verbose", nargs="?", const=3, type=int, default=1, help="how much to say, 0 to 4")
    parser.add_argument("-z", dest="rate", type=float, metavar="HZ", help="steps in a second; 0: as many as can be")
    parser.add_argument("--iterations", type=int, metavar="STEPS", help="end after so many steps")
    parser.add_argument("--seed", type=int, help="of all random numbers")
    for name in _WITH_VALUE:
        parser.add_argument(name, help="accepted, without effect")
    for name in _ALONE:
        parser.add_argument(name, action="store_true", help="accepted, without effect")
    return parser.parse_args([part for word in words for part in shlex.split(_apart(word))])


def _apart(words: str) -> str:
    """Write ``-v4`` as ``-v 4``."""
    return " ".join(f"-v {word[2:]}" if word[:2] == "-v" and word[2:].isdigit() else word for word in words.split())


def main() -> int:
    """Run the node."""
    arguments = parse(program_arguments())
    try:
        world = find_world(arguments.world)
    except FileNotFoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    start = Start(world, not arguments.run, arguments.rate, arguments.iterations)
    return serve(start, arguments.seed, arguments.verbose >= _DEBUG)
