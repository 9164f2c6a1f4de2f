"""Stand still for a while."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.behaviors.behavior import Behavior, BehaviorStep, InvalidInput
from daidalos.navigation.costmap.costmap import Costmap

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WaitCommand:
    """How long to stand [s]."""

    wait_duration: float = 1.0


class Wait(Behavior[WaitCommand]):
    """Stands until its time is over."""

    _until = 0.0

    def start(self, command: WaitCommand, pose: Array, now: float) -> None:
        """See `Behavior.start`."""
        if not command.wait_duration >= 0.0:
            raise InvalidInput(f"wait_duration must not be negative, but is {command.wait_duration} s")
        self._until = now + command.wait_duration

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """See `Behavior.step`."""
        left = max(self._until - now, 0.0)
        return BehaviorStep(np.zeros(3), left <= 0.0, left)
