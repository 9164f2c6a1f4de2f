"""The command `daidalos`: its verbs, each imported when it is called."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

VERBS = {
    "demo": ("daidalos.cli.daidalos.demo", "a robot that maps an arena and drives where it is sent"),
    "sim": ("daidalos.cli.daidalos.sim", "simulate a world"),
    "urdf": ("daidalos.cli.daidalos.urdf", "look at a robot description"),
    "map": ("daidalos.cli.daidalos.map", "build a map from the log of a robot"),
}
ENTRY_POINTS = "daidalos.command"
"""Group of entry points by which packages add verbs: verb = module with HELP, add_arguments and main."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if arguments[:1] == ["--version"]:
        from daidalos import __version__

        print(f"daidalos {__version__}")
        return 0
    if not arguments or arguments[0] in ("-h", "--help"):
        _usage().print_help()
        return 0
    module = _verb(arguments[0])
    if module is None:
        return _unknown(arguments[0])
    parser = argparse.ArgumentParser(prog=f"daidalos {arguments[0]}", description=module.HELP)
    module.add_arguments(parser)
    try:
        return int(module.main(parser.parse_args(arguments[1:])))
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        sys.stderr.close()
        return 1


def _verb(name: str) -> Any:
    if name in VERBS:
        return import_module(VERBS[name][0])
    for point in entry_points(group=ENTRY_POINTS, name=name):
        return point.load()
    return None


def _usage() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="daidalos",
        description="ROS 2 without installing ROS. The graph's own commands are under `ros2`.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="\n".join(["verbs:", *(f"  {verb:<10} {text}" for verb, (_, text) in VERBS.items())]),
    )
    parser.add_argument("verb", nargs="?", help="what to do; `daidalos VERB --help` says more")
    parser.add_argument("--version", action="store_true", help="print the version")
    return parser


def _unknown(name: str) -> int:
    from difflib import get_close_matches

    known = [*VERBS, *(point.name for point in entry_points(group=ENTRY_POINTS))]
    near = get_close_matches(name, known, n=1)
    hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(known)}"
    print(f"daidalos: there is no verb '{name}'; {hint}", file=sys.stderr)
    return 2
