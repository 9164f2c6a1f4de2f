"""SDF's ``<link>``: inertial, collisions, visuals, sensors and lights."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.inertia import WATER, link_properties
from daidalos.description.link import (
    Collision,
    Inertial,
    Light,
    Link,
    Plugin,
    Sensor,
    Surface,
    Visual,
)
from daidalos.description.markup import Element
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.geometry import read_geometry
from daidalos.description.sdf.materials import read_color, read_material

PoseResolver = Callable[[Element], Pose]
"""Takes an element with a ``<pose>``, returns that pose in the frame of the link that carries it."""

_UNUSED = ("projector", "particle_emitter", "audio_source", "audio_sink")


def read_link(element: Element, context: Context, pose: Pose, place: PoseResolver) -> Link:
    """Read a link.

    Parameters
    ----------
    element : Element
        ``<link>``.
    context : Context
    pose : Pose
        The link in its model, resolved.
    place : callable
        Resolves the poses of what is on the link.
    """
    inertial = element.first("inertial")
    decay = element.first("velocity_decay") or Element("velocity_decay")
    self_collide = element.first("self_collide")
    automatic = inertial is not None and inertial.attribute("auto", "false") in ("true", "1")
    _warn_of_faults(element, context)
    link = Link(
        name=element.name(),
        pose=pose,
        inertial=None if automatic else _inertial(inertial or Element("inertial"), place),
        visuals=tuple(_visual(child, context, place) for child in element.all("visual")),
        collisions=tuple(_collision(child, context, place) for child in element.all("collision")),
        sensors=tuple(read_sensor(child, place) for child in element.all("sensor")),
        lights=tuple(read_light(child, place(child)) for child in element.all("light")),
        gravity=element.flag_of("gravity", default=True),
        kinematic=element.flag_of("kinematic", default=False),
        self_collide=None if self_collide is None else self_collide.flag(),
        wind=element.flag_of("enable_wind", default=False),
        linear_damping=decay.number_of("linear", default=0.0),
        angular_damping=decay.number_of("angular", default=0.0),
        where=element.where,
    )
    return _with_automatic_inertia(link, element) if automatic else link


def read_sensor(element: Element, place: PoseResolver) -> Sensor:
    """Read the common part of all sensors; the rest stays in `Sensor.element`."""
    rate = element.number_of("update_rate", default=0.0)
    if rate < 0:
        raise element.error(f"<update_rate> should not be negative, got {rate:g}")
    return Sensor(
        name=element.name(),
        type=element.attribute("type"),
        element=element,
        pose=place(element),
        update_rate=rate,
        topic=element.text_of("topic"),
        always_on=element.flag_of("always_on", default=True),
        visualize=element.flag_of("visualize", default=False),
        plugins=tuple(read_plugin(child) for child in element.all("plugin")),
    )


def read_plugin(element: Element) -> Plugin:
    """Read a plugin's name and file; its parameters stay in `Plugin.element`."""
    return Plugin(element.attribute("name", ""), element.attribute("filename", ""), element)


def read_label(element: Element) -> int | None:
    """Read the class for segmentation cameras: gz's Label system of a visual, a model or an include."""
    labels = (plugin.integer_of("label", default=0) for plugin in element.all("plugin") if _is_label(plugin))
    return next(labels, None)


def labelled(links: Mapping[str, Link], label: int | None) -> dict[str, Link]:
    """Return links whose visuals have a label: their own, else this one."""
    if label is None:
        return dict(links)
    return {
        name: replace(link, visuals=tuple(v if v.label is not None else replace(v, label=label) for v in link.visuals))
        for name, link in links.items()
    }


def read_light(element: Element, pose: Pose) -> Light:
    """Read a light of the world or of a link."""
    fade = element.first("attenuation") or Element("attenuation")
    spot = element.first("spot") or Element("spot")
    x, y, z = element.vector_of("direction", size=3, default=(0.0, 0.0, -1.0))
    return Light(
        name=element.attribute("name", ""),
        type=element.attribute("type", "point"),
        pose=pose,
        diffuse=read_color(element, "diffuse") or (1.0, 1.0, 1.0, 1.0),
        specular=read_color(element, "specular") or (0.1, 0.1, 0.1, 1.0),
        direction=(x, y, z),
        attenuation_range=fade.number_of("range", default=10.0),
        attenuation_constant=fade.number_of("constant", default=1.0),
        attenuation_linear=fade.number_of("linear", default=1.0),
        attenuation_quadratic=fade.number_of("quadratic", default=0.0),
        intensity=element.number_of("intensity", default=1.0),
        cast_shadows=element.flag_of("cast_shadows", default=False),
        on=element.flag_of("light_on", default=True),
        spot_inner_angle=spot.number_of("inner_angle", default=0.0),
        spot_outer_angle=spot.number_of("outer_angle", default=0.0),
        spot_falloff=spot.number_of("falloff", default=0.0),
    )


def _inertial(element: Element, place: PoseResolver) -> Inertial:
    """Read mass properties; missing values are one, as in SDF."""
    mass = element.number_of("mass", default=1.0)
    if mass < 0:
        raise element.error(f"mass should not be negative, got {mass:g}")
    moments = element.first("inertia") or Element("inertia")
    xx, xy, xz, yy, yz, zz = (
        moments.number_of(key, default=1.0 if key in ("ixx", "iyy", "izz") else 0.0)
        for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    return Inertial(mass, place(element), (xx, xy, xz, yy, yz, zz))


def _with_automatic_inertia(link: Link, element: Element) -> Link:
    """Compute the inertial from the collisions (SDF 1.11); a given mass scales it."""
    inertial = element.require("inertial")
    default = inertial.number_of("density", default=WATER)
    densities = [child.number_of("density", default=default) for child in element.all("collision")]
    computed = link_properties(link, densities=densities)
    mass = inertial.number_of("mass", default=computed.mass)
    if computed.mass <= 0:
        raise inertial.error("auto needs collisions with a volume")
    xx, xy, xz, yy, yz, zz = (moment * mass / computed.mass for moment in computed.inertia)
    return replace(link, inertial=Inertial(mass, computed.pose, (xx, xy, xz, yy, yz, zz)))


def _visual(element: Element, context: Context, place: PoseResolver) -> Visual:
    flags = element.number_of("visibility_flags", default=float(0xFFFFFFFF))
    return Visual(
        geometry=read_geometry(element, context),
        pose=place(element),
        material=read_material(element.first("material"), context),
        name=element.attribute("name", ""),
        transparency=element.number_of("transparency", default=0.0),
        cast_shadows=element.flag_of("cast_shadows", default=True),
        visibility_flags=int(flags),
        label=read_label(element),
    )


def _warn_of_faults(element: Element, context: Context) -> None:
    """Warn about elements of a link that have no effect here, and of names that are taken."""
    for tag in ("visual", "collision"):
        names: set[str] = set()
        for child in element.all(tag):
            name = child.attribute("name", "")
            if name in names and name:
                context.warn(child, f"the link has another {tag} of this name, which SDF does not permit")
            names.add(name)
    for child in element.all(*_UNUSED):
        context.warn(child, "has no effect, left out")
    for visual in element.all("visual"):
        for plugin in visual.all("plugin"):
            if not _is_label(plugin):
                file = plugin.attribute("filename", "")
                context.warn(plugin, f"plugins of visuals ({file}) have no effect, left out")


def _is_label(plugin: Element) -> bool:
    return "label" in plugin.attribute("filename", "").lower() or plugin.attribute("name", "").endswith("::Label")


def _collision(element: Element, context: Context, place: PoseResolver) -> Collision:
    surface = element.first("surface")
    return Collision(
        geometry=read_geometry(element, context),
        pose=place(element),
        surface=Surface() if surface is None else _surface(surface),
        name=element.attribute("name", ""),
        laser_retro=element.number_of("laser_retro", default=0.0),
        where=element.where,
    )


def _surface(element: Element) -> Surface:
    friction = _below(element, "friction", "ode")
    bullet = _below(element, "friction", "bullet")
    torsional = _below(element, "friction", "torsional")
    contact = _below(element, "contact")
    stiffness = _below(element, "contact", "ode")
    bounce = _below(element, "bounce")
    direction, direction_frame = read_direction(friction.first("fdir1"))
    return Surface(
        direction=direction,
        direction_frame=direction_frame,
        mu=_optional(friction, "mu", _optional(bullet, "friction")),
        mu2=_optional(friction, "mu2", _optional(bullet, "friction2")),
        slip1=_optional(friction, "slip1"),
        slip2=_optional(friction, "slip2"),
        torsional=_optional(torsional, "coefficient"),
        patch_radius=torsional.number_of("patch_radius", default=0.0),
        kp=_optional(stiffness, "kp"),
        kd=_optional(stiffness, "kd"),
        restitution=bounce.number_of("restitution_coefficient", default=0.0),
        restitution_threshold=bounce.number_of("threshold", default=0.0),
        collide=not contact.flag_of("collide_without_contact", default=False),
        bitmask=_bitmask(contact),
    )


def read_direction(element: Element | None) -> tuple[Vector, str]:
    """Read the first direction of friction and its frame; zero and an empty name without one."""
    if element is None or not element.text.strip():
        return (0.0, 0.0, 0.0), ""
    x, y, z = element.vector(3)
    frame = element.attribute("gz:expressed_in", element.attribute("ignition:expressed_in", ""))
    return (x, y, z), frame


def _bitmask(contact: Element) -> int:
    element = contact.first("collide_bitmask")
    if element is None:
        return 0xFFFF
    try:
        return int(element.text.strip(), 0)
    except ValueError:
        raise element.error(f"expected an integer, got {element.text.strip()!r}") from None


def _below(element: Element, *tags: str) -> Element:
    """Return the element at the end of a path of tags; an empty element if it does not exist."""
    for tag in tags:
        element = element.first(tag) or Element(tag, source=element.source, line=element.line)
    return element


def _optional(element: Element, tag: str, otherwise: float | None = None) -> float | None:
    child = element.first(tag)
    return otherwise if child is None else child.number()
