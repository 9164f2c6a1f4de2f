"""The contract of everything that acts in the simulation at its own rate: sensors and plugins."""

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
    """Where a component finds itself when it is made.

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
        Makes its random numbers, which derive from the simulation's seed and its name, from the start.
    warn : callable
        Takes a line for the user.
    """

    model: Model
    model_name: str
    namespace: str
    world: World
    stream: Callable[[], np.random.Generator]
    warn: Callable[[str], None]


def random_stream(seed: int, name: str) -> np.random.Generator:
    """Return random numbers that depend on a seed and a name alone."""
    digest = hashlib.sha256(name.encode()).digest()
    key = [int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4)]
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


@dataclass(frozen=True)
class Switch:
    """A service that turns something on or off.

    Parameters
    ----------
    take : callable
        Takes on or off.
    fixed : bool or None
        What a service without an argument means; None for one that is told.
    """

    take: Callable[[bool], None]
    fixed: bool | None = None


class Component(Endpoint):
    """Something that acts when it is due and may say something then.

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
        """Return the state that it starts with; called once it is bound, and on reset."""
        return None

    def prepare(self, build: ModelBuild) -> None:
        """Add what it needs to the model before that is compiled: actuators, kinds of wheels."""

    def bind(self, instance: Instance) -> None:
        """Look up what it needs in the compiled model; called again whenever models come or go."""

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Act, at a simulated time in nanoseconds, and return what there is to say."""
        raise NotImplementedError

    @property
    def switches(self) -> Mapping[str, Switch]:
        """Services that it offers, by absolute name."""
        return {}
