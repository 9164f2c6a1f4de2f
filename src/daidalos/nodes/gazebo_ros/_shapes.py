"""Markers of models' visuals, and the names of their parts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
from daidalos.description.images import read_grey
from daidalos.description.link import Link, Material, Rgba, Visual
from daidalos.description.robot import Robot
from daidalos.description.visuals import GREY, WHITE, visual_parts
from daidalos.description.world import Model
from daidalos.nodes.gazebo_ros._states import color_message, pose_message

_CUBE, _SPHERE, _CYLINDER, _MESH, _TRIANGLES = 1, 2, 3, 10, 11
_SEGMENTS = 32
_TERRAIN_LINES = 41
_THIN = 0.002


def shape_markers(model: Robot | Model, name: str) -> list[Any]:
    """Return what is seen of a model as ``visualization_msgs/msg/Marker``, each in the frame of its link.

    What has no visual shape is shown by what is solid of it, and terrain by its larger forms.

    Parameters
    ----------
    model : Robot or Model
    name : str
        The model's in the simulation; frames are called ``name::link``.
    """
    markers: list[Any] = []
    for link in model.links.values():
        for visual in _seen(link):
            for marker in _markers(visual):
                marker.ns, marker.id = name, len(markers)
                marker.header.frame_id = f"{name}::{link.name}"
                markers.append(marker)
    return markers


def model_parts(model: Model, name: str) -> Any:
    """Return the joints, sensors and plugins of a model as ``daidalos_msgs/msg/ModelParts``.

    Parameters
    ----------
    model : Model
    name : str
        The model's in the simulation.
    """
    from daidalos_msgs.msg import ModelParts

    sensors = [(f"{key}::{each.name}", each.type) for key, link in model.links.items() for each in link.sensors]
    sensors += [(f"{key}::{each.name}", each.type) for key, joint in model.joints.items() for each in joint.sensors]
    return ModelParts(
        name=name,
        is_static=model.static,
        joints=list(model.joints),
        joint_types=[str(joint.type) for joint in model.joints.values()],
        sensors=[sensor for sensor, _ in sensors],
        sensor_types=[kind for _, kind in sensors],
        plugins=[plugin.name for plugin in model.plugins],
    )


def _seen(link: Link) -> Iterable[Visual]:
    return link.visuals or [Visual(collision.geometry, collision.pose) for collision in link.collisions]


@lru_cache(maxsize=64)
def _corners(geometry: Geometry) -> list[Any]:
    """Return the corners of the triangles of a shape that no other marker shows, three by three."""
    from geometry_msgs.msg import Point

    (part,) = visual_parts(Visual(geometry), _SEGMENTS)
    triangles = _thinned(part.vertices, geometry) if isinstance(geometry, Heightmap) else part.vertices[part.faces]
    return [Point(x=float(x), y=float(y), z=float(z)) for x, y, z in triangles.reshape(-1, 3)]


def _thinned(vertices: NDArray[np.float32], terrain: Heightmap) -> NDArray[np.float32]:
    """Return the triangles (n, 3, 3) of a terrain that has fewer rows and columns than its image."""
    if terrain.path is None:
        return np.zeros((0, 3, 3), dtype=np.float32)
    rows, columns = read_grey(terrain.path, terrain.where).shape
    kept = (np.unique(np.linspace(0, count - 1, _TERRAIN_LINES).round().astype(int)) for count in (rows, columns))
    grid = vertices.reshape(rows, columns, 3)[np.ix_(*kept)]
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack((a, b, c, a, c, d), axis=2).reshape(-1, 3, 3)


def _markers(visual: Visual) -> Iterator[Any]:
    """Yield what shows a visual, in the link's frame."""
    from geometry_msgs.msg import Vector3
    from visualization_msgs.msg import Marker

    geometry, material = visual.geometry, visual.material
    red, green, blue, alpha = _color(material)
    for marker_type, (x, y, z), pose in _shapes(geometry):
        marker = Marker(type=marker_type, pose=pose_message(visual.pose @ pose))
        marker.scale = Vector3(x=float(x), y=float(y), z=float(z))
        marker.color = color_message((red, green, blue, alpha * (1.0 - visual.transparency)))
        if isinstance(geometry, Mesh):
            marker.mesh_resource = _address(geometry)
            marker.mesh_use_embedded_materials = material is None
        elif marker_type == _TRIANGLES:
            marker.points = _corners(geometry)
        if material is not None and material.texture_path is not None:
            marker.texture_resource = material.texture_path.absolute().as_uri()
        yield marker


def _address(mesh: Mesh) -> str:
    """Return where those who know nothing of models and of this description's folder find the file."""
    if mesh.path is None or mesh.uri.startswith(("package://", "file://")):
        return mesh.uri
    return mesh.path.absolute().as_uri()


def _color(material: Material | None) -> Rgba:
    if material is None:
        return GREY
    return material.color or (GREY if material.texture_path is None else WHITE)


def _shapes(geometry: Geometry) -> Iterator[tuple[int, Vector, Pose]]:
    """Yield a marker's type, the lengths of its sides and its pose in the visual; nothing where no marker shows it."""
    here = Pose()
    match geometry:
        case Box(size):
            yield _CUBE, size, here
        case Sphere(radius):
            yield _SPHERE, (2 * radius,) * 3, here
        case Ellipsoid((x, y, z)):
            yield _SPHERE, (2 * x, 2 * y, 2 * z), here
        case Cylinder(radius, length):
            yield _CYLINDER, (2 * radius, 2 * radius, length), here
        case Capsule(radius, length):
            yield _CYLINDER, (2 * radius, 2 * radius, length), here
            for end in (-length / 2, length / 2):
                yield _SPHERE, (2 * radius,) * 3, Pose((0.0, 0.0, end))
        case Plane((_, _, z), (width, depth)) if z > 0:
            yield _CUBE, (width, depth, _THIN), here
        case Heightmap() if geometry.path is None:
            return
        case Cone() | Polyline() | Heightmap():
            yield _TRIANGLES, (1.0, 1.0, 1.0), here
        case Mesh():
            yield _MESH, geometry.scale, here
