"""`seam_servo`: a robot that follows a seam through KUKA RSI, with what it sees and does as topics."""

from __future__ import annotations

import math
import threading
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Vector3Stamped
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32, read_points_numpy
from std_msgs.msg import ColorRGBA, Float64, Header, String
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.rsi.client import DEFAULT_PORT, RsiClient, own_address_towards
from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.rsi.controller import ControllerSettings
from daidalos.industry.rsi.telegrams import Telegram
from daidalos.industry.servoing.butt_joint import ButtJoint, seam_named
from daidalos.industry.servoing.contracts import LoopSetup
from daidalos.industry.servoing.experiments import CellOptions, controller_named, run_in_cell, run_with_robot, warm_up
from daidalos.industry.servoing.profile_sensor import COLUMNS, PITCH, POINTS
from daidalos.industry.servoing.seam_servo import Cycle, Profiles, ServoSettings
from daidalos.industry.servoing.servo_cell import RehearsalSensor
from daidalos.industry.servoing.servo_run import ServoRun
from daidalos.interfaces.library import BUILT_IN
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

CONFIGURATION = BUILT_IN / "kr500_2mt_description/config/rsi/seam_servo.xml"
FULL_COLOUR = 0.2e-3
"""Deviation from which the path is red [m]."""
_RATE = 25.0
"""How often what has happened is published [Hz]."""
_PATH_POINTS = 4000
_PATH_STEP = 0.2e-3
"""Distance between points of the drawn path [m]."""


@dataclass(frozen=True)
class SeamServoParameters(Parameters):
    """Parameters of ``seam_servo``."""

    seam: str = parameter("curve", "Seam that is simulated: line, curve or long.", not_empty=True)
    controller: str = parameter("feedforward", "Seam controller.", not_empty=True)
    robot: str = parameter("", "Address of a robot with RSI; the simulated cell where empty.")
    port: int = parameter(DEFAULT_PORT, "UDP port to which the robot sends.", minimum=1, maximum=65535)
    configuration: str = parameter("", "Ethernet configuration of the robot's RSI; the built-in one where empty.")
    profiles: str = parameter("simulated", "Where a robot's profiles come from.", choices=("simulated", "topic"))
    wait: float = parameter(60.0, "How long the robot may take to begin.", unit="s", above=0.0)
    heading: float = parameter(0.0, "Direction of the path in the robot's base.", unit="rad")
    speed: float = parameter(0.005, "Speed along the path.", unit="m/s", above=0.0)
    sensor_lead: float = parameter(0.035, "Distance of the sensor ahead of the tool.", unit="m", above=0.0)
    max_correction: float = parameter(0.005, "Greatest sum of the corrections.", unit="m", above=0.0)
    hold_after: float = parameter(0.1, "Time without a seam after which the correction is held.", unit="s", above=0.0)
    stop_after: float = parameter(1.0, "Time without a seam after which the robot is stopped.", unit="s", above=0.0)
    frame_id: str = parameter("seam", "Frame of the programmed path.", not_empty=True)


class _Ended(Exception):
    """End of the node while its robot moves."""


class SeamServo(Node):
    """Node that follows one seam.

    It publishes ``profile``, ``correction`` (y: of the cycle, x: sum of all), ``deviation`` of the tool from the seam
    as far as that is known, ``gap``, ``state`` and ``path``, a marker with the deviation as colour; with `profiles` at
    ``topic`` it takes ``measured_profile``, points whose y and z count.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("seam_servo", **kwargs)
        self._given = declare(self, SeamServoParameters)
        given = self._given
        self._configuration = read_configuration(Path(given.configuration) if given.configuration else CONFIGURATION)
        self._seam = seam_named(given.seam)
        setup = LoopSetup(speed=given.speed, max_correction=given.max_correction)
        self._settings = ServoSettings(
            setup, given.heading, given.sensor_lead, hold_after=given.hold_after, stop_after=given.stop_after
        )
        controller_named(given.controller, self._settings)
        self._header = Header(frame_id=given.frame_id)
        self._profile = self.create_publisher(PointCloud2, "profile", 10)
        self._correction = self.create_publisher(Vector3Stamped, "correction", 100)
        self._deviation = self.create_publisher(Float64, "deviation", 100)
        self._gap = self.create_publisher(Float64, "gap", 100)
        self._state = self.create_publisher(String, "state", 10)
        self._path = self.create_publisher(MarkerArray, "path", 1)
        self._measured: deque[NDArray[np.float64]] = deque(maxlen=1)
        if given.robot and given.profiles == "topic":
            self.create_subscription(PointCloud2, "measured_profile", self._take_profile, 1)
        self._cycles: deque[tuple[Cycle, NDArray[np.float64] | None, Time]] = deque(maxlen=1000)
        self._points: deque[tuple[Point, ColorRGBA]] = deque(maxlen=_PATH_POINTS)
        self._last_point = -math.inf
        self._said = ""
        self._ending = threading.Event()
        self.result: ServoRun | None = None
        self._report = ""
        self.create_timer(1.0 / _RATE, self._publish)
        self._client: RsiClient | None = None
        if given.robot:
            own = own_address_towards(given.robot)
            self._client = RsiClient(own, given.port, self._configuration.sensor, given.robot)
        self._loop = threading.Thread(target=self._follow, name="seam_servo", daemon=True)
        self._loop.start()

    def destroy_node(self) -> None:
        """Stop the loop, and answer the robot without correction."""
        self._ending.set()
        self._loop.join()
        if self._client is not None:
            self._client.close()
        super().destroy_node()

    def _follow(self) -> None:
        """Follow the seam, in the thread of the loop."""
        given = self._given
        try:
            if self._client is None:
                options = CellOptions(
                    realtime=True, controller=ControllerSettings(position_limit=1e3 * given.max_correction)
                )
                self.result = run_in_cell(
                    self._seam, given.controller, self._configuration, self._settings, options, self._watch
                )
            else:
                warm_up(given.controller, self._settings)
                self.result = run_with_robot(
                    self._client, self._seam, given.controller, self._settings, self._profiles(), given.wait,
                    self._watch, self._ending.is_set,
                )  # fmt: skip
            self._report = self.result.ended
        except _Ended:
            pass
        except UserError as error:
            self._report = str(error)

    def _profiles(self) -> Profiles:
        if self._given.profiles == "topic":
            return self._newest_profile
        return RehearsalSensor(ButtJoint(self._seam), self._settings.heading, self._settings.sensor_lead)

    def _newest_profile(self, _: Telegram) -> NDArray[np.float64] | None:
        """Return the profile that came since the last telegram; None where there is none."""
        try:
            return self._measured.pop()
        except IndexError:
            return None

    def _take_profile(self, message: PointCloud2) -> None:
        points = read_points_numpy(message, ("y", "z")).astype(np.float64)
        heights = np.full(POINTS, np.nan)
        known = np.isfinite(points).all(axis=1)
        columns = np.rint((points[known, 0] - COLUMNS[0]) / PITCH)
        within = (columns >= 0) & (columns < POINTS)
        heights[columns[within].astype(np.int64)] = points[known, 1][within]
        self._measured.append(heights)

    def _watch(self, cycle: Cycle, heights: NDArray[np.float64] | None) -> None:
        """Remember a cycle, in the thread of the loop."""
        if self._ending.is_set():
            raise _Ended
        self._cycles.append((cycle, heights, self.get_clock().now()))

    def _publish(self) -> None:
        """Publish the cycles since the last time."""
        cycles = [self._cycles.popleft() for _ in range(len(self._cycles))]
        for cycle, heights, now in cycles:
            self._header.stamp = now.to_msg()
            if heights is not None and self._profile.get_subscription_count():
                self._profile.publish(create_cloud_xyz32(self._header, self._cloud(cycle, heights)))
            correction = Vector3Stamped(header=self._header)
            correction.vector.x, correction.vector.y = cycle.commanded, cycle.correction
            self._correction.publish(correction)
            if math.isfinite(cycle.deviation):
                self._deviation.publish(Float64(data=cycle.deviation))
                self._draw(cycle)
            if cycle.evaluation is not None:
                self._gap.publish(Float64(data=cycle.evaluation.gap))
        state = self._report or (cycles[-1][0].state.value if cycles else self._said)
        if state != self._said:
            self.get_logger().info(state)
        self._said = state
        self._state.publish(String(data=state))
        if cycles and self._path.get_subscription_count():
            self._path.publish(MarkerArray(markers=[self._line()]))

    def _cloud(self, cycle: Cycle, heights: NDArray[np.float64]) -> NDArray[np.float32]:
        """Return the points of a profile in the frame of the path (n, 3)."""
        known = np.isfinite(heights)
        along = np.full(int(known.sum()), cycle.s + self._settings.sensor_lead)
        points: NDArray[np.float32] = np.stack([along, COLUMNS[known] + cycle.lateral, heights[known]], axis=1).astype(
            np.float32
        )
        return points

    def _draw(self, cycle: Cycle) -> None:
        """Add a point to the path, green on the seam and red from `FULL_COLOUR` beside it."""
        if cycle.s - self._last_point < _PATH_STEP:
            return
        self._last_point = cycle.s
        share = min(abs(cycle.deviation) / FULL_COLOUR, 1.0)
        self._points.append((Point(x=cycle.s, y=cycle.lateral, z=0.0), ColorRGBA(r=share, g=1.0 - share, b=0.1, a=1.0)))

    def _line(self) -> Marker:
        marker = Marker(header=self._header, ns="path", type=Marker.LINE_STRIP, action=Marker.ADD)
        marker.scale.x = 1e-3
        marker.color.a = 1.0
        marker.pose.orientation.w = 1.0
        marker.points = [point for point, _ in self._points]
        marker.colors = [colour for _, colour in self._points]
        return marker


def main() -> int:
    """Run the node."""
    return run(SeamServo)
