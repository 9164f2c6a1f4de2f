"""The states of a managed node (ROS 2 design article "Managed nodes"), with lifecycle_msgs' numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from rclpy.impl.errors import RCLError


class TransitionCallbackReturn(IntEnum):
    """Result of a transition's callback."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99


@dataclass(frozen=True)
class State:
    """A state with its number and label."""

    state_id: int
    label: str


@dataclass(frozen=True)
class Transition:
    """A way from one state to another."""

    transition_id: int
    label: str
    start: State
    goal: State


UNKNOWN = State(0, "unknown")
UNCONFIGURED = State(1, "unconfigured")
INACTIVE = State(2, "inactive")
ACTIVE = State(3, "active")
FINALIZED = State(4, "finalized")
CONFIGURING = State(10, "configuring")
CLEANING_UP = State(11, "cleaningup")
SHUTTING_DOWN = State(12, "shuttingdown")
ACTIVATING = State(13, "activating")
DEACTIVATING = State(14, "deactivating")
ERROR_PROCESSING = State(15, "errorprocessing")
STATES = (
    UNKNOWN, UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED, CONFIGURING, CLEANING_UP, SHUTTING_DOWN, ACTIVATING,
    DEACTIVATING, ERROR_PROCESSING,
)  # fmt: skip


def _outcomes(
    first: int, during: State, success: State, failure: State, error: State = ERROR_PROCESSING
) -> tuple[Transition, ...]:
    goals = (success, failure, error)
    return tuple(
        Transition(first + number, f"transition_{outcome.name.lower()}", during, goal)
        for number, (outcome, goal) in enumerate(zip(TransitionCallbackReturn, goals, strict=True))
    )


TRANSITIONS = (
    Transition(1, "configure", UNCONFIGURED, CONFIGURING),
    *_outcomes(10, CONFIGURING, INACTIVE, UNCONFIGURED),
    Transition(2, "cleanup", INACTIVE, CLEANING_UP),
    *_outcomes(20, CLEANING_UP, UNCONFIGURED, INACTIVE),
    Transition(3, "activate", INACTIVE, ACTIVATING),
    *_outcomes(30, ACTIVATING, ACTIVE, INACTIVE),
    Transition(4, "deactivate", ACTIVE, DEACTIVATING),
    *_outcomes(40, DEACTIVATING, INACTIVE, ACTIVE),
    Transition(5, "shutdown", UNCONFIGURED, SHUTTING_DOWN),
    Transition(6, "shutdown", INACTIVE, SHUTTING_DOWN),
    Transition(7, "shutdown", ACTIVE, SHUTTING_DOWN),
    *_outcomes(50, SHUTTING_DOWN, FINALIZED, FINALIZED),
    *_outcomes(60, ERROR_PROCESSING, UNCONFIGURED, FINALIZED, FINALIZED),
)


class StateMachine:
    """The present state, and how to leave it; with the services that tell of it, where there are any."""

    service_change_state: Any = None
    service_get_state: Any = None
    service_get_available_states: Any = None
    service_get_available_transitions: Any = None
    service_get_transition_graph: Any = None

    def __init__(self) -> None:
        self.state = UNCONFIGURED

    @property
    def current_state(self) -> tuple[int, str]:
        """The present state's number and label."""
        return self.state.state_id, self.state.label

    def available(self) -> Iterator[Transition]:
        """Yield the transitions out of the present state."""
        return (transition for transition in TRANSITIONS if transition.start == self.state)

    def by_id(self, transition_id: int) -> Transition:
        """Return the transition out of the present state with that number.

        Raises
        ------
        RCLError
            When there is none.
        """
        for transition in self.available():
            if transition.transition_id == transition_id:
                return transition
        raise RCLError(f"Transition {transition_id} is not registered in state '{self.state.label}'")

    def by_label(self, label: str) -> Transition:
        """Return the transition out of the present state with that label; see `by_id`."""
        for transition in self.available():
            if transition.label == label:
                return transition
        raise RCLError(f"Transition '{label}' is not registered in state '{self.state.label}'")
