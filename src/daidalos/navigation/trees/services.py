"""What a tree asks of the robot: time, and tasks that take a while."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from daidalos.navigation.trees.action_node import ActionNode


@dataclass(frozen=True)
class Outcome:
    """How a task ended.

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
    """Something that was started."""

    def poll(self) -> Outcome | None:
        """How it ended; `None` while it goes on. Never waits."""

    def update(self, goal: Mapping[str, Any]) -> None:
        """Go on with another goal (a new path while following one)."""

    def halt(self) -> None:
        """Stop; nothing is polled afterwards."""


class Services(Protocol):
    """Binds the leaves of a tree to a robot: to the actions and services of ROS, or to direct calls."""

    def now(self) -> float:
        """Time [s]."""

    def start(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        """Start a task.

        Parameters
        ----------
        node : type
            Class of the leaf that asks.
        goal : mapping of str to object
            Its input ports by name. A port that the tree does not set has the node's default.
        """
