"""Condition nodes on the robot's motion."""

from typing import Any, ClassVar

import numpy as np
from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port

_BRAKE_LIMIT = -10.0
"""Acceleration [m/s^2] below which a robot did not brake but was stopped, as in Nav2."""


class IsStuck(Node):
    """Condition node that succeeds while the last two odometry messages say that the robot was stopped abruptly."""

    names = ("IsStuck",)
    _last: Any = None
    _acceleration = 0.0

    def update(self) -> Status:
        """Compute the acceleration from each new message and the one before."""
        latest = self.services.latest("odom", "nav_msgs/msg/Odometry")
        if latest is not None and latest is not self._last:
            if self._last is not None:
                step = _time(latest) - _time(self._last)
                change = latest.twist.twist.linear.x - self._last.twist.twist.linear.x
                self._acceleration = change / step if step > 0.0 else 0.0
            self._last = latest
        return Status.SUCCESS if self._acceleration < _BRAKE_LIMIT else Status.FAILURE


class IsStopped(Node):
    """Condition node that runs while the robot stands still, and succeeds after a time `duration_stopped` [ms] of it.

    It fails while the robot moves, and where there is no odometry.
    """

    names = ("IsStopped", "CheckStopStatus")
    PORTS: ClassVar[dict[str, Port]] = {
        "velocity_threshold": Port(float, 0.01),
        "duration_stopped": Port(int, 1000),
    }
    _since: float | None = None

    def update(self) -> Status:
        """Compare the velocity (m/s and rad/s) with the threshold."""
        velocity = self.services.velocity()
        if velocity is None or np.any(np.abs(velocity) >= self.ports.get("velocity_threshold")):
            self._since = None
            return Status.FAILURE
        now = self.services.now()
        if self._since is None:
            self._since = now
        if now - self._since <= self.ports.get("duration_stopped") / 1000.0:
            return Status.RUNNING
        self._since = None
        return Status.SUCCESS


def _time(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)
