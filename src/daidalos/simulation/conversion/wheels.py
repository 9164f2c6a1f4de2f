"""Recognises wheels and casters, whose contacts need care so that they roll true."""

from __future__ import annotations

import math

from daidalos.description.geometry import Cylinder
from daidalos.description.joint import Joint, JointType
from daidalos.description.link import Collision, Link
from daidalos.description.pose import rotate

_ALONG = 0.999


def is_wheel(joint: Joint | None, collision: Collision) -> bool:
    """Tell whether a collision is a disc that turns about its own axis without end.

    Parameters
    ----------
    joint : Joint or None
        The joint above the collision's link.
    collision : Collision
    """
    disc = collision.geometry
    if joint is None or not isinstance(disc, Cylinder) or not 0 < disc.length <= 2 * disc.radius:
        return False
    if joint.type not in (JointType.CONTINUOUS, JointType.REVOLUTE) or math.isfinite(joint.axis.upper):
        return False
    axle = rotate(joint.anchor.orientation, joint.axis.xyz)
    along = rotate(collision.pose.orientation, (0.0, 0.0, 1.0))
    if abs(sum(a * b for a, b in zip(axle, along, strict=True))) < _ALONG:
        return False
    offset = [c - a for c, a in zip(collision.pose.position, joint.anchor.position, strict=True)]
    sideways = sum(o * a for o, a in zip(offset, axle, strict=True))
    distance = math.dist(offset, [sideways * a for a in axle])
    return distance < 0.02 * disc.radius


def is_caster(joint: Joint | None, link: Link) -> bool:
    """Tell whether a link stands for a caster: fixed to the robot, it slides where a real one rolls."""
    name = link.name.lower()
    return joint is not None and joint.type is JointType.FIXED and ("caster" in name or "castor" in name)
