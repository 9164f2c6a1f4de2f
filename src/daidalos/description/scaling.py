"""Models made larger or smaller."""

from __future__ import annotations

from dataclasses import replace

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
from daidalos.description.link import Inertial, Link
from daidalos.description.pose import Pose, Vector
from daidalos.description.world import Model


def scaled(model: Model, factor: float) -> Model:
    """Return a model whose every length is multiplied; masses grow by the third power, inertias by the fifth.

    Raises
    ------
    ValueError
        When the factor is not positive.
    """
    if not factor > 0:
        raise ValueError(f"a factor should be positive, got {factor:g}")
    return replace(
        model,
        links={name: _link(link, factor) for name, link in model.links.items()},
        joints={name: _joint(joint, factor) for name, joint in model.joints.items()},
        frames={name: _pose(pose, factor) for name, pose in model.frames.items()},
    )


def scaled_geometry(shape: Geometry, factor: float) -> Geometry:
    """Return a shape that is larger by a factor."""
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
