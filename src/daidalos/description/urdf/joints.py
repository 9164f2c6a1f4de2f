"""URDF's joints: types, axes, limits, mimic joints and safety controllers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from daidalos.description.joint import Axis, Calibration, Joint, JointType, Mimic, Safety
from daidalos.description.markup import Element
from daidalos.description.urdf.links import read_origin

_TYPES = tuple(JointType)[:6]
_AXIS_TYPES = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR)


def read_joints(root: Element, warnings: list[str]) -> dict[str, Joint]:
    """Return the joints by name; `warnings` gets a line for each skipped or non-standard element."""
    joints: dict[str, Joint] = {}
    for element in root.all("joint"):
        name = element.name()
        if name in joints:
            raise element.error("a joint of this name was defined before")
        joints[name] = _joint(element, warnings)
    for name, joint in joints.items():
        if joint.mimic is not None and joint.mimic.joint not in joints:
            warnings.append(f"{joint.where}: joint {name!r} mimics {joint.mimic.joint!r}, which does not exist")
            joints[name] = replace(joint, mimic=None)
    for name, joint in joints.items():
        if _follows_itself(joint, joints):
            warnings.append(f"{joint.where}: joint {name!r} mimics itself")
            joints[name] = replace(joint, mimic=None)
    return joints


def _follows_itself(joint: Joint, joints: Mapping[str, Joint]) -> bool:
    leader, steps = joint, 0
    while leader.mimic is not None and steps <= len(joints):
        leader, steps = joints[leader.mimic.joint], steps + 1
        if leader is joint:
            return True
    return False


def _joint(element: Element, warnings: list[str]) -> Joint:
    kind = _type(element, warnings)
    mimic = element.first("mimic")
    return Joint(
        name=element.name(),
        type=kind,
        parent=element.require("parent").attribute("link"),
        child=element.require("child").attribute("link"),
        origin=read_origin(element),
        axes=(_axis(element, kind, warnings),) if kind in _AXIS_TYPES else (),
        mimic=None if mimic is None else _mimic(mimic),
        safety=_safety(element.first("safety_controller")),
        calibration=_calibration(element.first("calibration")),
        where=element.where,
    )


def _type(element: Element, warnings: list[str]) -> JointType:
    word = element.attribute("type")
    if word == "spherical":
        warnings.append(f"{element.where}: a spherical joint is not of the standard and is read as Bullet does")
        return JointType.BALL
    if word not in _TYPES:
        raise element.error(f"unknown joint type {word!r}; known are {', '.join(_TYPES)}")
    return JointType(word)


def _axis(element: Element, kind: JointType, warnings: list[str]) -> Axis:
    child = element.first("axis")
    x, y, z = (1.0, 0.0, 0.0) if child is None else child.vector_attribute("xyz", 3)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0:
        raise element.error("the axis has no direction: xyz is 0 0 0")
    axis = Axis((x / length, y / length, z / length))
    limit, dynamics = element.first("limit"), element.first("dynamics")
    if dynamics is not None:
        axis = replace(
            axis,
            damping=dynamics.number_attribute("damping", 0.0),
            friction=dynamics.number_attribute("friction", 0.0),
        )
    if limit is None:
        if kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            raise element.error(f"a {kind} joint needs <limit>")
        return axis
    axis = replace(
        axis,
        effort=limit.number_attribute("effort", math.inf, finite=False),
        velocity=limit.number_attribute("velocity", math.inf, finite=False),
    )
    if kind is JointType.CONTINUOUS:
        return axis
    lower = limit.number_attribute("lower", 0.0, finite=False)
    upper = limit.number_attribute("upper", 0.0, finite=False)
    if lower > upper:
        warnings.append(f"{limit.where}: {element.label}: lower limit {lower:g} is above upper {upper:g}")
    return replace(axis, lower=lower, upper=upper)


def _mimic(element: Element) -> Mimic:
    return Mimic(
        joint=element.attribute("joint"),
        multiplier=element.number_attribute("multiplier", 1.0),
        offset=element.number_attribute("offset", 0.0),
    )


def _safety(element: Element | None) -> Safety | None:
    if element is None:
        return None
    return Safety(
        k_velocity=element.number_attribute("k_velocity"),
        k_position=element.number_attribute("k_position", 0.0),
        soft_lower_limit=element.number_attribute("soft_lower_limit", 0.0),
        soft_upper_limit=element.number_attribute("soft_upper_limit", 0.0),
    )


def _calibration(element: Element | None) -> Calibration | None:
    if element is None:
        return None
    edges = [element.number_attribute(key) if key in element.attributes else None for key in ("rising", "falling")]
    return Calibration(*edges)
