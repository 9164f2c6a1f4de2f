"""`cell_view`: the boxes, cylinders and spheres of a simulated world as markers, beside the robot in the 3-D view."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.parameters import parameter
from daidalos.description.geometry import Box, Cylinder, Geometry, Sphere
from daidalos.nodes.daidalos_lighting._cell import Cell, CellParameters
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_GREY = (0.6, 0.6, 0.6, 1.0)


@dataclass(frozen=True)
class CellViewParameters(CellParameters):
    """Parameters of ``cell_view``."""

    rate: float = parameter(5.0, "How often the markers are published.", unit="Hz", above=0.0)


class CellView(Node):
    """Node that publishes ``cell/markers`` of the world's models where ``gazebo/model_states`` says they are."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("cell_view", **kwargs)
        settings = declare(self, CellViewParameters)
        self._cell = Cell(self, settings.world)
        self._markers = self.create_publisher(MarkerArray, "cell/markers", 1)
        self.create_timer(1.0 / settings.rate, self._publish)

    def _publish(self) -> None:
        if self._markers.get_subscription_count():
            self._markers.publish(MarkerArray(markers=list(self._draw())))

    def _draw(self) -> Iterator[Marker]:
        """Yield the markers of all shapes."""
        for name, number, at, visual in self._cell.visuals():
            marker = _shape(visual.geometry)
            if marker is None:
                continue
            color = visual.material.color if visual.material is not None and visual.material.color else _GREY
            marker.header.frame_id = "world"
            marker.ns, marker.id = name, number
            marker.color = ColorRGBA(r=color[0], g=color[1], b=color[2], a=color[3])
            position, orientation = marker.pose.position, marker.pose.orientation
            position.x, position.y, position.z = at.position
            orientation.x, orientation.y, orientation.z, orientation.w = at.orientation
            yield marker


def _shape(geometry: Geometry) -> Marker | None:
    """Return a marker of a shape; None for those that need a mesh, and for planes."""
    marker = Marker(action=Marker.ADD)
    if isinstance(geometry, Box):
        marker.type, size = Marker.CUBE, geometry.size
    elif isinstance(geometry, Cylinder):
        marker.type, size = Marker.CYLINDER, (2.0 * geometry.radius, 2.0 * geometry.radius, geometry.length)
    elif isinstance(geometry, Sphere):
        marker.type, size = Marker.SPHERE, (2.0 * geometry.radius,) * 3
    else:
        return None
    marker.scale.x, marker.scale.y, marker.scale.z = size
    return marker


def main() -> int:
    """Run the node."""
    return run(CellView)
