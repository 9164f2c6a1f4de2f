"""Persistent forces of a world: the ``<persistent>`` wrenches of gz's ApplyLinkWrench system."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from daidalos.common.pose3 import Vector
from daidalos.description.markup import Element
from daidalos.description.world import Model, World
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import Component, ComponentContext
from daidalos.simulation.forces import Push
from daidalos.simulation.instance import Instance
from daidalos.simulation.libraries import library_of

LIBRARY = "gz-sim-apply-link-wrench-system"
_NEVER = 1e6  # seconds between two updates, in which there is nothing to do


class PersistentForces(Component):
    """Component that applies the persistent forces of its model.

    Parameters
    ----------
    context : ComponentContext
    """

    period = _NEVER

    def __init__(self, context: ComponentContext) -> None:
        super().__init__(context)
        self._pushes = persistent_forces(context.model, context.world)

    def bind(self, instance: Instance) -> None:
        """Find the external forces."""
        self._forces = instance.physics.forces

    def start(self) -> None:
        """Add the forces, since a reset removed them."""
        for push in self._pushes:
            self._forces.add(push)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Do nothing; the forces act by themselves."""
        return ()


def persistent_forces(model: Model, world: World) -> list[Push]:
    """Return the persistent forces on a model's links; one on the model acts on its first link.

    Raises
    ------
    DescriptionError
        When a force or torque is no vector.
    """
    named = {f"{model.name}::{link}": link for link in model.links}
    named[model.name] = next(iter(model.links), "")
    pushes = ((named.get(_name(element), ""), element) for element in _persistent(world))
    return [Push(model.name, link, _vector(one, "force"), _vector(one, "torque")) for link, one in pushes if link]


def check_persistent_forces(world: World, warn: Callable[[str], None]) -> None:
    """Warn of forces on models and links that are not in the world."""
    known = {name for model in world.models for name in (model.name, *(f"{model.name}::{li}" for li in model.links))}
    for element in _persistent(world):
        if _name(element) not in known:
            warn(f"{element.where}: there is no {_name(element)!r} to push, left out")


def _persistent(world: World) -> Iterator[Element]:
    for plugin in world.plugins:
        if library_of(plugin) == LIBRARY:
            yield from plugin.element.all("persistent")


def _name(element: Element) -> str:
    return element.text_of("entity_name")


def _vector(element: Element, tag: str) -> Vector:
    x, y, z = element.vector_of(tag, size=3, default=(0.0, 0.0, 0.0))
    return x, y, z
