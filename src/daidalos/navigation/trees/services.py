"""Services of the robot for a tree: time and tasks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from daidalos.navigation.trees.action_node import ActionNode


@dataclass(frozen=True)
class Outcome:
    """Result of a task.

    Attributes
    ----------
    succeeded : bool
        Whether it did what was asked.
    outputs : mapping of str to object
        Values for the output ports of the node that asked (`path`, ...).
    error_code : str
        Name of the error code of the action, `NONE` on success.
    error_msg : str
        Why it failed, for people.
    """

    succeeded: bool
    outputs: Mapping[str, Any] = field(default_factory=dict)
    error_code: str = "NONE"
    error_msg: str = ""


class Task(Protocol):
    """Started task."""

    def poll(self) -> Outcome | None:
        """Return the outcome; `None` while the task runs. Never blocks."""

    def update(self, goal: Mapping[str, Any]) -> None:
        """Replace the goal (such as a new path while following one)."""

    def halt(self) -> None:
        """Stop the task; it is not polled afterwards."""


class Services(Protocol):
    """Binding of a tree's leaves to a robot: actions and services of ROS, or direct calls."""

    def now(self) -> float:
        """Return the time [s]."""

    def start(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        """Start a task.

        Parameters
        ----------
        node : type
            Class of the leaf that asks.
        goal : mapping of str to object
            Its input ports by name. A port that the tree does not set has the node's default.
        """
