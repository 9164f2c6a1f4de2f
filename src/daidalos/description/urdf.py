"""URDF: reads a robot from text or a file (xacro when its name ends so).

The elements and their rules are those of the ROS documentation's URDF/XML pages; what the reference
parser refuses is refused here, except what only controllers need, an inertial without mass and a joint to the
world without a link ``world``: those are warned of.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Box, Capsule, Cylinder, Geometry, Mesh, Sphere
from daidalos.description.joint import Axis, Calibration, Joint, JointType, Mimic, Safety
from daidalos.description.link import Collision, Inertial, Link, Material, Visual
from daidalos.description.markup import Element, parse_markup
from daidalos.description.pose import Pose
from daidalos.description.resolve import PackageResolver, default_model_path, resolve_uri
from daidalos.description.robot import GazeboExtension, Robot
from daidalos.description.transmissions import read_transmissions

_JOINT_TYPES = tuple(JointType)[:6]
_AXIS_TYPES = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR)


def load(
    path: Path | str,
    mappings: Mapping[str, str] | None = None,
    resolve: PackageResolver | None = None,
) -> Robot:
    """Read a robot from a file.

    Parameters
    ----------
    path : Path or str
        A URDF, or a xacro file when the name ends in ``.xacro``.
    mappings : mapping or None
        Values for xacro's arguments.
    resolve : callable or None
        Share directory of a package, for ``package://`` and ``$(find)``.

    Returns
    -------
    Robot

    Raises
    ------
    DescriptionError
        When the file is missing or is not a robot; names file, line and element.
    """
    path = Path(path)
    if path.suffix == ".xacro":
        from daidalos.description.xacro import expand

        return read_robot(expand(path, mappings, resolve), resolve)
    try:
        text = path.read_bytes()
    except OSError as problem:
        raise DescriptionError(_file_problem(problem), str(path)) from None
    return read_robot(parse_markup(text, str(path)), resolve)


def parse(text: str | bytes, source: str = "robot_description", resolve: PackageResolver | None = None) -> Robot:
    """Read a robot from text.

    Parameters
    ----------
    text : str or bytes
        The URDF document.
    source : str
        Its origin; errors name it, and relative mesh paths start at its folder when it is a file.
    resolve : callable or None
        Share directory of a package, for ``package://``.

    Returns
    -------
    Robot

    Raises
    ------
    DescriptionError
        When the text is not a robot; names line and element.
    """
    return read_robot(parse_markup(text, source), resolve)


def read_robot(root: Element, resolve: PackageResolver | None = None) -> Robot:
    """Read a robot from its ``<robot>`` element; see `parse`."""
    if root.tag != "robot":
        raise root.error("expected <robot> as the root element of a URDF")
    warnings: list[str] = []
    materials = _materials(root, resolve)
    links = _links(root, materials, resolve, warnings)
    joints = _joints(root, warnings)
    links |= _world(links, joints, warnings)
    return Robot(
        name=root.name(),
        links=links,
        joints=joints,
        root=_check_tree(root, links, joints),
        materials=materials,
        transmissions=read_transmissions(root, warnings),
        gazebo=tuple(GazeboExtension(e.attribute("reference", ""), e) for e in root.all("gazebo")),
        ros2_control=tuple(root.all("ros2_control")),
        source=root.source,
        warnings=tuple(warnings),
    )


def _materials(root: Element, resolve: PackageResolver | None) -> dict[str, Material]:
    """Return named materials: the robot's own first, then those that a visual defines on the spot."""
    visuals = [visual for link in root.all("link") for visual in link.all("visual")]
    elements = root.all("material") + [m for visual in visuals for m in visual.all("material")]
    materials: dict[str, Material] = {}
    for element in elements:
        material = _material(element, resolve)
        if material.name and (material.color is not None or material.texture):
            materials.setdefault(material.name, material)
    return materials


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


def _links(
    root: Element, materials: Mapping[str, Material], resolve: PackageResolver | None, warnings: list[str]
) -> dict[str, Link]:
    links: dict[str, Link] = {}
    for element in root.all("link"):
        name = element.name()
        if name in links:
            raise element.error("a link of this name was defined before")
        inertial = element.first("inertial")
        links[name] = Link(
            name=name,
            inertial=None if inertial is None else _inertial(inertial, warnings),
            visuals=tuple(_visual(child, materials, resolve) for child in element.all("visual")),
            collisions=tuple(_collision(child, resolve) for child in element.all("collision")),
            where=element.where,
        )
    if not links:
        if any(child.tag.startswith("xacro:") for child in root):
            raise root.error("this is a xacro file; its name should end in .xacro")
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
        return Inertial(mass, _origin(element))
    keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    xx, xy, xz, yy, yz, zz = (inertia.number_attribute(key, 0.0) for key in keys)
    return Inertial(mass, _origin(element), (xx, xy, xz, yy, yz, zz))


def _visual(element: Element, materials: Mapping[str, Material], resolve: PackageResolver | None) -> Visual:
    child = element.first("material")
    material = None if child is None else _material(child, resolve)
    if material is not None and material.color is None and not material.texture:
        material = materials.get(material.name, material)
    return Visual(
        geometry=_geometry(element.require("geometry"), resolve),
        pose=_origin(element),
        material=material,
        name=element.attribute("name", ""),
    )


def _collision(element: Element, resolve: PackageResolver | None) -> Collision:
    return Collision(
        geometry=_geometry(element.require("geometry"), resolve),
        pose=_origin(element),
        name=element.attribute("name", ""),
        where=element.where,
    )


def _geometry(element: Element, resolve: PackageResolver | None) -> Geometry:
    for shape in element.children:
        if shape.tag in _SHAPES:
            return _SHAPES[shape.tag](shape, resolve)
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


def _find(element: Element, uri: str, resolve: PackageResolver | None) -> Path | None:
    return resolve_uri(uri, Path(element.source).parent, resolve, default_model_path())


_SHAPES: dict[str, Callable[[Element, PackageResolver | None], Geometry]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "mesh": _mesh,
}


def _origin(element: Element) -> Pose:
    origin = element.first("origin")
    if origin is None:
        return Pose()
    xyz = origin.vector_attribute("xyz", 3, (0.0, 0.0, 0.0))
    rpy = origin.vector_attribute("rpy", 3, (0.0, 0.0, 0.0))
    return Pose.from_xyz_rpy(xyz, rpy)


def _joints(root: Element, warnings: list[str]) -> dict[str, Joint]:
    joints: dict[str, Joint] = {}
    for element in root.all("joint"):
        name = element.name()
        if name in joints:
            raise element.error("a joint of this name was defined before")
        joints[name] = _joint(element, warnings)
    for name, joint in joints.items():
        if joint.mimic is not None and joint.mimic.joint not in joints:
            warnings.append(f"{joint.where}: joint {name!r} mimics {joint.mimic.joint!r}, which does not exist")
            joints[name] = replace(joint, mimic=None)
    return joints


def _world(links: Mapping[str, Link], joints: Mapping[str, Joint], warnings: list[str]) -> dict[str, Link]:
    """Return the link ``world`` where joints hang on it although the robot has none, as some simulators allow."""
    first = next((joint for joint in joints.values() if joint.parent == "world"), None)
    if first is None or "world" in links:
        return {}
    warnings.append(f"{first.where}: link 'world' does not exist and was added, which ROS itself does not do")
    return {"world": Link("world", where=first.where)}


def _joint(element: Element, warnings: list[str]) -> Joint:
    word = element.attribute("type")
    if word not in _JOINT_TYPES:
        raise element.error(f"unknown joint type {word!r}; known are {', '.join(_JOINT_TYPES)}")
    kind = JointType(word)
    mimic = element.first("mimic")
    return Joint(
        name=element.name(),
        type=kind,
        parent=element.require("parent").attribute("link"),
        child=element.require("child").attribute("link"),
        origin=_origin(element),
        axes=(_axis(element, kind, warnings),) if kind in _AXIS_TYPES else (),
        mimic=None if mimic is None else _mimic(mimic),
        safety=_safety(element.first("safety_controller")),
        calibration=_calibration(element.first("calibration")),
        where=element.where,
    )


def _axis(element: Element, kind: JointType, warnings: list[str]) -> Axis:
    child = element.first("axis")
    x, y, z = (1.0, 0.0, 0.0) if child is None else child.vector_attribute("xyz", 3)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0:
        raise element.error("the axis has no direction: xyz is 0 0 0")
    axis = Axis((x / length, y / length, z / length))
    limit, dynamics = element.first("limit"), element.first("dynamics")
    if dynamics is not None:
        axis = replace(
            axis,
            damping=dynamics.number_attribute("damping", 0.0),
            friction=dynamics.number_attribute("friction", 0.0),
        )
    if limit is None:
        if kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            raise element.error(f"a {kind} joint needs <limit>")
        return axis
    axis = replace(
        axis,
        effort=limit.number_attribute("effort", math.inf, finite=False),
        velocity=limit.number_attribute("velocity", math.inf, finite=False),
    )
    if kind is JointType.CONTINUOUS:
        return axis
    lower = limit.number_attribute("lower", 0.0, finite=False)
    upper = limit.number_attribute("upper", 0.0, finite=False)
    if lower > upper:
        warnings.append(f"{limit.where}: {element.label}: lower limit {lower:g} is above upper {upper:g}")
    return replace(axis, lower=lower, upper=upper)


def _mimic(element: Element) -> Mimic:
    return Mimic(
        joint=element.attribute("joint"),
        multiplier=element.number_attribute("multiplier", 1.0),
        offset=element.number_attribute("offset", 0.0),
    )


def _safety(element: Element | None) -> Safety | None:
    if element is None:
        return None
    return Safety(
        k_velocity=element.number_attribute("k_velocity"),
        k_position=element.number_attribute("k_position", 0.0),
        soft_lower_limit=element.number_attribute("soft_lower_limit", 0.0),
        soft_upper_limit=element.number_attribute("soft_upper_limit", 0.0),
    )


def _calibration(element: Element | None) -> Calibration | None:
    if element is None:
        return None
    edges = [element.number_attribute(key) if key in element.attributes else None for key in ("rising", "falling")]
    return Calibration(*edges)


def _check_tree(root: Element, links: Mapping[str, Link], joints: Mapping[str, Joint]) -> str:
    """Return the one root link; raise when links and joints are no tree."""
    parent_of: dict[str, str] = {}
    elements = {element.name(): element for element in root.all("joint")}
    for joint in joints.values():
        element = elements[joint.name]
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in links:
                raise element.error(f"its {end} link {name!r} does not exist")
        if joint.child in parent_of:
            raise element.error(f"link {joint.child!r} is the child of more than one joint")
        parent_of[joint.child] = joint.parent
    roots = [name for name in links if name not in parent_of]
    if not roots:
        raise root.error("the joints form a loop: every link is the child of another")
    if len(roots) > 1:
        raise root.error(f"the robot should have one root link, these are nobody's child: {', '.join(roots)}")
    reached = _reached_from(roots[0], joints.values())
    if len(reached) < len(links):
        rest = ", ".join(name for name in links if name not in reached)
        raise root.error(f"the joints form a loop that the root link does not reach: {rest}")
    return roots[0]


def _reached_from(start: str, joints: Iterable[Joint]) -> set[str]:
    children: dict[str, list[str]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint.child)
    reached, waiting = {start}, [start]
    while waiting:
        for child in children.get(waiting.pop(), ()):
            reached.add(child)
            waiting.append(child)
    return reached


def _file_problem(problem: OSError) -> str:
    return "no such file" if isinstance(problem, FileNotFoundError) else (problem.strerror or str(problem))
