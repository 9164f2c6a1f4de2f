"""Reader of URDF robots from text or files, through xacro for xacro files.

The elements and their rules are those of the ROS documentation's URDF/XML pages; what the reference
parser refuses is refused here, except what only controllers need, an inertial without mass, a robot without name,
a missing root link, rests of xacro in a ``.urdf``, and what Bullet adds to the language: those are warned of.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from daidalos.description.errors import DescriptionError
from daidalos.description.joint import Joint
from daidalos.description.link import Link
from daidalos.description.markup import Element, parse_markup
from daidalos.description.resolve import PackageResolver
from daidalos.description.robot import GazeboExtension, Robot
from daidalos.description.transmissions import read_transmissions
from daidalos.description.urdf.joints import read_joints
from daidalos.description.urdf.links import read_links, read_materials


def load(
    path: Path | str,
    mappings: Mapping[str, str] | None = None,
    resolve: PackageResolver | None = None,
) -> Robot:
    """Read a robot from a file.

    Parameters
    ----------
    path : Path or str
        A URDF, or a xacro file: one whose name ends in ``.xacro``, or that uses it under another name.
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
    try:
        text = path.read_bytes()
    except OSError as problem:
        raise DescriptionError(_file_problem(problem), str(path)) from None
    if path.suffix != ".xacro" and not _is_xacro(text):
        return read_robot(parse_markup(text, str(path)), resolve)
    from daidalos.description.xacro import expand

    try:
        return read_robot(expand(path, mappings, resolve), resolve)
    except DescriptionError as error:
        if path.suffix != ".urdf":
            raise
        return _read_unexpanded(text, path, resolve, error)


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
    """Read a robot from its ``<robot>`` element, which may stand inside ``<urdf>``; see `parse`."""
    if root.tag == "urdf" and (inner := root.all("robot")):
        root = inner[0]
    if root.tag != "robot":
        raise root.error("expected <robot> as the root element of a URDF")
    warnings: list[str] = []
    materials = read_materials(root, resolve)
    links = read_links(root, materials, resolve, warnings)
    joints = read_joints(root, warnings)
    links |= _missing_root(links, joints, warnings)
    return Robot(
        name=_name(root, warnings),
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


def _read_unexpanded(text: bytes, path: Path, resolve: PackageResolver | None, error: DescriptionError) -> Robot:
    """Return the robot of a URDF with rests of xacro, which ROS's parser ignores; raise `error` if it is none."""
    try:
        root = parse_markup(text, str(path))
        robot = read_robot(root, resolve)
    except DescriptionError:
        raise error from None
    rests = [element for element in root.walk() if element.tag.startswith("xacro:")]
    ignored = f"{rests[0].where}: {rests[0].label}: " if rests else f"{path}: "
    more = f" and {len(rests) - 1} more such elements are" if len(rests) > 1 else " is"
    return replace(
        robot, warnings=(f"{ignored}xacro can not expand it ({error.message}); it{more} ignored", *robot.warnings)
    )


def _name(root: Element, warnings: list[str]) -> str:
    name = root.attribute("name", "")
    if not name:
        warnings.append(f"{root.where}: <robot> has no name, which ROS itself does not accept; called 'robot'")
    return name or "robot"


def _missing_root(links: Mapping[str, Link], joints: Mapping[str, Joint], warnings: list[str]) -> dict[str, Link]:
    """Return the implicit root link: ``world``, or the one missing link on which the whole robot hangs."""
    children = {joint.child for joint in joints.values()}
    missing = {joint.parent: joint for joint in reversed(list(joints.values())) if joint.parent not in links}
    if len(missing) > 1:
        missing = {name: joint for name, joint in missing.items() if name == "world"}
    if not missing or (not missing.keys() & {"world"} and not links.keys() <= children):
        return {}
    (name, first) = next(iter(missing.items()))
    warnings.append(f"{first.where}: link {name!r} does not exist and was added, which ROS itself does not do")
    return {name: Link(name, where=first.where)}


def _check_tree(root: Element, links: Mapping[str, Link], joints: Mapping[str, Joint]) -> str:
    """Return the root link; raise an error if links and joints are not a tree."""
    above: dict[str, Joint] = {}
    elements = {element.name(): element for element in root.all("joint")}
    for joint in joints.values():
        element = elements[joint.name]
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in links:
                raise element.error(f"its {end} link {name!r} does not exist")
        if joint.child in above:
            raise element.error(f"link {joint.child!r} is the child of more than one joint")
        above[joint.child] = joint
    loop = _loop(links, above)
    if loop:
        closing = max(loop, key=list(joints.values()).index)
        way = " -> ".join([*(joint.child for joint in reversed(loop)), loop[-1].child])
        raise elements[closing.name].error(f"the joints form a loop: {way}")
    roots = [name for name in links if name not in above]
    if len(roots) > 1:
        raise root.error(f"the robot should have one root link, these links have no parent: {', '.join(roots)}")
    return roots[0]


def _loop(links: Iterable[str], above: Mapping[str, Joint]) -> list[Joint]:
    """Return joints that form a loop, from child to parent; none without a loop."""
    ended: set[str] = set()
    for link in links:
        way: list[Joint] = []
        seen: dict[str, int] = {}
        while link in above and link not in ended:
            if link in seen:
                return way[seen[link] :]
            seen[link] = len(way)
            way.append(above[link])
            link = above[link].parent
        ended.update(seen)
    return []


def _is_xacro(text: bytes) -> bool:
    """Return whether a file without xacro's extension has elements that only xacro can expand."""
    return b"xmlns:xacro" in text and any(word in text for word in (b"<xacro:", b"$(", b"${"))


def _file_problem(problem: OSError) -> str:
    return "no such file" if isinstance(problem, FileNotFoundError) else (problem.strerror or str(problem))
