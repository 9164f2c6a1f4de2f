"""URDF's links: inertials, visuals and collisions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Box, Capsule, Cylinder, Empty, Geometry, Mesh, Plane, Sphere
from daidalos.description.link import Collision, Inertial, Link, Material, Visual
from daidalos.description.markup import Element
from daidalos.description.resolve import PackageResolver, default_model_path, resolve_uri


def read_materials(root: Element, resolve: PackageResolver | None) -> dict[str, Material]:
    """Return named materials: the robot's own first, then those defined inside visuals."""
    visuals = [visual for link in root.all("link") for visual in link.all("visual")]
    elements = root.all("material") + [m for visual in visuals for m in visual.all("material")]
    materials: dict[str, Material] = {}
    for element in elements:
        material = _material(element, resolve)
        if material.name and (material.color is not None or material.texture):
            materials.setdefault(material.name, material)
    return materials


def read_links(
    root: Element, materials: Mapping[str, Material], resolve: PackageResolver | None, warnings: list[str]
) -> dict[str, Link]:
    """Return the links by name; `warnings` gets a line for each skipped or non-standard element."""
    links: dict[str, Link] = {}
    for element in root.all("link"):
        name = element.name()
        if name in links:
            raise element.error("a link of this name was defined before")
        inertial = element.first("inertial")
        links[name] = Link(
            name=name,
            inertial=None if inertial is None else _inertial(inertial, warnings),
            visuals=tuple(_visual(child, materials, resolve, warnings) for child in element.all("visual")),
            collisions=tuple(_collision(child, resolve, warnings) for child in element.all("collision")),
            where=element.where,
        )
    if not links:
        if any(child.tag.startswith("xacro:") for child in root):
            raise root.error("this is xacro, to be expanded first: run `xacro FILE`")
        raise root.error("the robot has no link")
    return links


def _inertial(element: Element, warnings: list[str]) -> Inertial | None:
    weight = element.first("mass")
    if weight is None:
        warnings.append(f"{element.where}: {element.label}: <mass> is missing, the inertial is left out")
        return None
    mass = weight.number_attribute("value")
    if mass < 0:
        raise element.error(f"mass should not be negative, got {mass:g}")
    inertia = element.first("inertia")
    if inertia is None:
        return Inertial(mass, read_origin(element))
    keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    xx, xy, xz, yy, yz, zz = (inertia.number_attribute(key, 0.0) for key in keys)
    return Inertial(mass, read_origin(element), (xx, xy, xz, yy, yz, zz))


def _visual(
    element: Element, materials: Mapping[str, Material], resolve: PackageResolver | None, warnings: list[str]
) -> Visual:
    child = element.first("material")
    material = None if child is None else _material(child, resolve)
    if material is not None and material.color is None and not material.texture:
        if material.name and material.name not in materials:
            warnings.append(f"{element.where}: material {material.name!r} is not defined")
        material = materials.get(material.name, material)
    return Visual(
        geometry=_geometry(element.require("geometry"), resolve, warnings),
        pose=read_origin(element),
        material=material,
        name=element.attribute("name", ""),
    )


def _collision(element: Element, resolve: PackageResolver | None, warnings: list[str]) -> Collision:
    return Collision(
        geometry=_geometry(element.require("geometry"), resolve, warnings),
        pose=read_origin(element),
        name=element.attribute("name", ""),
        where=element.where,
    )


def _material(element: Element, resolve: PackageResolver | None) -> Material:
    color, texture = element.first("color"), element.first("texture")
    uri = "" if texture is None else texture.attribute("filename", "")
    rgba = None if color is None else color.vector_attribute("rgba", 4)
    return Material(
        name=element.attribute("name", ""),
        color=None if rgba is None else (rgba[0], rgba[1], rgba[2], rgba[3]),
        texture=uri,
        texture_path=_find(element, uri, resolve) if uri else None,
    )


def _geometry(element: Element, resolve: PackageResolver | None, warnings: list[str]) -> Geometry:
    for shape in element.children:
        if shape.tag in _SHAPES:
            return _SHAPES[shape.tag](shape, resolve)
        if shape.tag == "plane":
            warnings.append(f"{shape.where}: <plane> is not of the standard and is read as Bullet does")
            return _plane(shape)
        if shape.tag == "cdf":
            warnings.append(f"{shape.where}: <cdf> is a shape that only Bullet reads; it is left out")
            return Empty()
    found = ", ".join(f"<{child.tag}>" for child in element.children) or "nothing"
    raise element.error(f"expected one of {', '.join(_SHAPES)}, got {found}")


def _box(element: Element, _: PackageResolver | None) -> Box:
    x, y, z = element.vector_attribute("size", 3)
    return Box((x, y, z))


def _sphere(element: Element, _: PackageResolver | None) -> Sphere:
    return Sphere(element.number_attribute("radius"))


def _cylinder(element: Element, _: PackageResolver | None) -> Cylinder:
    return Cylinder(element.number_attribute("radius"), element.number_attribute("length"))


def _capsule(element: Element, _: PackageResolver | None) -> Capsule:
    return Capsule(element.number_attribute("radius"), element.number_attribute("length"))


def _mesh(element: Element, resolve: PackageResolver | None) -> Mesh:
    uri = element.attribute("filename")
    if not uri:
        raise element.error('attribute "filename" is empty')
    words = element.attribute("scale", "1 1 1").split()
    x, y, z = (
        element.vector_attribute("scale", 3, (1.0, 1.0, 1.0))
        if len(words) != 1
        else (element.number_attribute("scale"),) * 3
    )
    return Mesh(uri, _find(element, uri, resolve), (x, y, z), where=element.where)


def _plane(element: Element) -> Plane:
    x, y, z = element.vector_attribute("normal", 3, (0.0, 0.0, 1.0))
    return Plane((x, y, z))


def _find(element: Element, uri: str, resolve: PackageResolver | None) -> Path | None:
    return resolve_uri(uri, Path(element.source).parent, resolve, default_model_path())


_SHAPES: dict[str, Callable[[Element, PackageResolver | None], Geometry]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "mesh": _mesh,
}


def read_origin(element: Element) -> Pose:
    """Return the pose of an element's ``<origin>``; identity without one."""
    origin = element.first("origin")
    if origin is None:
        return Pose()
    xyz = origin.vector_attribute("xyz", 3, (0.0, 0.0, 0.0))
    rpy = origin.vector_attribute("rpy", 3, (0.0, 0.0, 0.0))
    return Pose.from_xyz_rpy(xyz, rpy)
