"""All that a simulation needs to go on from an instant."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.simulation.component import Component
from daidalos.simulation.forces import JointPush, Push


@dataclass(frozen=True, eq=False)
class State:
    """All that a simulation needs to go on from an instant; made by `Simulation.save`."""

    time_ns: int
    physics: Any
    compilation: int
    clocks: Mapping[int, tuple[int, int, int]]
    memories: tuple[tuple[Any, Any], ...]
    pushes: tuple[Push | JointPush, ...]


def memories_of(components: Iterable[Component]) -> tuple[tuple[Any, Any], ...]:
    """Return copies of what components remember, and of where their random numbers are."""
    return tuple((copy.deepcopy(c.memory), copy.deepcopy(c.random.bit_generator.state)) for c in components)


def remember(components: Iterable[Component], memories: tuple[tuple[Any, Any], ...]) -> None:
    """Give components back what `memories_of` returned for them."""
    for component, (memory, random) in zip(components, memories, strict=True):
        component.memory = copy.deepcopy(memory)
        component.random.bit_generator.state = copy.deepcopy(random)
