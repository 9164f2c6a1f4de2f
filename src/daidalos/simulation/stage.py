"""Visible content for cameras: models, lights and sky."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from daidalos.common.pose3 import Pose
from daidalos.description.link import Light
from daidalos.description.world import Model, World
from daidalos.simulation.errors import UnknownNameError
from daidalos.simulation.rendering.lighting import Lighting

if TYPE_CHECKING:
    from daidalos.simulation.rendering.scene import Item, Scene


class VisibleLink(Protocol):
    """Link of a model: its body in MuJoCo's arrays, and its pose in the world."""

    @property
    def body(self) -> int:
        """Index of the body."""

    @property
    def pose(self) -> Pose:
        """Current pose in the world."""


class VisibleModel(Protocol):
    """Model that cameras see."""

    name: str

    @property
    def model(self) -> Model:
        """Description of the model."""

    def link(self, name: str) -> VisibleLink:
        """Return a link by its name in the description."""


class Stage:
    """Visible content of a simulation; its scene is created on first use by a camera.

    Parameters
    ----------
    world : World
    warn : callable
        Called with a line for each visual that cannot be drawn.
    """

    def __init__(self, world: World, warn: Callable[[str], None]) -> None:
        self._look = world.scene
        self._lamps = {light.name: light for light in world.lights}
        self._switched: dict[str, Light] = {}
        self._warn_user = warn
        self._warned: set[str] = set()
        self._instances: tuple[VisibleModel, ...] = ()
        self._scene: Scene | None = None

    def bind(self, instances: Iterable[VisibleModel]) -> None:
        """Update the models after a compilation."""
        self._instances = tuple(instances)
        if self._scene is not None:
            self._scene.shared.clear()  # which refers to the scene
        self._scene = None

    @property
    def owners(self) -> tuple[str, ...]:
        """Names of the models, indexed by the scene's `owners`."""
        return tuple(instance.name for instance in self._instances)

    @property
    def scene(self) -> Scene:
        """Triangles of all visuals."""
        if self._scene is None:
            from daidalos.simulation.rendering.scene import make_scene

            self._scene = make_scene(self._items(), self._warn)
        return self._scene

    @property
    def lighting(self) -> Lighting:
        """Current lights and background."""
        look = self._look
        return Lighting(
            [(light, pose) for _, light, pose in self._shining()],
            look.ambient,
            look.background,
            look.sky,
            look.shadows,
        )

    # Lights

    @property
    def lights(self) -> dict[str, Light]:
        """Lights by name, those on links as ``model::link::name``, with their poses in the world."""
        return {name: replace(light, pose=pose) for name, light, pose in self._shining()}

    def light(self, name: str) -> Light:
        """Return a light.

        Raises
        ------
        UnknownNameError
        """
        lights = self.lights
        if name not in lights:
            raise UnknownNameError("light", name, lights)
        return lights[name]

    def set_light(self, name: str, light: Light) -> None:
        """Change a light; one on a link keeps its pose.

        Raises
        ------
        UnknownNameError
        """
        self.light(name)
        (self._lamps if name in self._lamps else self._switched)[name] = light

    def remove_light(self, name: str) -> None:
        """Remove a light of the world.

        Raises
        ------
        UnknownNameError
        """
        if name not in self._lamps:
            raise UnknownNameError("light", name, self._lamps)
        del self._lamps[name]

    def _shining(self) -> Iterator[tuple[str, Light, Pose]]:
        for name, light in self._lamps.items():
            yield name, light, light.pose
        for instance in self._instances:
            for link in instance.model.links.values():
                for light in link.lights:
                    name = f"{instance.name}::{link.name}::{light.name}"
                    yield name, self._switched.get(name, light), instance.link(link.name).pose @ light.pose

    def _warn(self, line: str) -> None:
        """Warn once of something that cannot be drawn, however often the scene is created."""
        if line not in self._warned:
            self._warned.add(line)
            self._warn_user(line)

    def _items(self) -> Iterator[Item]:
        from daidalos.simulation.rendering.scene import UNLABELLED, Item

        for owner, instance in enumerate(self._instances):
            for link in instance.model.links.values():
                body = instance.link(link.name).body
                for visual in link.visuals:
                    label = UNLABELLED if visual.label is None else visual.label
                    yield Item(visual, body, owner, label)
