"""`simulated_laser`: a laser projector that receives IDN frames, and shows its picture on whatever the beam meets."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.parameters import parameter
from daidalos.industry.assistance.laser_projector import LaserPose
from daidalos.industry.assistance.surfaces import hits
from daidalos.industry.lighting import idn
from daidalos.industry.lighting.artnet import PacketError
from daidalos.nodes.daidalos_lighting._cell import Cell, CellParameters
from daidalos.nodes.daidalos_lighting._receiver import listen
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_PERIOD_S = 0.05
_LIFT = 0.003
"""Distance of the drawn lines before the surface [m]."""

_GAP = 6.0
"""A line between two samples that is so many times longer than their distance at the surface is one across an edge."""


@dataclass(frozen=True)
class SimulatedLaserParameters(CellParameters, LaserPose):
    """Parameters of ``simulated_laser``."""

    host: str = parameter("127.0.0.1", "Address at which IDN is received.", not_empty=True)
    port: int = parameter(idn.PORT, "UDP port at which IDN is received.", minimum=1, maximum=65535)
    line_width: float = parameter(0.006, "Width of the lines in the picture.", unit="m", above=0.0)


class SimulatedLaser(Node):
    """Node that publishes ``laser/markers``: the lines that the beam draws on the shapes of the world.

    It goes dark when nothing was received for as long as a real projector waits.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("simulated_laser", **kwargs)
        self._settings = settings = declare(self, SimulatedLaserParameters)
        self._galvanometer = settings.galvanometer()
        self._cell = Cell(self, settings.world)
        self._socket = listen("IDN", settings.host, settings.port)
        self._frame: idn.Frame | None = None
        self._silence = 0.0
        self._problem = ""
        self._markers = self.create_publisher(MarkerArray, "laser/markers", 1)
        self.create_timer(_PERIOD_S, self._step)

    def destroy_node(self) -> None:
        """Close the port and destroy the node."""
        self._socket.close()
        super().destroy_node()

    def _step(self) -> None:
        self._silence += _PERIOD_S
        self._receive()
        if self._silence > idn.TIMEOUT_S:
            self._frame = None
        if self._markers.get_subscription_count():
            self._markers.publish(MarkerArray(markers=[self._draw()]))

    def _receive(self) -> None:
        """Take the newest frame; what is no frame is named once and changes nothing."""
        with contextlib.suppress(BlockingIOError):
            while True:
                packet = self._socket.recv(0x10000)
                try:
                    self._frame = idn.parse_packet(packet)
                    self._silence, self._problem = 0.0, ""
                except PacketError as error:
                    if str(error) != self._problem:
                        self._problem = str(error)
                        self.get_logger().warning(f"a packet of {len(packet)} bytes {error}")

    def _draw(self) -> Marker:
        marker = Marker(ns="laser", type=Marker.LINE_LIST, action=Marker.DELETE)
        marker.header.frame_id = "world"
        marker.pose.orientation.w = 1.0
        marker.scale.x = self._settings.line_width
        marker.color = ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0)  # its alpha is that of all lines
        frame = self._frame
        if frame is not None and len(frame.places) > 1:
            starts, ends, colors = self._lines(frame)
            for start, end, color in zip(starts, ends, colors, strict=True):
                red, green, blue = (color / 255.0).tolist()
                marker.points += [Point(x=x, y=y, z=z) for x, y, z in (start.tolist(), end.tolist())]
                marker.colors += [ColorRGBA(r=red, g=green, b=blue, a=1.0)] * 2
            if len(starts):
                marker.action = Marker.ADD
        return marker

    def _lines(self, frame: idn.Frame) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.uint8]]:
        """Return starts and ends ``(n, 3)`` of the lit lines on surfaces, and their colours."""
        origins, directions = self._galvanometer.rays(frame.places)
        shapes = [(pose, visual.geometry) for _, _, pose, visual in self._cell.visuals()]
        places = hits(origins, directions, shapes, 0.0)
        far = np.linalg.norm(places - origins, axis=1)[1:]
        turned = np.linalg.norm(np.diff(directions, axis=0), axis=1)
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        is_line = (lengths > 0.0) & (lengths <= _GAP * far * turned)  # False where it is no number
        is_drawn = frame.colors[1:].any(axis=1) & is_line
        lifted = places - _LIFT * directions
        return lifted[:-1][is_drawn], lifted[1:][is_drawn], frame.colors[1:][is_drawn]


def main() -> int:
    """Run the node."""
    return run(SimulatedLaser)
