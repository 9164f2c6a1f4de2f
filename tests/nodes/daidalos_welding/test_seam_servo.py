"""The node `seam_servo`: what it publishes of a run, profiles from a topic, and its end while a robot moves."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import Vector3Stamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32, read_points_numpy
from std_msgs.msg import Float64, Header, String
from visualization_msgs.msg import MarkerArray

from daidalos.common.errors import UserError
from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.rsi.controller import SimulatedController
from daidalos.industry.rsi.controller_server import ControllerServer
from daidalos.industry.servoing.butt_joint import SEAMS, ButtJoint
from daidalos.industry.servoing.profile_sensor import COLUMNS, ProfileSensor
from daidalos.industry.servoing.servo_cell import straight_program
from daidalos.nodes.daidalos_welding.seam_servo import CONFIGURATION, SeamServo

PATIENCE_S = 90.0
SPEED = 0.05
TOPICS: tuple[tuple[str, Any], ...] = (
    ("profile", PointCloud2), ("correction", Vector3Stamped), ("deviation", Float64), ("gap", Float64),
    ("state", String), ("path", MarkerArray),
)  # fmt: skip


class Listener:
    """The node, and someone who hears all that it publishes."""

    def __init__(self, node: Node, **parameters: Any) -> None:
        given = [Parameter(name, value=value) for name, value in parameters.items()]
        self.heard: dict[str, list[Any]] = {topic: [] for topic, _ in TOPICS}
        for topic, kind in TOPICS:
            node.create_subscription(kind, topic, self.heard[topic].append, 1000)
        self.servo = SeamServo(parameter_overrides=given)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.servo)
        self._executor.add_node(node)

    def until(self, holds: Callable[[], bool]) -> None:
        """Spin until a condition holds."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if holds():
                return
            self._executor.spin_once(timeout_sec=0.01)
        raise AssertionError(f"it did not become true: {self.heard['state'][-1:]}")

    def has_ended(self) -> bool:
        """Return whether the run is over."""
        return any("end was reached" in one.data for one in self.heard["state"])


@pytest.mark.slow
def test_a_run_in_the_cell_is_published(node: Node) -> None:
    listener = Listener(node, seam="line", speed=SPEED)
    try:
        listener.until(listener.has_ended)
    finally:
        listener.servo.destroy_node()
    heard = listener.heard
    assert "tracking" in {one.data for one in heard["state"]}  # "searching" may be over before the first message
    assert len(heard["correction"]) > 100
    assert heard["correction"][-1].vector.x == pytest.approx(1.5e-3, abs=0.1e-3)
    assert abs(heard["deviation"][-1].data) < 0.1e-3
    assert np.median([one.data for one in heard["gap"]]) == pytest.approx(0.2e-3, abs=0.06e-3)
    points = read_points_numpy(heard["profile"][-1])
    assert points.shape[1] == 3
    assert 600 < len(points) <= 800
    line = heard["path"][-1].markers[0]
    assert len(line.points) == len(line.colors) > 50
    assert line.colors[-1].g > line.colors[0].g
    assert line.color.a == 1.0


@pytest.mark.slow
def test_profiles_from_a_topic_correct_a_robot(node: Node) -> None:
    import socket
    import threading

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    sensor = ProfileSensor(ButtJoint(SEAMS["line"], irregularity=0.0))
    controller = SimulatedController(read_configuration(CONFIGURATION), straight_program(0.005))
    listener = Listener(node, robot="127.0.0.1", port=port, profiles="topic", seam="line")
    publisher = node.create_publisher(PointCloud2, "measured_profile", 1)

    def measure() -> None:
        lateral = 1e-3 * float(controller.pose[1])
        points = np.stack([np.zeros(800), COLUMNS, sensor.measure(0.02, lateral)], axis=1)
        publisher.publish(create_cloud_xyz32(Header(frame_id="sensor"), points[np.isfinite(points).all(axis=1)]))

    node.create_timer(0.01, measure)
    with ControllerServer(controller, "127.0.0.1", port) as server:
        moving = threading.Thread(target=lambda: (server.wait_for_partner(30.0), server.run(60.0)))
        moving.start()
        try:
            listener.until(lambda: controller.correction[1] > 0.5)
        finally:
            listener.servo.destroy_node()
            moving.join()
    assert "answers in a row were lost" in controller.stopped


def test_wrong_parameters_are_named(node: Node) -> None:
    for parameters, message in (
        ({"seam": "curv"}, "did you mean 'curve'"),
        ({"controller": "lqr"}, "there is no seam controller 'lqr'"),
        ({"configuration": "none.xml"}, "none.xml"),
        ({"profiles": "camera"}, "one of simulated, topic"),
    ):
        with pytest.raises(UserError, match=message):
            SeamServo(parameter_overrides=[Parameter(name, value=value) for name, value in parameters.items()])
