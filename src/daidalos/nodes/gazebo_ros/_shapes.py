"""What models look like, as markers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from daidalos.description.link import Link, Material, Rgba
from daidalos.description.pose import Pose, Vector
from daidalos.description.robot import Robot
from daidalos.description.world import Model
from daidalos.nodes.gazebo_ros._states import color_message, pose_message

_GREY = (0.7, 0.7, 0.7, 1.0)
_CUBE, _SPHERE, _CYLINDER, _MESH = 1, 2, 3, 10
_THIN = 0.002


def shape_markers(model: Robot | Model, name: str) -> list[Any]:
    """Return what is seen of a model as ``visualization_msgs/msg/Marker``, each in the frame of its link.

    What has no visual shape is shown by what is solid of it. Height maps are left out.

    Parameters
    ----------
    model : Robot or Model
    name : str
        The model's in the simulation; frames are called ``name::link``.
    """
    from geometry_msgs.msg import Vector3
    from visualization_msgs.msg import Marker

    markers: list[Any] = []
    for link in model.links.values():
        for geometry, pose, material, opacity in _seen(link):
            shape = _shape(geometry)
            if shape is None:
                continue
            marker_type, (x, y, z) = shape
            red, green, blue, alpha = _color(material)
            marker = Marker(ns=name, id=len(markers), type=marker_type, pose=pose_message(pose))
            marker.header.frame_id = f"{name}::{link.name}"
            marker.scale = Vector3(x=float(x), y=float(y), z=float(z))
            marker.color = color_message((red, green, blue, alpha * opacity))
            if isinstance(geometry, Mesh):
                marker.mesh_resource = _address(geometry)
                marker.mesh_use_embedded_materials = material is None
            markers.append(marker)
    return markers


def _seen(link: Link) -> Iterator[tuple[Geometry, Pose, Material | None, float]]:
    for visual in link.visuals:
        yield visual.geometry, visual.pose, visual.material, 1.0 - visual.transparency
    if not link.visuals:
        for collision in link.collisions:
            yield collision.geometry, collision.pose, None, 1.0


def _address(mesh: Mesh) -> str:
    """Return where those who know nothing of models and of this description's folder find the file."""
    if mesh.path is None or mesh.uri.startswith(("package://", "file://")):
        return mesh.uri
    return mesh.path.absolute().as_uri()


def _color(material: Material | None) -> Rgba:
    return material.color if material is not None and material.color is not None else _GREY


def _shape(geometry: Geometry) -> tuple[int, Vector] | None:
    """Return a marker's type and the lengths of its sides; None for what no marker shows."""
    match geometry:
        case Box(size):
            return _CUBE, size
        case Sphere(radius):
            return _SPHERE, (2 * radius,) * 3
        case Ellipsoid((x, y, z)):
            return _SPHERE, (2 * x, 2 * y, 2 * z)
        case Cylinder(radius, length) | Cone(radius, length):
            return _CYLINDER, (2 * radius, 2 * radius, length)
        case Capsule(radius, length):
            return _CYLINDER, (2 * radius, 2 * radius, length + 2 * radius)
        case Plane((_, _, z), (width, depth)) if z > 0:
            return _CUBE, (width, depth, _THIN)
        case Polyline(outlines, height):
            reach = max(abs(value) for outline in outlines for point in outline for value in point)
            return _CUBE, (2 * reach, 2 * reach, height)
        case Mesh():
            return _MESH, geometry.scale
    return None
