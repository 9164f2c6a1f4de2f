"""Movement profile of the two axes: limited speed and acceleration, any new target at any time."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.industry.lighting.kinematics import Angles, Limits


@dataclass
class _Axis:
    """Position [rad] and speed [rad/s] of one axis."""

    position: float
    speed: float = 0.0

    def step(self, target: float, limit: float, acceleration: float, dt: float) -> None:
        """Move towards a target: accelerate, run at the limit, brake to stand still there."""
        rest = target - self.position
        brake = acceleration * dt
        # The greatest speed (n + f) brake of this step, n whole and f below 1, from which braking step by step still
        # ends at the target: the way left is (n + 1) (n / 2 + f) brake dt.
        way = abs(rest) / (brake * dt)
        whole = math.floor(0.5 * (math.sqrt(1.0 + 8.0 * way) - 1.0))
        wanted = min(limit, brake * (0.5 * whole + way / (whole + 1.0)))
        change = math.copysign(wanted, rest) - self.speed
        self.speed += min(max(change, -brake), brake)
        self.position += self.speed * dt
        if abs(target - self.position) < 1e-6 and abs(self.speed) <= brake:
            self.position = target  # the next step takes the rest of the speed


class Motion:
    """Movement of a head from where it is to the newest target.

    Parameters
    ----------
    start : Angles
        Where it stands.
    limits : Limits
        Speeds and acceleration.
    """

    def __init__(self, start: Angles, limits: Limits) -> None:
        self._pan, self._tilt = _Axis(start.pan), _Axis(start.tilt)
        self._limits = limits
        self.target = start

    @property
    def angles(self) -> Angles:
        """Where the head is."""
        return Angles(self._pan.position, self._tilt.position)

    @property
    def speeds(self) -> Angles:
        """How fast both axes turn [rad/s]."""
        return Angles(self._pan.speed, self._tilt.speed)

    @property
    def is_moving(self) -> bool:
        """Whether the target is not reached yet."""
        return self.angles != self.target or self._pan.speed != 0.0 or self._tilt.speed != 0.0

    def jump(self, angles: Angles) -> None:
        """Set where the head is, at rest."""
        self._pan, self._tilt = _Axis(angles.pan), _Axis(angles.tilt)
        self.target = angles

    def step(self, dt: float) -> Angles:
        """Move for a time [s]; return where the head is then."""
        limits = self._limits
        self._pan.step(self.target.pan, limits.pan_speed, limits.acceleration, dt)
        self._tilt.step(self.target.tilt, limits.tilt_speed, limits.acceleration, dt)
        return self.angles
