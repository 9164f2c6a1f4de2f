"""`daidalos urdf`: report on a robot, a model or a world, and check whether it can be simulated."""

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.description.link import Link, Visual
    from daidalos.description.report import PlacedReport, RobotReport, WorldReport
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model, World


class UrdfVerb:
    """Look at a robot, a model or a world: tree, masses, inertias, limits."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos urdf`."""
        parser.add_argument("file", type=Path, help="a file in URDF, xacro or SDF, or a folder with a model.config")
        parser.add_argument("mappings", nargs="*", metavar="NAME:=VALUE", help="arguments of the xacro file")
        parser.add_argument("--check", action="store_true", help="also load it into the simulator; print errors only")
        parser.add_argument("--svg", type=Path, metavar="FILE", help="draw its tree")
        parser.add_argument("--json", action="store_true", help="print one JSON object")

    def main(self, *, args: argparse.Namespace) -> int:
        """Check a description; return 0 if it is usable, else 2."""
        from daidalos.description.errors import DescriptionError
        from daidalos.simulation.errors import SimulationError

        try:
            description = _load(args)
            warnings = list(_simulated(description) if args.check else description.warnings)
            if args.svg:
                _draw(description, args.svg)
        except (DescriptionError, SimulationError, OSError, ValueError) as error:
            print(f"error: {error}", file=sys.stderr)
            return 2
        for line in dict.fromkeys(warnings):
            print(f"warning: {line}", file=sys.stderr)
        if not args.check:
            _print_report(description, args.json)
        return 0


def _load(args: argparse.Namespace) -> "Robot | Model | World":
    from daidalos.description import urdf
    from daidalos.nodes.packages import package_share

    mappings: dict[str, str] = {}
    for word in args.mappings:
        name, separator, value = word.partition(":=")
        if not separator:
            raise ValueError(f"'{word}' is not an argument; write name:=value")
        mappings[name] = value
    if args.file.is_dir() or _is_sdf(args.file):
        return _load_sdf(args.file, mappings)
    return urdf.load(args.file, mappings, package_share)


def _is_sdf(path: Path) -> bool:
    """Return whether a file is SDF, possibly through xacro, by its root element; unreadable files are not."""
    from daidalos.description.errors import DescriptionError
    from daidalos.description.markup import parse_markup

    try:
        return parse_markup(path.read_bytes(), str(path)).tag in ("sdf", "gazebo")
    except (DescriptionError, OSError):
        return path.name.removesuffix(".xacro").endswith((".sdf", ".world"))


def _load_sdf(path: Path, mappings: dict[str, str]) -> "Model | World":
    from daidalos.description import sdf
    from daidalos.nodes.packages import package_share

    if path.is_dir():
        return sdf.load_model(path, package_share)
    if path.suffix == ".xacro":
        from daidalos.description.xacro import load_xacro

        text: str | bytes = load_xacro(path, mappings, package_share)
    else:
        text = path.read_bytes()
    return sdf.parse_any(text, str(path), package_share, strict=False)


def _simulated(description: "Robot | Model | World") -> list[str]:
    """Load a world, or a robot or model into an empty world, simulate ten steps and return the warnings.

    As in Gazebo a mesh or an image that is missing or broken is no more than a warning.
    """
    from daidalos.common.pose3 import Pose
    from daidalos.description.world import World
    from daidalos.simulation import Simulation

    world = description if isinstance(description, World) else None
    simulation = Simulation(world, has_subscribers=lambda topic: False, warn=lambda line: None)
    if not isinstance(description, World):
        simulation.spawn(description, pose=Pose((0.0, 0.0, 10.0)))
    simulation.step(10)
    unseen = [line for link in _links(description) for visual in link.visuals for line in _unseen(visual, link.where)]
    return list(dict.fromkeys([*unseen, *simulation.warnings]))


def _links(description: "Robot | Model | World") -> "Iterator[Link]":
    from daidalos.description.world import World

    if isinstance(description, World):
        for model in (*description.models, *(actor.model for actor in description.actors)):
            yield from model.links.values()
    else:
        yield from description.links.values()


def _unseen(visual: "Visual", where: str) -> list[str]:
    """Return warnings about visuals, which no camera renders in a check."""
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


def _draw(description: "Robot | Model | World", path: Path) -> None:
    from daidalos.description.graph import to_svg
    from daidalos.description.world import World

    if isinstance(description, World):
        raise ValueError("a world has no tree to draw; draw one of its models")
    path.write_text(to_svg(description), encoding="utf-8")


def _print_report(description: "Robot | Model | World", as_json: bool) -> None:
    from daidalos.description.report import report, report_world
    from daidalos.description.world import World

    if isinstance(description, World):
        world = report_world(description)
        print(json.dumps(asdict(world)) if as_json else _world_text(world))
    else:
        found = report(description)
        print(json.dumps(asdict(found)) if as_json else _text(found))


def _text(found: "RobotReport") -> str:
    lines = [found.tree, f"mass: {found.mass:.6g} kg in {len(found.links)} links, {len(found.joints)} joints", ""]
    masses = [(link.name, "-" if link.mass is None else f"{link.mass:.6g}") for link in found.links]
    lines += _table(("link", "mass [kg]"), masses)
    if found.joints:
        rows = [(j.name, j.type, f"{j.parent} -> {j.child}", j.limits) for j in found.joints]
        lines += ["", *_table(("joint", "type", "between", "limits"), rows)]
    return "\n".join(
        lines + _implausibilities(f"  {link.name}: {doubt}" for link in found.links for doubt in link.implausibilities)
    )


def _world_text(found: "WorldReport") -> str:
    gravity = ", ".join(f"{value:g}" for value in found.gravity)
    lines = [f"world name is: {found.name}", f"step: {found.step:g} s, gravity: {gravity} m/s^2"]
    named = (("lights", found.lights), ("actors", found.actors), ("plugins", found.plugins))
    lines += [f"{word}: {', '.join(names)}" for word, names in named if names]
    if found.models:
        lines += ["", *_table(("model", "position", "mass [kg]", "links", "joints"), map(_model_row, found.models))]
    return "\n".join(
        lines
        + _implausibilities(
            f"  {placed.model.name}::{link.name}: {doubt}"
            for placed in found.models
            if not placed.static
            for link in placed.model.links
            for doubt in link.implausibilities
        )
    )


def _model_row(placed: "PlacedReport") -> tuple[str, ...]:
    model = placed.model
    position = " ".join(f"{round(value, 3) + 0.0:g}" for value in placed.pose.position)
    mass = "static" if placed.static else f"{model.mass:.6g}"
    return model.name, position, mass, str(len(model.links)), str(len(model.joints))


def _implausibilities(lines: Iterable[str]) -> list[str]:
    found = list(lines)
    return ["", "doubtful inertias:", *found] if found else []


def _table(heads: tuple[str, ...], rows: Iterable[Any]) -> list[str]:
    lines = [heads, *rows]
    widths = [max(len(row[column]) for row in lines) for column in range(len(heads))]
    return ["  ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip() for row in lines]
