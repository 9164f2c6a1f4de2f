"""Slow motion of `move_base`'s recovery `move_slow_and_clear`."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from rclpy.node import Node

_PERIOD_S = 0.1


class SlowMotion:
    """Limit of the controller's speed until the robot has moved some distance.

    Parameters
    ----------
    node : Node
    topic : str
        Topic of the controller's speed limits.
    locate : callable
        Returns the robot's pose (x, y, yaw) in the global frame, None while it is not known.
    """

    def __init__(self, node: Node, topic: str, locate: Callable[[], Any]) -> None:
        from nav2_msgs.msg import SpeedLimit

        self._node, self._locate = node, locate
        self._publisher = node.create_publisher(SpeedLimit, topic, 10)
        self._timer: Any = None
        self._begin: Any = None
        self._distance = 0.0

    def begin(self, speed: float, distance: float) -> None:
        """Limit the speed [m/s] until the robot is a distance [m] from here."""
        self._begin, self._distance = self._locate(), distance
        self._limit(speed)
        if self._timer is None:
            self._timer = self._node.create_timer(_PERIOD_S, self._look)

    def _look(self) -> None:
        here = self._locate()
        if here is None:
            return
        if self._begin is None:
            self._begin = here
        if math.hypot(*(here - self._begin)[:2]) >= self._distance:
            self._node.destroy_timer(self._timer)
            self._timer = None
            self._limit(0.0)

    def _limit(self, speed: float) -> None:
        """Publish a limit [m/s]; 0 for none."""
        from nav2_msgs.msg import SpeedLimit

        message = SpeedLimit(percentage=False, speed_limit=speed)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)
