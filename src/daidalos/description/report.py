"""What there is to say about a robot: its tree, masses, doubts about inertias, joints and limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.description.inertia import doubts
from daidalos.description.joint import Joint, JointType
from daidalos.description.robot import Robot


@dataclass(frozen=True)
class LinkReport:
    """A link's mass [kg], None without inertial, and what is doubtful about it."""

    name: str
    mass: float | None
    doubts: tuple[str, ...]


@dataclass(frozen=True)
class JointReport:
    """A joint's type, ends and limits in words."""

    name: str
    type: str
    parent: str
    child: str
    limits: str


@dataclass(frozen=True)
class RobotReport:
    """A robot at a glance.

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


def report(robot: Robot) -> RobotReport:
    """Return what there is to say about a robot."""
    links = tuple(
        LinkReport(link.name, None if link.inertial is None else link.inertial.mass, tuple(doubts(link)))
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


def tree_text(robot: Robot) -> str:
    """Return the tree of links in the form of ``check_urdf``."""
    children: dict[str, list[str]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint.child)
    lines = [
        f"robot name is: {robot.name}",
        "---------- Successfully Parsed XML ---------------",
        f"root Link: {robot.root} has {len(children.get(robot.root, ()))} child(ren)",
    ]
    waiting = [(1, number, child) for number, child in enumerate(children.get(robot.root, ()), 1)][::-1]
    while waiting:
        depth, number, link = waiting.pop()
        lines.append(f"{'    ' * depth}child({number}):  {link}")
        waiting += [(depth + 1, i, child) for i, child in enumerate(children.get(link, ()), 1)][::-1]
    return "\n".join(lines) + "\n"


def limits_in_words(joint: Joint) -> str:
    """Return what bounds a joint: position, speed, effort, and whom it follows."""
    words = []
    if joint.axes and joint.type in (JointType.REVOLUTE, JointType.PRISMATIC):
        words.append(f"{joint.axis.lower:g} .. {joint.axis.upper:g} {_unit(joint)}")
    if joint.axes and math.isfinite(joint.axis.velocity):
        words.append(f"{joint.axis.velocity:g} {_unit(joint)}/s")
    if joint.axes and math.isfinite(joint.axis.effort):
        words.append(f"{joint.axis.effort:g} {'N' if joint.type is JointType.PRISMATIC else 'N m'}")
    if joint.mimic is not None:
        words.append(f"= {joint.mimic.multiplier:g} * {joint.mimic.joint} + {joint.mimic.offset:g}")
    return ", ".join(words)


def _unit(joint: Joint) -> str:
    return "m" if joint.type is JointType.PRISMATIC else "rad"
