"""`simulated_head`: a head that receives Art-Net, turns its axes at their real speed, and shows beam and spot."""

from __future__ import annotations

import contextlib
import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geometry_msgs.msg import Point
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import ColorRGBA
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.look import Appearance, appearance
from daidalos.industry.lighting.motion import Motion
from daidalos.industry.lighting.show import FRAME_S, Show
from daidalos.nodes.daidalos_lighting._receiver import listen
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_SIDES = 24
_LENS = 0.16
"""Where the beam leaves the head [m]."""


@dataclass(frozen=True)
class SimulatedHeadParameters(Parameters):
    """Parameters of ``simulated_head``."""

    config: str = parameter(
        "", "File of heads and outputs, as `daidalos light` reads it; the built-in one where empty."
    )
    head: str = parameter("", "Name of the head; the first of the file where empty.")
    host: str = parameter("127.0.0.1", "Address at which Art-Net is received.", not_empty=True)
    port: int = parameter(artnet.PORT, "UDP port at which Art-Net is received.", minimum=1, maximum=65535)
    beam_frame: str = parameter("head_link", "Frame whose z axis is the beam.", not_empty=True)
    pan_joint: str = parameter("pan_joint", "Name of the pan axis.", not_empty=True)
    tilt_joint: str = parameter("tilt_joint", "Name of the tilt axis.", not_empty=True)


class SimulatedHead(Node):
    """Node that moves the joints of a simulated head by ``head/joint_trajectory`` and draws ``beam/markers``.

    How far the beam reaches is measured by a range sensor along it, ``beam/range``.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("simulated_head", **kwargs)
        self._settings = settings = declare(self, SimulatedHeadParameters)
        configuration = read_configuration(Path(settings.config) if settings.config else DEFAULT)
        show = Show(configuration.make_heads())
        self._head = show.head(settings.head or configuration.heads[0].name)
        self._motion = Motion(self._head.angles, self._head.limits)
        self._levels = self._head.levels
        self._reach = 0.0
        self._socket = listen("Art-Net", settings.host, settings.port)
        self._axes = self.create_publisher(JointTrajectory, "head/joint_trajectory", 1)
        self._markers = self.create_publisher(MarkerArray, "beam/markers", 1)
        self.create_subscription(LaserScan, "beam/range", self._take_range, 1)
        self.create_timer(FRAME_S, self._step)

    def destroy_node(self) -> None:
        """Close the port and destroy the node."""
        self._socket.close()
        super().destroy_node()

    def _take_range(self, scan: LaserScan) -> None:
        self._reach = scan.ranges[0] if len(scan.ranges) and math.isfinite(scan.ranges[0]) else scan.range_max

    def _step(self) -> None:
        self._receive()
        self._motion.target = self._head.angles_of(self._levels)
        angles = self._motion.step(FRAME_S)
        message = JointTrajectory(joint_names=[self._settings.pan_joint, self._settings.tilt_joint])
        message.points = [JointTrajectoryPoint(positions=[angles.pan, angles.tilt])]
        self._axes.publish(message)
        if self._markers.get_subscription_count():
            self._markers.publish(self._draw(appearance(self._head.fixture, self._levels)))

    def _receive(self) -> None:
        """Take the newest levels; what is no ArtDmx of this universe is left alone."""
        with contextlib.suppress(BlockingIOError):
            while True:
                packet = self._socket.recv(2048)
                with contextlib.suppress(artnet.PacketError):
                    found = artnet.parse_dmx(packet)
                    if found.universe == self._head.universe and len(found.data) >= self._head.last:
                        self._levels = found.data[self._head.first - 1 : self._head.last]

    def _draw(self, seen: Appearance) -> MarkerArray:
        """Return the beam as a cone up to what it meets, and the spot there."""
        now = self.get_clock().now().nanoseconds * 1e-9
        is_lit = seen.strobe == 0.0 or (now * seen.strobe) % 1.0 < 0.5
        light = seen.dimmer if is_lit else 0.0
        red, green, blue = seen.color
        radius = (self._reach + _LENS) * math.tan(0.5 * seen.beam_angle)
        beam = self._marker("beam", Marker.TRIANGLE_LIST, ColorRGBA(r=red, g=green, b=blue, a=0.25 * light))
        beam.scale.x = beam.scale.y = beam.scale.z = 1.0
        beam.points = _cone(0.06, radius, _LENS, _LENS + self._reach)
        spot = self._marker("spot", Marker.CYLINDER, ColorRGBA(r=red, g=green, b=blue, a=0.9 * light))
        spot.pose.position.z = _LENS + self._reach - 0.005
        spot.scale.x = spot.scale.y = 2.0 * radius
        spot.scale.z = 0.01
        return MarkerArray(markers=[beam, spot])

    def _marker(self, name: str, kind: int, color: ColorRGBA) -> Marker:
        is_dark = color.a <= 0.0
        marker = Marker(ns=name, type=kind, action=Marker.DELETE if is_dark else Marker.ADD, color=color)
        marker.header.frame_id = self._settings.beam_frame
        marker.frame_locked = True
        marker.pose.orientation.w = 1.0
        return marker


def _cone(start: float, end: float, near: float, far: float) -> list[Point]:
    """Return the triangles of a cone along z from one radius and distance to others."""
    turns = [(math.cos(angle), math.sin(angle)) for angle in (2 * math.pi * n / _SIDES for n in range(_SIDES + 1))]
    points = []
    for (x0, y0), (x1, y1) in itertools.pairwise(turns):
        a, b = Point(x=start * x0, y=start * y0, z=near), Point(x=start * x1, y=start * y1, z=near)
        c, d = Point(x=end * x0, y=end * y0, z=far), Point(x=end * x1, y=end * y1, z=far)
        points += [a, c, d, a, d, b]
    return points


def main() -> int:
    """Run the node."""
    return run(SimulatedHead)
