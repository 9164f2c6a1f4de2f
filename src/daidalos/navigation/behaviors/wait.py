"""Behavior that waits."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.contracts import Behavior, BehaviorStep
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import InvalidInput


@dataclass(frozen=True)
class WaitCommand:
    """Waiting time [s]."""

    wait_duration: float = 1.0


class Wait(Behavior[WaitCommand]):
    """Behavior that waits for a time."""

    names = ("nav2_behaviors::Wait",)
    action = "nav2_msgs/action/Wait"
    feedback = "time_left"
    moves = False
    _until = 0.0

    @classmethod
    def command(cls, goal: Any) -> WaitCommand:
        """Implement `Behavior.command`."""
        return WaitCommand(goal.time)

    def start(self, command: WaitCommand, pose: Array, now: float) -> None:
        """Implement `Behavior.start`."""
        if not command.wait_duration >= 0.0:
            raise InvalidInput(f"wait_duration must not be negative, but is {command.wait_duration} s")
        self._until = now + command.wait_duration

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Implement `Behavior.step`."""
        left = max(self._until - now, 0.0)
        return BehaviorStep(np.zeros(3), left <= 0.0, left)
