"""Command line of Gazebo classic's server, with parts shared by the simulators' other commands."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from importlib.metadata import version

_NEGATIVE = re.compile(r"-(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Read gzserver's arguments; what only Gazebo's own inside needs is accepted."""
    parser = argparse.ArgumentParser(prog="gzserver", description="Simulate a world.")
    parser.add_argument("world", nargs="?", default="", help="a world's file; an empty world by default")
    parser.add_argument("-u", "--pause", action="store_true", help="begin with time standing still")
    parser.add_argument("--verbose", action="store_true", help="say more")
    parser.add_argument("--version", action="version", version=f"Daidalos {version('daidalos')}")
    parser.add_argument("--seed", type=int, help="of all random numbers")
    parser.add_argument("--iters", type=int, metavar="STEPS", help="end after so many steps")
    parser.add_argument(
        "-s",
        "--server-plugin",
        action="append",
        default=[],
        metavar="PLUGIN",
        help="ignored: the ROS interface is built in",
    )
    for names in (
        ("-e", "--physics"),
        ("-o", "--profile"),
        ("-p", "--play"),
        ("-g", "--gui-client-plugin"),
        *((f"--record_{what}",) for what in ("encoding", "path", "period", "filter", "resources")),
    ):
        parser.add_argument(*names, help="accepted, without effect")
    for names in (("-r", "--record"), ("--lockstep",), ("--minimal_comms",)):
        parser.add_argument(*names, action="store_true", help="accepted, without effect")
    return parser.parse_args(list(words))


def bind_numbers(words: Sequence[str]) -> list[str]:
    """Write ``-x -1e-3`` as ``-x=-1e-3``: without it argparse takes a number with an exponent for an option."""
    bound: list[str] = []
    for word in words:
        if _NEGATIVE.fullmatch(word) and bound and bound[-1].startswith("-") and "=" not in bound[-1]:
            bound[-1] += f"={word}"
        else:
            bound.append(word)
    return bound
