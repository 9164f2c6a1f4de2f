"""An arm that shows where it moves to before it moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from daidalos.common.pose3 import Vector
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.rapid.runtime.arm_robot import MM, ArmRobot, matrix_of
from daidalos.industry.rapid.runtime.robot import Event, Move
from daidalos.industry.robots import Arm

_NO_TIME = 1e-9
"""Time [s] below which a wait is over: less than the resolution of a program's clock."""


@dataclass(frozen=True)
class Announcement:
    """How targets are shown.

    Attributes
    ----------
    show : callable
        Called with the next target of the tool's centre point in the arm's base [m].
    lead : float
        Time between that and the beginning of the movement [s].
    """

    show: Callable[[Vector], None]
    lead: float


class AnnouncedArm(ArmRobot):
    """Arm whose targets are shown a time before each movement begins; a standing arm waits for that time.

    Parameters
    ----------
    arm : Arm
    announcement : Announcement
    **settings
        As for `ArmRobot`.
    """

    def __init__(self, arm: Arm, announcement: Announcement, **settings: Any) -> None:
        super().__init__(arm, **settings)
        self._announcement = announcement
        self._shown: Move | None = None
        self._wait = 0.0

    def order(self, move: Move) -> bool:
        """Take a movement; of an arm that stands, only after its target has been shown for the lead."""
        if self._wait > 0.0:
            return False
        if move is not self._shown and super().remaining() == 0.0:
            self._announcement.show(self._target(move))
            self._shown, self._wait = move, self._announcement.lead
            if self._wait > 0.0:
                return False
        if move is self._shown:
            return super().order(move)
        target = self._target(move)
        event = Event(lambda: self._announcement.show(target), 0.0, True, self._announcement.lead)
        return super().order(replace(move, events=(event, *move.events)))

    def remaining(self) -> float:
        """Return the time until the arm stands in the latest target, and may move again."""
        return max(super().remaining(), self._wait)

    def advance(self, seconds: float) -> None:
        """Advance time."""
        left = self._wait - seconds
        self._wait = left if left > _NO_TIME else 0.0
        super().advance(seconds)

    def _target(self, move: Move) -> Vector:
        if move.instruction == "MoveAbsJ":
            joints = np.radians(np.array(move.target[0], dtype=np.float64))
            x, y, z = (forward(self.arm, joints) @ matrix_of(move.tool[1]))[:3, 3].tolist()
        else:
            x, y, z = (MM * one for one in move.tool_pose()[0])
        return x, y, z
