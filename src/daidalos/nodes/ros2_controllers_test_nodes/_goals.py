"""Common base of the goal publishers."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node


class GoalPublisher(Node):
    """Node that sends its goals in turn, one every ``wait_sec_between_publish`` seconds."""

    def __init__(self, name: str, wait_s: int, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._goals: Iterator[Any] = iter(())
        anything = ParameterDescriptor(dynamic_typing=True)
        self.wait_s = float(self.declare_parameter("wait_sec_between_publish", wait_s, anything).value)
        self.goal_names = list(self.declare_parameter("goal_names", ["pos1", "pos2"]).value)

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
