"""`daidalos urdf`: what there is to say about a robot description, and whether it can be simulated."""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.description.link import Visual
    from daidalos.description.report import RobotReport
    from daidalos.description.robot import Robot

HELP = "look at a robot description: tree, masses, inertias, limits"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `daidalos urdf` takes."""
    parser.add_argument("file", type=Path, help="a URDF or xacro file")
    parser.add_argument("mappings", nargs="*", metavar="NAME:=VALUE", help="arguments of the xacro file")
    parser.add_argument("--check", action="store_true", help="also load it into the simulator; says nothing but faults")
    parser.add_argument("--svg", type=Path, metavar="FILE", help="draw its tree")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def main(args: argparse.Namespace) -> int:
    """Look at a description; returns 0 when it can be used, 2 when not."""
    from daidalos.description.errors import DescriptionError
    from daidalos.simulation.errors import SimulationError

    try:
        robot = _load(args)
        warnings = list(_simulated(robot) if args.check else robot.warnings)
        if args.svg:
            _draw(robot, args.svg)
    except (DescriptionError, SimulationError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    for line in dict.fromkeys(warnings):
        print(f"warning: {line}", file=sys.stderr)
    if not args.check:
        from daidalos.description.report import report

        found = report(robot)
        print(json.dumps(asdict(found)) if args.json else _text(found))
    return 0


def _load(args: argparse.Namespace) -> "Robot":
    from daidalos.description import urdf
    from daidalos.nodes.packages import package_share

    mappings: dict[str, str] = {}
    for word in args.mappings:
        name, separator, value = word.partition(":=")
        if not separator:
            raise ValueError(f"'{word}' is no argument; write name:=value")
        mappings[name] = value
    return urdf.load(args.file, mappings, package_share)


def _simulated(robot: "Robot") -> list[str]:
    """Load the robot into an empty world, make ten steps, and return what was warned of.

    As in Gazebo a mesh or an image that is missing or broken is no more than a warning.
    """
    from daidalos.description.pose import Pose
    from daidalos.simulation import Simulation

    simulation = Simulation(heard=lambda topic: False, warn=lambda line: None)
    simulation.spawn(robot, pose=Pose((0.0, 0.0, 10.0)))
    simulation.step(10)
    unseen = [line for link in robot.links.values() for visual in link.visuals for line in _unseen(visual, link.where)]
    return [*unseen, *simulation.warnings]


def _unseen(visual: "Visual", where: str) -> list[str]:
    """Return what of a visual can not be shown, since no camera looks at it in a check."""
    from daidalos.description.errors import DescriptionError
    from daidalos.description.visuals import visual_parts

    image = visual.material.texture if visual.material is not None else ""
    if image and visual.material is not None and visual.material.texture_path is None:
        return [f"{where}: image {image} not found"]
    try:
        visual_parts(visual)
    except DescriptionError as problem:
        place = "" if problem.source else f"{where}: "
        return [f"{place}{problem}; the visual is not drawn"]
    return []


def _draw(robot: "Robot", path: Path) -> None:
    from daidalos.description.graph import to_svg

    path.write_text(to_svg(robot), encoding="utf-8")


def _text(found: "RobotReport") -> str:
    lines = [found.tree, f"mass: {found.mass:.6g} kg in {len(found.links)} links, {len(found.joints)} joints", ""]
    masses = [(link.name, "-" if link.mass is None else f"{link.mass:.6g}") for link in found.links]
    lines += _table(("link", "mass [kg]"), masses)
    lines += [""]
    rows = [(j.name, j.type, f"{j.parent} -> {j.child}", j.limits) for j in found.joints]
    lines += _table(("joint", "type", "between", "limits"), rows)
    doubts = [f"  {link.name}: {doubt}" for link in found.links for doubt in link.doubts]
    return "\n".join(lines + (["", "doubtful inertias:", *doubts] if doubts else []))


def _table(heads: tuple[str, ...], rows: list[Any]) -> list[str]:
    widths = [max(len(row[column]) for row in [heads, *rows]) for column in range(len(heads))]
    return [
        "  ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip() for row in [heads, *rows]
    ]
