"""Conversion of joints to MuJoCo's.

MuJoCo's joints live in the child body, so that each is written in the child link's frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import mujoco

from daidalos.common.pose3 import Pose, Vector, quaternion_between, rotate
from daidalos.description.joint import Axis, Joint, JointType

_Type = mujoco.mjtJoint

_LIMIT_SOLREF = (0.01, 1.0)
_FAR = 1e6
_LOCKED = 1e-5


def add_joints(body: Any, joint: Joint, name: str) -> list[str]:
    """Add a joint to the body of its child link.

    Parameters
    ----------
    body : MjsBody
    joint : Joint
    name : str
        Name of the first degree of freedom; further ones get ``#2``, ``#3``.

    Returns
    -------
    list of str
        Names of MuJoCo's joints; none for a fixed one.
    """
    return _ADDERS[joint.type](body, joint, name)


def limits_of(axis: Axis) -> tuple[float, float]:
    """Return the limits of a joint in ascending order, widened if they coincide."""
    lower, upper = sorted((axis.lower, axis.upper))
    return (lower - _LOCKED, upper + _LOCKED) if upper - lower < _LOCKED else (lower, upper)


def start_position(axis: Axis) -> float:
    """Return the position within the limits that is nearest to zero."""
    lower, upper = limits_of(axis)
    return min(max(0.0, lower), upper)


def mimicked_start(joint: Joint, joints: Mapping[str, Joint]) -> float:
    """Return the initial position of a mimic joint, so that its coupling starts without an error."""
    scale, offset, seen = 1.0, 0.0, {joint.name}
    while joint.mimic is not None and joint.mimic.joint not in seen:
        offset += scale * joint.mimic.offset
        scale *= joint.mimic.multiplier
        joint = joints[joint.mimic.joint]
        seen.add(joint.name)
    return offset + scale * start_position(joint.axis)


def _add(body: Any, kind: Any, axis: Axis, joint: Joint, name: str) -> str:
    added = body.add_joint(
        name=name,
        type=kind,
        pos=list(joint.anchor.position),
        axis=list(rotate(joint.anchor.orientation, axis.xyz)),
        damping=[axis.damping, 0.0, 0.0],
        frictionloss=axis.friction,
    )
    if axis.spring_stiffness:
        added.stiffness = [axis.spring_stiffness, 0.0, 0.0]
        added.springref = axis.spring_reference
    lower, upper = limits_of(axis)
    if math.isfinite(lower) or math.isfinite(upper):
        # MuJoCo limits both sides or none.
        added.limited = mujoco.mjtLimited.mjLIMITED_TRUE
        added.range = [max(min(lower, _FAR - 1), -_FAR), min(max(upper, 1 - _FAR), _FAR)]
        added.solref_limit[:2] = _LIMIT_SOLREF
    return name


def _fixed(_body: Any, _joint: Joint, _name: str) -> list[str]:
    return []


def _hinge(body: Any, joint: Joint, name: str) -> list[str]:
    return [_add(body, _Type.mjJNT_HINGE, joint.axis, joint, name)]


def _slide(body: Any, joint: Joint, name: str) -> list[str]:
    return [_add(body, _Type.mjJNT_SLIDE, joint.axis, joint, name)]


def _ball(body: Any, joint: Joint, name: str) -> list[str]:
    body.add_joint(name=name, type=_Type.mjJNT_BALL, pos=list(joint.anchor.position))
    return [name]


def _two_hinges(body: Any, joint: Joint, name: str) -> list[str]:
    names = (name, f"{name}#2")
    return [_add(body, _Type.mjJNT_HINGE, axis, joint, each) for axis, each in zip(joint.axes, names, strict=True)]


def _screw(body: Any, joint: Joint, name: str) -> list[str]:
    """Add a rotational and a translational degree of freedom, coupled by the screw's pitch."""
    free = Axis(xyz=joint.axis.xyz)
    turn = _add(body, _Type.mjJNT_HINGE, joint.axis, joint, name)
    return [turn, _add(body, _Type.mjJNT_SLIDE, free, joint, f"{name}#2")]


def _planar(body: Any, joint: Joint, name: str) -> list[str]:
    """Add two translations in the plane and a rotation about its normal."""
    first, second = _in_plane(joint.axis.xyz)
    names = (name, f"{name}#2", f"{name}#3")
    _add(body, _Type.mjJNT_SLIDE, Axis(xyz=first), joint, names[0])
    _add(body, _Type.mjJNT_SLIDE, Axis(xyz=second), joint, names[1])
    _add(body, _Type.mjJNT_HINGE, Axis(xyz=joint.axis.xyz), joint, names[2])
    return list(names)


def _in_plane(normal: Vector) -> tuple[Vector, Vector]:
    """Return two unit vectors that form a right-handed frame with the normal."""
    turn = Pose(orientation=quaternion_between((0.0, 0.0, 1.0), normal))
    return turn.transform((1.0, 0.0, 0.0)), turn.transform((0.0, 1.0, 0.0))


_ADDERS: dict[JointType, Callable[[Any, Joint, str], list[str]]] = {
    JointType.FIXED: _fixed,
    JointType.REVOLUTE: _hinge,
    JointType.CONTINUOUS: _hinge,
    JointType.PRISMATIC: _slide,
    JointType.BALL: _ball,
    JointType.UNIVERSAL: _two_hinges,
    JointType.REVOLUTE2: _two_hinges,
    JointType.SCREW: _screw,
    JointType.PLANAR: _planar,
}
