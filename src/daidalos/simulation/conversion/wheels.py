"""Detection of wheels and casters, whose contacts need special geometry to roll smoothly."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, quaternion_between, rotate
from daidalos.description.geometry import Cylinder, Mesh, Polyline
from daidalos.description.joint import Joint, JointType
from daidalos.description.link import Collision, Link
from daidalos.description.meshes import triangles_of

_ALONG = 0.999
_OFF_CENTRE = 0.02
"""Maximum distance of a disc's axis from the joint's, relative to the radius."""

_MAX_ECCENTRICITY = 0.05
"""Maximum deviation of a wheel mesh from a circle, relative to the radius. A dodecagon passes."""

_DIRECTIONS = 48


@dataclass(frozen=True)
class Disc:
    """Disc on which a wheel rolls.

    Parameters
    ----------
    radius, width : float
        [m].
    pose : Pose
        Of its middle in the link, with z along the axle.
    """

    radius: float
    width: float
    pose: Pose


def wheel_disc(joint: Joint | None, collision: Collision) -> Disc | None:
    """Return the disc of a collision that rotates about its own axis without limits; None for other collisions.

    Parameters
    ----------
    joint : Joint or None
        The joint above the collision's link.
    collision : Collision
        A cylinder, or a mesh that is nearly a body of revolution about the joint's axis.

    Raises
    ------
    DescriptionError
        When its mesh cannot be read.
    """
    if joint is None or joint.type not in (JointType.CONTINUOUS, JointType.REVOLUTE):
        return None
    if math.isfinite(joint.axis.upper):
        return None
    axle = np.array(rotate(joint.anchor.orientation, joint.axis.xyz))
    centre = np.array(joint.anchor.position)
    if isinstance(collision.geometry, Cylinder):
        disc = _of_cylinder(collision.geometry, collision.pose, centre, axle)
    elif isinstance(collision.geometry, Mesh | Polyline):
        disc = _of_points(triangles_of(collision.geometry).vertices, collision.pose, centre, axle)
    else:
        return None
    return disc if disc is not None and 0 < disc.width <= 2 * disc.radius else None


def is_caster(joint: Joint | None, link: Link) -> bool:
    """Return whether a link is a caster: fixed to the robot, it slides where a real one rolls."""
    name = link.name.lower()
    return joint is not None and joint.type is JointType.FIXED and ("caster" in name or "castor" in name)


def _of_cylinder(cylinder: Cylinder, pose: Pose, centre: NDArray[np.float64], axle: NDArray[np.float64]) -> Disc | None:
    if abs(axle @ rotate(pose.orientation, (0.0, 0.0, 1.0))) < _ALONG:
        return None
    offset = np.array(pose.position) - centre
    if np.linalg.norm(offset - (offset @ axle) * axle) >= _OFF_CENTRE * cylinder.radius:
        return None
    return Disc(cylinder.radius, cylinder.length, pose)


def _of_points(
    points: NDArray[np.floating], pose: Pose, centre: NDArray[np.float64], axle: NDArray[np.float64]
) -> Disc | None:
    """Return the disc around points that extend equally far in all directions across the axle."""
    matrix = pose.matrix
    placed = points @ matrix[:3, :3].T + matrix[:3, 3] - centre
    upright = quaternion_between((0.0, 0.0, 1.0), (float(axle[0]), float(axle[1]), float(axle[2])))
    across, along = (np.array(rotate(upright, unit)) for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    turns = np.arange(_DIRECTIONS) * (2 * math.pi / _DIRECTIONS)
    directions = np.outer(np.cos(turns), across) + np.outer(np.sin(turns), along)
    reaches = (placed @ directions.T).max(axis=0)
    flat = placed - np.outer(placed @ axle, axle)
    radius = float(np.linalg.norm(flat, axis=1).max())
    if radius <= 0 or reaches.min() < (1 - _MAX_ECCENTRICITY) * radius:
        return None
    sideways = placed @ axle
    middle = centre + axle * (sideways.max() + sideways.min()) / 2
    return Disc(
        radius,
        float(np.ptp(sideways)),
        Pose((float(middle[0]), float(middle[1]), float(middle[2])), upright),
    )
