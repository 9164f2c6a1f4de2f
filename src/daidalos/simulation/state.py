"""Complete state of a simulation at an instant."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.simulation.contracts import Component
from daidalos.simulation.forces import JointPush, Push


@dataclass(frozen=True, eq=False)
class State:
    """Complete state of a simulation, returned by `Simulation.save`."""

    time_ns: int
    physics: Any
    compilation: int
    clocks: Mapping[int, tuple[int, int, int]]
    component_states: tuple[tuple[Any, Any], ...]
    pushes: tuple[Push | JointPush, ...]


def copy_states(components: Iterable[Component]) -> tuple[tuple[Any, Any], ...]:
    """Return copies of the states of components and of their random generators."""
    return tuple((copy.deepcopy(c.state), copy.deepcopy(c.random.bit_generator.state)) for c in components)


def restore_states(components: Iterable[Component], component_states: tuple[tuple[Any, Any], ...]) -> None:
    """Restore what `copy_states` returned for the components."""
    for component, (state, random) in zip(components, component_states, strict=True):
        component.state = copy.deepcopy(state)
        component.random.bit_generator.state = copy.deepcopy(random)
