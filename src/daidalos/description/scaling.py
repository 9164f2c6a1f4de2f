"""Scaling of models and shapes."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from daidalos.description.joint import Joint, JointType
from daidalos.description.link import Collision, Inertial, Link, Visual
from daidalos.description.world import Model

Part = TypeVar("Part", Visual, Collision)


def scaled(model: Model, factor: float | Vector) -> Model:
    """Return a model scaled in all lengths; it keeps its density.

    Parameters
    ----------
    model : Model
    factor : float or tuple of 3 floats
        Of all lengths, or of those along the model's axes.

    Raises
    ------
    ValueError
        When a factor is not positive, or when a model of several links or of turned shapes should be stretched.
    """
    factors = factor if isinstance(factor, tuple) else (factor, factor, factor)
    for each in factors:
        if not each > 0:
            raise ValueError(f"a factor should be positive, got {each:g}")
    if factors != (factors[0],) * 3:
        return replace(model, links={name: _stretched(model, link, factors) for name, link in model.links.items()})
    factor = factors[0]
    return replace(
        model,
        links={name: _link(link, factor) for name, link in model.links.items()},
        joints={name: _joint(joint, factor) for name, joint in model.joints.items()},
        frames={name: _pose(pose, factor) for name, pose in model.frames.items()},
    )


def scaled_geometry(shape: Geometry, factor: float) -> Geometry:
    """Return a shape scaled by a factor."""
    match shape:
        case Box(size):
            return replace(shape, size=_vector(size, factor))
        case Sphere(radius):
            return replace(shape, radius=radius * factor)
        case Cylinder(radius, length) | Capsule(radius, length) | Cone(radius, length):
            return replace(shape, radius=radius * factor, length=length * factor)
        case Ellipsoid(radii):
            return replace(shape, radii=_vector(radii, factor))
        case Plane(size=(width, depth)):
            return replace(shape, size=(width * factor, depth * factor))
        case Mesh(scale=scale):
            return replace(shape, scale=_vector(scale, factor))
        case Polyline(outlines=outlines, height=height):
            return replace(
                shape,
                outlines=tuple(tuple((x * factor, y * factor) for x, y in line) for line in outlines),
                height=height * factor,
            )
        case Heightmap(size=size, position=position):
            return replace(shape, size=_vector(size, factor), position=_vector(position, factor))
    return shape


def stretched_geometry(shape: Geometry, factors: Vector) -> Geometry:
    """Return a shape scaled by a factor along each of its axes.

    Raises
    ------
    ValueError
        When there is no such shape.
    """
    x, y, z = factors
    match shape:
        case Box((width, depth, height)):
            return replace(shape, size=(width * x, depth * y, height * z))
        case Sphere(radius):
            return Ellipsoid((radius * x, radius * y, radius * z))
        case Ellipsoid((first, second, third)):
            return replace(shape, radii=(first * x, second * y, third * z))
        case Cylinder(radius, length) | Cone(radius, length) if x == y:
            return replace(shape, radius=radius * x, length=length * z)
        case Mesh(scale=(first, second, third)):
            return replace(shape, scale=(first * x, second * y, third * z))
    raise ValueError(f"a {type(shape).__name__.lower()} cannot be scaled by {x:g}, {y:g}, {z:g}")


def _link(link: Link, factor: float) -> Link:
    return replace(
        link,
        pose=_pose(link.pose, factor),
        inertial=None if link.inertial is None else _inertial(link.inertial, factor),
        visuals=tuple(
            replace(v, pose=_pose(v.pose, factor), geometry=scaled_geometry(v.geometry, factor)) for v in link.visuals
        ),
        collisions=tuple(
            replace(c, pose=_pose(c.pose, factor), geometry=scaled_geometry(c.geometry, factor))
            for c in link.collisions
        ),
        sensors=tuple(replace(sensor, pose=_pose(sensor.pose, factor)) for sensor in link.sensors),
        lights=tuple(replace(light, pose=_pose(light.pose, factor)) for light in link.lights),
    )


def _stretched(model: Model, link: Link, factors: Vector) -> Link:
    poses = [link.pose, *(visual.pose for visual in link.visuals), *(solid.pose for solid in link.collisions)]
    if len(model.links) > 1 or not all(_is_upright(pose) for pose in poses):
        raise ValueError(f"{model.name} can only be scaled as a whole: it has several links or turned shapes")
    return replace(
        link,
        inertial=None if link.inertial is None else _stretched_inertial(link.inertial, factors),
        pose=_stretched_pose(link.pose, factors),
        visuals=tuple(_stretched_part(visual, factors) for visual in link.visuals),
        collisions=tuple(_stretched_part(collision, factors) for collision in link.collisions),
        sensors=tuple(replace(sensor, pose=_stretched_pose(sensor.pose, factors)) for sensor in link.sensors),
        lights=tuple(replace(light, pose=_stretched_pose(light.pose, factors)) for light in link.lights),
    )


def _stretched_part(part: Part, factors: Vector) -> Part:
    geometry = stretched_geometry(part.geometry, factors)
    return replace(part, pose=_stretched_pose(part.pose, factors), geometry=geometry)


def _stretched_inertial(inertial: Inertial, factors: Vector) -> Inertial:
    # The second moment of the mass about a plane grows with the square of the factor across it.
    if not _is_upright(inertial.pose):
        raise ValueError("a model can only be scaled as a whole where its centre of mass is turned")
    x, y, z = factors
    volume = x * y * z
    xx, xy, xz, yy, yz, zz = inertial.inertia
    across_x = (yy + zz - xx) / 2 * x * x
    across_y = (xx + zz - yy) / 2 * y * y
    across_z = (xx + yy - zz) / 2 * z * z
    moments = (across_y + across_z, xy * x * y, xz * x * z, across_x + across_z, yz * y * z, across_x + across_y)
    xx, xy, xz, yy, yz, zz = (volume * moment for moment in moments)
    return Inertial(inertial.mass * volume, _stretched_pose(inertial.pose, factors), (xx, xy, xz, yy, yz, zz))


def _stretched_pose(pose: Pose, factors: Vector) -> Pose:
    (x, y, z), (a, b, c) = pose.position, factors
    return Pose((x * a, y * b, z * c), pose.orientation)


def _is_upright(pose: Pose) -> bool:
    return all(abs(value) < 1e-9 for value in pose.orientation[:3])


def _joint(joint: Joint, factor: float) -> Joint:
    axes = joint.axes
    if joint.type is JointType.PRISMATIC:
        axes = tuple(replace(axis, lower=axis.lower * factor, upper=axis.upper * factor) for axis in axes)
    return replace(joint, origin=_pose(joint.origin, factor), anchor=_pose(joint.anchor, factor), axes=axes)


def _inertial(inertial: Inertial, factor: float) -> Inertial:
    xx, xy, xz, yy, yz, zz = (moment * factor**5 for moment in inertial.inertia)
    return replace(
        inertial, mass=inertial.mass * factor**3, pose=_pose(inertial.pose, factor), inertia=(xx, xy, xz, yy, yz, zz)
    )


def _pose(pose: Pose, factor: float) -> Pose:
    return Pose(_vector(pose.position, factor), pose.orientation)


def _vector(vector: Vector, factor: float) -> Vector:
    x, y, z = vector
    return x * factor, y * factor, z * factor
