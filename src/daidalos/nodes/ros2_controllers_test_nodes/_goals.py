"""Common base of the goal publishers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import cycle
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare


@dataclass(frozen=True)
class GoalParameters(Parameters):
    """Common parameters of the goal publishers."""

    wait_sec_between_publish: float = parameter(5.0, "Time between goals.", unit="s", above=0.0, takes_integer=True)
    goal_names: tuple[str, ...] = parameter(("pos1", "pos2"), "Names of the goals, which are parameters themselves.")


class GoalPublisher(Node):
    """Node that sends its goals in turn.

    Parameters
    ----------
    name
        The node's.
    parameters
        The class of its parameters.
    """

    def __init__(self, name: str, parameters: type[GoalParameters], **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._goals: Iterator[Any] = iter(())
        self.settings: Any = declare(self, parameters)
        self.wait_s = self.settings.wait_sec_between_publish
        self.goal_names = self.settings.goal_names

    def numbers(self, parameter: str) -> list[float]:
        """Declare a parameter and return its numbers; none where it is not set or holds something else."""
        values = self.declare_parameter(parameter, None, ParameterDescriptor(dynamic_typing=True)).value
        given = values if hasattr(values, "__iter__") and not isinstance(values, str) else ()
        return [float(value) for value in given if isinstance(value, (int, float))]

    def start(self, goals: list[Any]) -> None:
        """Send these goals from now on."""
        self._goals = cycle(goals)
        self.create_timer(self.wait_s, self._send_next)

    def send(self, goal: Any) -> None:
        """Publish one goal."""
        raise NotImplementedError

    def is_ready(self) -> bool:
        """Return whether a goal may be sent now."""
        return True

    def _send_next(self) -> None:
        if self.is_ready():
            self.send(next(self._goals))
