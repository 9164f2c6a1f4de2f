"""Contract of sensors and plugins, which act in the simulation at their own rate."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.description.world import Model, World
from daidalos.samples.endpoint import Endpoint
from daidalos.samples.sensors import Sample

if TYPE_CHECKING:
    from daidalos.simulation.conversion.model_build import ModelBuild
    from daidalos.simulation.instance import Instance


@dataclass(frozen=True)
class ComponentContext:
    """Context in which a component is created.

    Parameters
    ----------
    model : Model
        Its description.
    model_name : str
        Its name in the simulation.
    namespace : str
        Relative topics go below it.
    world : World
        The description of the world around it.
    stream : callable
        Returns a new generator of its random numbers, seeded by the simulation's seed and its name.
    warn : callable
        Called with a line for the user.
    link, joint : str
        For a sensor: the link that carries it, and the joint that it sits in; empty where there is none.
    """

    model: Model
    model_name: str
    namespace: str
    world: World
    stream: Callable[[], np.random.Generator]
    warn: Callable[[str], None]
    link: str = ""
    joint: str = ""


def random_stream(seed: int, name: str) -> np.random.Generator:
    """Return a random generator that depends only on a seed and a name."""
    digest = hashlib.sha256(name.encode()).digest()
    key = [int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4)]
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


@dataclass(frozen=True)
class Switch:
    """Service that switches something on or off.

    Parameters
    ----------
    take : callable
        Called with on or off.
    fixed : bool or None
        What a service without an argument means; None for one that is told.
    """

    take: Callable[[bool], None]
    fixed: bool | None = None


class Component(Endpoint):
    """Sensor or plugin that is updated at its period and returns samples.

    Attributes
    ----------
    period : float
        Seconds between two updates; 0 acts in every step.
    state : object
        Everything that changes while it runs. It is copied when the simulation's state is saved and
        made anew by `start` when the simulation is reset.
    random : numpy Generator
        Its own stream.
    """

    period: float = 0.0
    state: Any = None

    def __init__(self, context: ComponentContext) -> None:
        self.context = context
        self.random = context.stream()

    def start(self) -> Any:
        """Return the initial state; called after `bind` and on reset."""
        return None

    def prepare(self, build: ModelBuild) -> None:
        """Add what the component needs to the model before compilation, such as actuators."""

    def bind(self, instance: Instance) -> None:
        """Look up what the component needs in the compiled model; called again after models were added or removed."""

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Act at a simulated time [ns] and return the samples to publish."""
        raise NotImplementedError

    @property
    def switches(self) -> Mapping[str, Switch]:
        """Services of the component, by absolute name."""
        return {}
