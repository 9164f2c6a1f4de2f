"""SDF's ``<geometry>``, with one reader per shape."""

from __future__ import annotations

from collections.abc import Callable

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
)
from daidalos.description.markup import Element
from daidalos.description.sdf.context import Context


def read_geometry(parent: Element, context: Context) -> Geometry:
    """Read the shape of a ``<visual>`` or ``<collision>``."""
    element = parent.first("geometry")
    if element is None:
        context.warn(parent, "<geometry> is missing, which leaves it without a shape")
        return Empty()
    shapes = [_SHAPES[shape.tag](shape, context) for shape in element.children if shape.tag in _SHAPES]
    outlines = [shape for shape in shapes if isinstance(shape, Polyline)]
    if outlines:  # several of them are one shape with holes
        return Polyline(tuple(shape.outlines[0] for shape in outlines), outlines[0].height)
    if shapes:
        return shapes[0]
    if element.children:
        found = ", ".join(f"<{child.tag}>" for child in element.children)
        context.warn(parent, f"unknown geometry {found}; known are {', '.join(_SHAPES)}")
    return Empty()


def _box(element: Element, _: Context) -> Geometry:
    x, y, z = element.vector_of("size", size=3, default=(1.0, 1.0, 1.0))
    return Box((x, y, z))


def _sphere(element: Element, _: Context) -> Geometry:
    return Sphere(element.number_of("radius", default=1.0))


def _cylinder(element: Element, _: Context) -> Geometry:
    return Cylinder(element.number_of("radius", default=1.0), element.number_of("length", default=1.0))


def _capsule(element: Element, _: Context) -> Geometry:
    return Capsule(element.number_of("radius", default=0.5), element.number_of("length", default=1.0))


def _cone(element: Element, _: Context) -> Geometry:
    return Cone(element.number_of("radius", default=0.5), element.number_of("length", default=1.0))


def _ellipsoid(element: Element, _: Context) -> Geometry:
    x, y, z = element.vector_of("radii", size=3, default=(1.0, 1.0, 1.0))
    return Ellipsoid((x, y, z))


def _plane(element: Element, _: Context) -> Geometry:
    x, y, z = element.vector_of("normal", size=3, default=(0.0, 0.0, 1.0))
    length = (x * x + y * y + z * z) ** 0.5
    if length == 0:
        raise element.error("the plane's normal is zero")
    width, depth = element.vector_of("size", size=2, default=(1.0, 1.0))
    return Plane((x / length, y / length, z / length), (width, depth))


def _mesh(element: Element, context: Context) -> Geometry:
    uri = element.text_of("uri", "filename")
    if not uri:
        raise element.error("<uri> is missing or empty")
    x, y, z = element.vector_of("scale", size=3, default=(1.0, 1.0, 1.0))
    submesh = element.first("submesh") or Element("submesh")
    return Mesh(
        uri=uri,
        path=context.find(uri),
        scale=(x, y, z),
        submesh=submesh.text_of("name"),
        center=submesh.flag_of("center", default=False),
        optimization=element.attribute("optimization", ""),
        where=element.where,
    )


def _heightmap(element: Element, context: Context) -> Geometry:
    uri = element.text_of("uri")
    if not uri:
        raise element.error("<uri> is missing or empty")
    texture = element.first("texture") or Element("texture")
    width, depth, height = element.vector_of("size", size=3, default=(1.0, 1.0, 1.0))
    x, y, z = element.vector_of("pos", size=3, default=(0.0, 0.0, 0.0))
    return Heightmap(
        uri=uri,
        path=context.find(uri),
        size=(width, depth, height),
        position=(x, y, z),
        texture=texture.text_of("diffuse"),
        where=element.where,
    )


def _polyline(element: Element, _: Context) -> Geometry:
    points = [point.vector(2) for point in element.all("point")]
    if len(points) < 3:
        raise element.error(f"a polyline needs at least 3 points, got {len(points)}")
    outline = tuple((x, y) for x, y in points)
    return Polyline((outline,), element.number_of("height", default=1.0))


def _empty(_element: Element, _: Context) -> Geometry:
    return Empty()


_SHAPES: dict[str, Callable[[Element, Context], Geometry]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "ellipsoid": _ellipsoid,
    "cone": _cone,
    "plane": _plane,
    "mesh": _mesh,
    "heightmap": _heightmap,
    "polyline": _polyline,
    "empty": _empty,
}
