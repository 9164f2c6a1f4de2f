"""Reports on robots, models and worlds: trees, masses, implausible inertias, joints and limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.common.pose3 import Pose
from daidalos.description.inertia import implausibilities
from daidalos.description.joint import Joint, JointType
from daidalos.description.robot import Robot
from daidalos.description.tree import link_tree
from daidalos.description.world import Model, World


@dataclass(frozen=True)
class LinkReport:
    """Mass of a link [kg], None without inertial, and its implausible properties."""

    name: str
    mass: float | None
    implausibilities: tuple[str, ...]


@dataclass(frozen=True)
class JointReport:
    """Type, ends and limits of a joint as text."""

    name: str
    type: str
    parent: str
    child: str
    limits: str


@dataclass(frozen=True)
class RobotReport:
    """Summary of a robot or a model.

    Parameters
    ----------
    name : str
    tree : str
        Links indented below their parents, as ``check_urdf`` prints them.
    mass : float
        Of all links [kg].
    links, joints : tuple
    warnings : tuple of str
        What reading the robot noted.
    """

    name: str
    tree: str
    mass: float
    links: tuple[LinkReport, ...]
    joints: tuple[JointReport, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class PlacedReport:
    """Model in a world: its pose, whether it can move, and its summary."""

    pose: Pose
    static: bool
    model: RobotReport


@dataclass(frozen=True)
class WorldReport:
    """Summary of a world.

    Parameters
    ----------
    name : str
    step : float
        Of the physics [s].
    gravity : tuple of 3 floats
        [m/s^2].
    models : tuple of PlacedReport
    lights, actors, plugins : tuple of str
        Names; of plugins those of their files.
    warnings : tuple of str
        What reading the world noted.
    """

    name: str
    step: float
    gravity: tuple[float, float, float]
    models: tuple[PlacedReport, ...]
    lights: tuple[str, ...]
    actors: tuple[str, ...]
    plugins: tuple[str, ...]
    warnings: tuple[str, ...]


def report_world(world: World) -> WorldReport:
    """Return the summary of a world."""
    return WorldReport(
        name=world.name,
        step=world.physics.max_step_size,
        gravity=world.gravity,
        models=tuple(PlacedReport(model.pose, model.static, report(model)) for model in world.models),
        lights=tuple(light.name for light in world.lights),
        actors=tuple(actor.name for actor in world.actors),
        plugins=tuple(plugin.filename for plugin in world.plugins),
        warnings=world.warnings,
    )


def report(robot: Robot | Model) -> RobotReport:
    """Return the summary of a robot or a model."""
    links = tuple(
        LinkReport(link.name, None if link.inertial is None else link.inertial.mass, tuple(implausibilities(link)))
        for link in robot.links.values()
    )
    joints = tuple(
        JointReport(joint.name, joint.type.value, joint.parent, joint.child, limits_in_words(joint))
        for joint in robot.joints.values()
    )
    return RobotReport(
        name=robot.name,
        tree=tree_text(robot),
        mass=sum(link.mass or 0.0 for link in links),
        links=links,
        joints=joints,
        warnings=robot.warnings,
    )


def tree_text(robot: Robot | Model) -> str:
    """Return the tree of links in the format of ``check_urdf``; a model of SDF may have several trees."""
    tree = link_tree(robot)
    lines = [
        f"{'robot' if isinstance(robot, Robot) else 'model'} name is: {robot.name}",
        "---------- Successfully Parsed XML ---------------",
    ]
    for root in tree.roots:
        below = tree.children.get(root, ())
        lines.append(f"root Link: {root} has {len(below)} child(ren)")
        waiting = [(1, number, joint.child) for number, joint in enumerate(below, 1)][::-1]
        while waiting:
            depth, number, link = waiting.pop()
            lines.append(f"{'    ' * depth}child({number}):  {link}")
            waiting += [(depth + 1, i, joint.child) for i, joint in enumerate(tree.children.get(link, ()), 1)][::-1]
    return "\n".join(lines) + "\n"


def limits_in_words(joint: Joint) -> str:
    """Return the limits of a joint as text: position, velocity, effort, and the joint that it mimics."""
    words = []
    if joint.axes and joint.type in (JointType.REVOLUTE, JointType.PRISMATIC) and _is_bounded(joint):
        words.append(f"{joint.axis.lower:g} .. {joint.axis.upper:g} {_unit(joint)}")
    if joint.axes and math.isfinite(joint.axis.velocity):
        words.append(f"{joint.axis.velocity:g} {_unit(joint)}/s")
    if joint.axes and math.isfinite(joint.axis.effort):
        words.append(f"{joint.axis.effort:g} {'N' if joint.type is JointType.PRISMATIC else 'N m'}")
    if joint.mimic is not None:
        words.append(f"= {joint.mimic.multiplier:g} * {joint.mimic.joint} + {joint.mimic.offset:g}")
    return ", ".join(words)


def _is_bounded(joint: Joint) -> bool:
    return math.isfinite(joint.axis.lower) or math.isfinite(joint.axis.upper)


def _unit(joint: Joint) -> str:
    return "m" if joint.type is JointType.PRISMATIC else "rad"
