"""`tour`: points at the parts of the demonstration's table in turn, until somebody else publishes a point."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import cycle
from typing import Any

from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from std_msgs.msg import ColorRGBA

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_PLACES = (
    ((0.6, 0.35, 0.9), (1.0, 1.0, 1.0)),
    ((-0.5, 0.4, 0.83), (1.0, 0.0, 0.0)),
    ((-0.4, -0.4, 1.05), (0.0, 1.0, 1.0)),
    ((0.6, -0.4, 0.75), (1.0, 1.0, 0.0)),
)
"""Tops of the parts and a free place on the table [m], each with its colour."""


@dataclass(frozen=True)
class TourParameters(Parameters):
    """Parameters of ``tour``."""

    period: float = parameter(3.0, "Time at each place.", unit="s", above=0.0)


class Tour(Node):
    """Node that publishes ``clicked_point`` and ``color``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("tour", **kwargs)
        settings = declare(self, TourParameters)
        self._places = cycle(_PLACES)
        self._points = self.create_publisher(PointStamped, "clicked_point", 1)
        self._colors = self.create_publisher(ColorRGBA, "color", 1)
        self.create_subscription(PointStamped, "clicked_point", self._watch, 10)
        self._timer = self.create_timer(settings.period, self._go_on)

    def _go_on(self) -> None:
        place, (red, green, blue) = next(self._places)
        message = PointStamped()
        message.header.frame_id = "world"
        message.point.x, message.point.y, message.point.z = place
        self._colors.publish(ColorRGBA(r=red, g=green, b=blue, a=1.0))
        self._points.publish(message)

    def _watch(self, message: PointStamped) -> None:
        """End the tour when a point is somebody else's."""
        place = (message.point.x, message.point.y, message.point.z)
        if place not in [own for own, _ in _PLACES]:
            self._timer.cancel()


def main() -> int:
    """Run the node."""
    return run(Tour)
