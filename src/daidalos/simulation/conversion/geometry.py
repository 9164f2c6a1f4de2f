"""Conversion of shapes to MuJoCo's geoms.

Geoms are sorted into groups: those of `SOLID` collide and are seen by rays, those of `SEEN` are only
seen, those of `TOUCHED` only collide.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from daidalos.common.pose3 import Pose, quaternion_between
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Empty,
    Geometry,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
    require_size,
)
from daidalos.description.images import read_grey
from daidalos.description.meshes import triangles_of
from daidalos.simulation.conversion.assets import Assets, Solid
from daidalos.simulation.conversion.preparation import is_decomposed

SOLID, SEEN, TOUCHED = 0, 1, 3
RAY_GROUPS = np.array([1, 1, 0, 0, 0, 0], dtype=np.uint8)
"""Geom groups that stop a ray of ``mj_multiRay``."""

_Type = mujoco.mjtGeom


def add_geoms(body: Any, geometry: Geometry, pose: Pose, assets: Assets, static: bool) -> list[Any]:
    """Add the geoms of a collision shape to a body.

    Parameters
    ----------
    body : MjsBody
    geometry : Geometry
    pose : Pose
        In the body.
    assets : Assets
        Takes meshes and heightmaps.
    static : bool
        Whether the body stays where it is: a concave mesh that stays is split into convex parts, one that
        moves collides as its hull, unless the description says otherwise.

    Returns
    -------
    list of MjsGeom
        None for an empty shape. They weigh nothing; the body's inertia is given.

    Raises
    ------
    DescriptionError
        When a mesh or image is missing or cannot be read.
    """
    if isinstance(geometry, Empty):
        return []
    require_size(geometry)
    if isinstance(geometry, Mesh | Cone | Polyline):
        return _add_solid(body, assets.solid(triangles_of(geometry), is_decomposed(geometry, static)), pose)
    if isinstance(geometry, Heightmap):
        if not static:
            raise DescriptionError("a heightmap cannot move", geometry.where)
        return _add_terrain(body, geometry, pose, assets)
    return _ADDERS[type(geometry)](body, geometry, pose)


def add_rolling(body: Any, radius: float, width: float, pose: Pose) -> Any:
    """Add the rolling surface of a wheel along z: an ellipsoid, which touches the ground in one point.

    A cylinder touches with a line of points that rub against each other in a turn.
    """
    rolling = _add(body, _Type.mjGEOM_ELLIPSOID, (radius, radius, width / 2), pose)
    rolling.group = TOUCHED
    return rolling


def only_seen(spec: Any, geoms: list[Any]) -> list[Any]:
    """Make a collision's geoms visible to rays only; the others are deleted."""
    for geom in geoms:
        if geom.group == TOUCHED:
            spec.delete(geom)
    seen = [geom for geom in geoms if geom.group != TOUCHED]
    for geom in seen:
        _only_seen(geom)
    return seen


def _add(body: Any, kind: Any, size: tuple[float, float, float], pose: Pose) -> Any:
    x, y, z, w = pose.orientation
    return body.add_geom(type=kind, size=list(size), pos=list(pose.position), quat=[w, x, y, z], mass=0.0, group=SOLID)


def _only_seen(geom: Any) -> None:
    geom.group, geom.contype, geom.conaffinity = SEEN, 0, 0


def _box(body: Any, shape: Box, pose: Pose) -> list[Any]:
    x, y, z = shape.size
    return [_add(body, _Type.mjGEOM_BOX, (x / 2, y / 2, z / 2), pose)]


def _sphere(body: Any, shape: Sphere, pose: Pose) -> list[Any]:
    return [_add(body, _Type.mjGEOM_SPHERE, (shape.radius, 0.0, 0.0), pose)]


def _cylinder(body: Any, shape: Cylinder, pose: Pose) -> list[Any]:
    return [_add(body, _Type.mjGEOM_CYLINDER, (shape.radius, shape.length / 2, 0.0), pose)]


def _capsule(body: Any, shape: Capsule, pose: Pose) -> list[Any]:
    return [_add(body, _Type.mjGEOM_CAPSULE, (shape.radius, shape.length / 2, 0.0), pose)]


def _ellipsoid(body: Any, shape: Ellipsoid, pose: Pose) -> list[Any]:
    return [_add(body, _Type.mjGEOM_ELLIPSOID, shape.radii, pose)]


def _plane(body: Any, shape: Plane, pose: Pose) -> list[Any]:
    turned = pose @ Pose(orientation=quaternion_between((0.0, 0.0, 1.0), shape.normal))
    return [_add(body, _Type.mjGEOM_PLANE, (0.0, 0.0, 1.0), turned)]


def _add_solid(body: Any, solid: Solid, pose: Pose) -> list[Any]:
    """Add a mesh: convex parts that collide, and its triangles for rays where they differ."""
    geoms = []
    for name in solid.parts:
        geom = _add(body, _Type.mjGEOM_MESH, (0.0, 0.0, 0.0), pose)
        geom.meshname = name
        geoms.append(geom)
    if solid.surface:
        for geom in geoms:
            geom.group = TOUCHED
        seen = _add(body, _Type.mjGEOM_MESH, (0.0, 0.0, 0.0), pose)
        seen.meshname = solid.surface
        _only_seen(seen)
        geoms.append(seen)
    return geoms


def _add_terrain(body: Any, shape: Heightmap, pose: Pose, assets: Assets) -> list[Any]:
    """Add a heightmap; the top row of images has the largest y."""
    if shape.path is None:
        raise DescriptionError(f"heightmap {shape.uri} not found", shape.where)
    name, bottom = assets.terrain(read_grey(shape.path, shape.where)[::-1], shape.size)
    x, y, z = shape.position
    geom = _add(body, _Type.mjGEOM_HFIELD, (0.0, 0.0, 0.0), pose @ Pose((x, y, z + bottom)))
    geom.hfieldname = name
    return [geom]


_ADDERS: dict[type, Callable[[Any, Any, Pose], list[Any]]] = {
    Box: _box,
    Sphere: _sphere,
    Cylinder: _cylinder,
    Capsule: _capsule,
    Ellipsoid: _ellipsoid,
    Plane: _plane,
}
