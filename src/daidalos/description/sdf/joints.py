"""SDF's ``<joint>``: types, axes, limits, dynamics and the frames of axes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from daidalos.common.pose3 import Pose, Vector, rotate
from daidalos.description.joint import Axis, Joint, JointType, Mimic
from daidalos.description.markup import Element
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.frames import read_pose
from daidalos.description.sdf.links import read_sensor

_UNLIMITED = 1e16
_PARALLEL = 0.9
_AXES = {
    JointType.REVOLUTE: 1,
    JointType.CONTINUOUS: 1,
    JointType.PRISMATIC: 1,
    JointType.SCREW: 1,
    JointType.UNIVERSAL: 2,
    JointType.REVOLUTE2: 2,
    JointType.GEARBOX: 2,
}

FramePose = Callable[[str, Element], Pose]
"""Takes a frame's name and the element that asks, returns its pose in the model."""

LinkResolver = Callable[[str, Element], str]
"""Takes the name of a link, frame or joint, returns the link that it is attached to."""


def read_joint(
    element: Element, context: Context, own: str, frame: FramePose, link_of: LinkResolver, root: str
) -> Joint:
    """Read a joint.

    Parameters
    ----------
    element : Element
        ``<joint>``.
    context : Context
    own : str
        Name of the joint's own frame in its scope.
    frame : callable
        Resolves frames in the scope of the joint.
    link_of : callable
        Resolves what parent and child are attached to.
    root : str
        The scope's root frame, ``__model__`` or ``world``.
    """
    kind = _type(element)
    parent, child = _end(element, "parent", link_of), _end(element, "child", link_of)
    if parent == child:
        raise element.error(f"parent and child are the same link {parent!r}")
    if child == "world":
        raise element.error("the child of a joint cannot be the world")
    here = frame(own, element)
    in_child = frame(child, element).inverse @ here
    in_parent = here if parent == "world" else frame(parent, element).inverse @ here
    joint = Joint(
        name=element.name(),
        type=kind,
        parent=parent,
        child=child,
        origin=in_parent,
        anchor=in_child,
        axes=_axes(element, kind, here, frame, context, root),
        mimic=_mimic(element),
        thread_pitch=_thread_pitch(element, context),
        gearbox_ratio=element.number_of("gearbox_ratio", default=1.0),
        gearbox_reference=element.text_of("gearbox_reference_body"),
        where=element.where,
    )
    return replace(
        joint,
        sensors=tuple(read_sensor(sensor, lambda e: in_child @ read_pose(e).pose) for sensor in element.all("sensor")),
    )


def _type(element: Element) -> JointType:
    word = element.attribute("type")
    try:
        return JointType(word)
    except ValueError:
        known = ", ".join(kind for kind in JointType if kind not in (JointType.FLOATING, JointType.PLANAR))
        raise element.error(f"unknown joint type {word!r}; known are {known}") from None


def _end(element: Element, end: str, link_of: LinkResolver) -> str:
    child = element.require(end)
    name = child.text.strip() or child.text_of("link_name")
    if not name:
        raise child.error("expected the name of a link")
    return "world" if name == "world" else link_of(name, child)


def _axes(
    element: Element, kind: JointType, here: Pose, frame: FramePose, context: Context, root: str
) -> tuple[Axis, ...]:
    axes: list[Axis] = []
    for tag in ("axis", "axis2")[: _AXES.get(kind, 0)]:
        child = element.first(tag)
        if child is None:
            child = Element(tag, source=element.source, line=element.line)
        axis = _axis(child, here, frame, context, root)
        if tag == "axis2" and child.first("xyz") is None:
            axis = replace(axis, xyz=_across(axes[0].xyz))
        if kind is JointType.CONTINUOUS:
            axis = replace(axis, lower=-math.inf, upper=math.inf)
        axes.append(axis)
    return tuple(axes)


def _axis(element: Element, here: Pose, frame: FramePose, context: Context, root: str) -> Axis:
    xyz = element.first("xyz")
    x, y, z = (0.0, 0.0, 1.0) if xyz is None else xyz.vector(3)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0:
        raise element.error("the axis has no direction: <xyz> is 0 0 0")
    direction = (x / length, y / length, z / length)
    expressed_in = "" if xyz is None else xyz.attribute("expressed_in", "")
    # Before SDF 1.5 an axis was written in the model's frame, from then on in the joint's.
    if not expressed_in and element.flag_of("use_parent_model_frame", default=context.version < (1, 5)):
        expressed_in = root
    if expressed_in:
        written_in = frame(expressed_in, element)
        direction = rotate(here.inverse.orientation, rotate(written_in.orientation, direction))
    limit = element.first("limit") or Element("limit")
    dynamics = element.first("dynamics") or Element("dynamics")
    return Axis(
        xyz=direction,
        lower=_limit(limit.number_of("lower", default=-math.inf)),
        upper=_limit(limit.number_of("upper", default=math.inf)),
        effort=_bound(limit.number_of("effort", default=math.inf)),
        velocity=_bound(limit.number_of("velocity", default=math.inf)),
        damping=dynamics.number_of("damping", default=0.0),
        friction=dynamics.number_of("friction", default=0.0),
        spring_stiffness=dynamics.number_of("spring_stiffness", default=0.0),
        spring_reference=dynamics.number_of("spring_reference", default=0.0),
    )


def _across(first: Vector) -> Vector:
    """Return the default second axis: y of the joint's frame, or x where the first axis is y."""
    return (0.0, 1.0, 0.0) if abs(first[1]) < _PARALLEL else (1.0, 0.0, 0.0)


def _limit(value: float) -> float:
    """Return a limit, infinite for the huge numbers that mean "no limit" in SDF."""
    return math.copysign(math.inf, value) if abs(value) >= _UNLIMITED else value


def _bound(value: float) -> float:
    """Return a bound, infinite for the negative numbers that mean "no bound" in SDF."""
    return math.inf if value < 0 or value >= _UNLIMITED else value


def _thread_pitch(element: Element, context: Context) -> float:
    """Return metres per radian; SDF's old ``thread_pitch`` is radians per metre, negative if right-handed."""
    screw = element.first("screw_thread_pitch")
    if screw is not None:
        return screw.number() / (2 * math.pi)
    pitch = element.number_of("thread_pitch", default=1.0)
    return 0.0 if pitch == 0 else -1.0 / pitch


def _mimic(element: Element) -> Mimic | None:
    axis = element.first("axis")
    mimic = None if axis is None else axis.first("mimic")
    if mimic is None:
        return None
    # position = multiplier * (leader - reference) + offset
    multiplier = mimic.number_of("multiplier", default=1.0)
    reference = mimic.number_of("reference", default=0.0)
    offset = mimic.number_of("offset", default=0.0)
    return Mimic(mimic.attribute("joint"), multiplier, offset - multiplier * reference)
