"""Program of the command `daidalos`: its verbs are imported when they are called."""

from __future__ import annotations

import sys
from argparse import Action, ArgumentParser, Namespace
from collections.abc import Sequence
from typing import Any

from ros2cli.extensions import Extensions, built_in
from ros2cli.parser import Parser

from daidalos.cli.daidalos.launching import INTERRUPTED
from daidalos.common.errors import UserError
from daidalos.common.extensions import ExtensionError, Kind

_DESCRIPTIONS = {
    "arm": "Compute poses, joint angles and configurations of industrial robots",
    "assist": "Lead a worker through a sequence with lights and projectors",
    "bench": "Run a scenario many times, with other seeds and parameters",
    "demo": "A robot that maps an arena and drives where it is sent",
    "diff": "Compare two bags, message by message",
    "extensions": "List what can be extended, and the extensions that are there",
    "grind": "Control the force of a grinder, finish plates and remove excess material",
    "light": "Point a moving head at places of a work cell",
    "map": "Build a map from the log of a robot",
    "rapid": "Check, format, run, trace and write programs of ABB robots",
    "scenario": "Run scenarios in lock-step, and look at those that failed",
    "sim": "Simulate a world",
    "studio": "Open the studio on the graph, on a bag, with a layout or at a panel",
    "urdf": "Look at a robot, a model or a world: tree, masses, inertias, limits",
    "weld": "Correct the paths of welding robots, and follow seams",
}
VERBS: Kind[Any] = Kind(
    "daidalos_verb",
    "daidalos.verbs",
    "ros2cli.subcommand:Subcommand",
    "a verb of the command `daidalos`",
    lambda: built_in(_DESCRIPTIONS, __package__ or "", "Verb"),
)


def run(argv: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    name = "daidalos"
    try:
        parser = Parser(
            prog="daidalos", description="ROS 2 without installing ROS. The graph's own commands are under `ros2`."
        )
        parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
        parser.add_subcommands("verbs", "daidalos", Extensions(VERBS), _complete)
        args = parser.parse_args(sys.argv[1:] if argv is None else list(argv))
        if not hasattr(args, "_main"):
            parser.print_help()
            return 0
        name = args._name
        return int(args._main(args) or 0)
    except UserError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1 if isinstance(error, ExtensionError) else 2
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
        return 1


def _complete(verb: Any, parser: Parser, name: str) -> None:
    """Complete the parser of a verb."""
    parser.set_defaults(_main=lambda args: verb.main(args=args), _name=parser.prog)
    verb.add_arguments(parser, name)


class _Version(Action):
    """Option that prints the version and exits."""

    def __call__(self, parser: ArgumentParser, namespace: Namespace, values: Any, option_string: Any = None) -> None:
        from daidalos import __version__

        print(f"daidalos {__version__}")
        parser.exit()
