"""SDF's ``<world>``: models, lights, physics and scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from daidalos.common.pose3 import Pose
from daidalos.description.joint import Joint
from daidalos.description.link import Light
from daidalos.description.markup import Element
from daidalos.description.sdf.actors import read_actor
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.frames import FrameGraph, RelativePose, read_pose
from daidalos.description.sdf.includes import read_include, resolve_missing
from daidalos.description.sdf.joints import read_joint
from daidalos.description.sdf.links import read_light, read_plugin
from daidalos.description.sdf.materials import read_color
from daidalos.description.sdf.models import link_names, place_nested, read_model
from daidalos.description.sdf.population import population_poses
from daidalos.description.world import (
    Actor,
    Atmosphere,
    Model,
    Physics,
    Scene,
    SphericalCoordinates,
    World,
)

ROOT = "world"
MAX_DISTANCE = 1e6
"""Distance [m] beyond which a saved model must have fallen through its floor; forces would diverge."""


def read_world(element: Element, context: Context) -> World:
    """Read a ``<world>``.

    Raises
    ------
    DescriptionError
        When something in it is wrong; names file, line and element.
    """
    return _WorldReader(element, context).world()


class _WorldReader:
    def __init__(self, element: Element, context: Context) -> None:
        self._element = element
        self._context = context
        self._graph = FrameGraph(ROOT)
        self._models: list[tuple[Model, Element]] = []
        self._lights: list[tuple[Light, RelativePose, Element]] = []
        self._actors: list[tuple[Actor, RelativePose, Element]] = []
        self._attached: dict[str, str] = {}
        self._missing: dict[str, tuple[RelativePose, Element]] = {}
        self._joints: list[Element] = []
        self._saved = _saved_poses(element.first("state"))

    def world(self) -> World:
        element, base = self._element, World()
        self._read_contents()
        physics = _default_physics(element)
        return World(
            name=_name(element, self._context),
            models=tuple(self._placed()),
            lights=tuple(
                replace(light, pose=self._graph.place(pose, ROOT, child)) for light, pose, child in self._lights
            ),
            actors=tuple(
                replace(actor, pose=self._graph.place(pose, ROOT, child)) for actor, pose, child in self._actors
            ),
            joints={joint.name: joint for joint in map(self._joint, self._joints)},
            frames={name: self._graph.pose(name, element) for name in self._graph.names()},
            physics=_physics(physics),
            gravity=_vector(physics if physics.first("gravity") else element, "gravity", base.gravity),
            magnetic_field=_vector(
                physics if physics.first("magnetic_field") else element, "magnetic_field", base.magnetic_field
            ),
            wind=_vector(element.first("wind") or element, "linear_velocity", base.wind),
            scene=_scene(element.first("scene")),
            atmosphere=_atmosphere(element.first("atmosphere")),
            spherical_coordinates=_spherical_coordinates(element.first("spherical_coordinates")),
            plugins=tuple(read_plugin(child) for child in element.all("plugin")),
            source=element.source,
            warnings=tuple(self._context.warnings),
        )

    def _read_contents(self) -> None:
        """Read everything that has a pose; poses are resolved when all names are known."""
        for child in self._element.children:
            if child.tag == "model":
                self._add_model(read_model(child, self._context), read_pose(child), child)
            elif child.tag == "light":
                light = read_light(child, Pose())
                self._lights.append((light, self._saved.get(light.name, read_pose(child)), child))
            elif child.tag == "include":
                self._add_included(child)
            elif child.tag == "actor":
                self._actors.append((read_actor(child, self._context), read_pose(child), child))
            elif child.tag == "population":
                self._add_population(child)
            elif child.tag == "road":
                self._context.warn(child, "has no effect, left out")
            elif child.tag == "frame":
                self._add_frame(child)
        joints = self._element.all("joint")
        self._joints = resolve_missing(self._missing, self._graph, joints, self._context)
        for child in self._joints:
            self._graph.add(child.name(), read_pose(child), child.text_of("child"), child)
            self._attached[child.name()] = child.text_of("child")

    def _add_frame(self, element: Element) -> None:
        name, attached_to = element.name(), element.attribute("attached_to", "") or ROOT
        if self._context.version < (1, 7) and any(model.name() == name for model in self._element.all("model")):
            self._context.warn(element, f"a model is called {name!r} as well, the frame is called {name}_frame")
            name = f"{name}_frame"
        self._graph.add(name, read_pose(element), attached_to, element)
        self._attached[name] = attached_to

    def _add_included(self, element: Element) -> None:
        included = read_include(element, self._context, read_model)
        if included.missing:
            self._missing[included.missing] = (included.pose, element)
        elif isinstance(included.content, Light):
            self._lights.append((included.content, included.pose, element))
        elif isinstance(included.content, Actor):
            self._actors.append((included.content, included.pose, element))
        elif included.content is not None:
            self._add_model(included.content, included.pose, element)

    def _add_population(self, element: Element) -> None:
        """Add the models of a population, numbered as Gazebo numbers them."""
        child = element.first("model", "include")
        if child is None:
            raise element.error("<model> is missing")
        if child.tag == "include":
            included = read_include(child, self._context, read_model).content
        else:
            included = read_model(child, self._context)
        if not isinstance(included, Model):
            return
        for number, pose in enumerate(population_poses(element, read_pose(element).pose)):
            name = f"{included.name}_clone_{number}"
            self._add_model(replace(included, name=name), RelativePose(pose @ included.pose), element)

    def _add_model(self, model: Model, pose: RelativePose, element: Element) -> None:
        """Add a model; as in Gazebo, a duplicate name gets a number."""
        taken = {other.name for other, _ in self._models}
        if model.name in taken:
            number = next(i for i in range(len(taken) + 1) if f"{model.name}_{i}" not in taken)
            self._context.warn(element, f"the name {model.name!r} is taken, called {model.name}_{number}")
            model = replace(model, name=f"{model.name}_{number}")
        self._models.append((model, element))
        place_nested(self._graph, model, self._saved.get(model.name, pose), element)

    def _placed(self) -> Iterator[Model]:
        for model, element in self._models:
            pose = self._graph.pose(model.name, element)
            farthest = max(map(abs, pose.position))
            if farthest > MAX_DISTANCE:
                self._context.warn(element, f"{model.name!r} is {farthest:.3g} m away, left out")
            else:
                yield replace(model, pose=pose)

    def _joint(self, element: Element) -> Joint:
        return read_joint(element, self._context, element.name(), self._graph.pose, self._link_of, ROOT)

    def _link_of(self, name: str, element: Element) -> str:
        """Follow the world's frames and joints to their link."""
        seen: list[str] = []
        while name in self._attached:
            if name in seen:
                raise element.error(f"{name!r} is attached to itself")
            seen.append(name)
            name = self._attached[name]
        for model, _ in self._models:
            carried = link_names(model, f"{model.name}::")
            if name in carried:
                return carried[name]
        if name == ROOT:
            return ROOT
        raise element.error(f"there is no link {name!r}; expected a model, or model::link")


def _name(element: Element, context: Context) -> str:
    name = element.attribute("name", "")
    if not name:
        context.warn(element, f'attribute "name" is missing, the world is called {World().name!r}')
    return name or World().name


def _saved_poses(state: Element | None) -> dict[str, RelativePose]:
    """Return the poses of models and lights in ``<state>``, which Gazebo classic writes when it saves a world."""
    if state is None:
        return {}
    placed = [child for child in state.all("model", "light") if child.first("pose") is not None]
    return {child.attribute("name", ""): RelativePose(read_pose(child).pose) for child in placed}


def _default_physics(element: Element) -> Element:
    choices = element.all("physics")
    marked = [choice for choice in choices if choice.attribute("default", "") in ("true", "1")]
    return (marked or choices or [Element("physics")])[0]


def _physics(element: Element) -> Physics:
    base = Physics()
    step = element.number_of("max_step_size", default=base.max_step_size)
    if not 0 < step <= 1:
        child = element.first("max_step_size") or element
        raise child.error(f"expected a step between 0 and 1 s, got {step:g}")
    return Physics(
        max_step_size=step,
        real_time_factor=element.number_of("real_time_factor", default=base.real_time_factor),
        real_time_update_rate=element.number_of("real_time_update_rate", default=base.real_time_update_rate),
    )


def _vector(element: Element, tag: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = element.vector_of(tag, size=3, default=default)
    return x, y, z


def _scene(element: Element | None) -> Scene:
    base = Scene()
    if element is None:
        return base
    return Scene(
        ambient=read_color(element, "ambient") or base.ambient,
        background=read_color(element, "background") or base.background,
        shadows=element.flag_of("shadows", default=base.shadows),
        grid=element.flag_of("grid", default=base.grid),
        sky=element.first("sky") is not None or element.first("background") is None,
    )


def _atmosphere(element: Element | None) -> Atmosphere:
    base = Atmosphere()
    if element is None:
        return base
    return Atmosphere(
        temperature=element.number_of("temperature", default=base.temperature),
        temperature_gradient=element.number_of("temperature_gradient", default=base.temperature_gradient),
        pressure=element.number_of("pressure", default=base.pressure),
    )


def _spherical_coordinates(element: Element | None) -> SphericalCoordinates | None:
    if element is None:
        return None
    return SphericalCoordinates(
        latitude=element.number_of("latitude_deg", default=0.0),
        longitude=element.number_of("longitude_deg", default=0.0),
        elevation=element.number_of("elevation", default=0.0),
        heading=element.number_of("heading_deg", default=0.0),
    )
