"""The node `moving_head`: points of frames, frames that are followed, colours, and what leaves by Art-Net."""

from __future__ import annotations

import math
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import PointStamped, TransformStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA, String
from tf2_ros import StaticTransformBroadcaster
from trajectory_msgs.msg import JointTrajectory

from daidalos.common.errors import UserError
from daidalos.industry.lighting import artnet
from daidalos.nodes.daidalos_lighting.moving_head import MovingHead


class Cell:
    """The node, its receiver, and someone who commands it."""

    def __init__(self, node: Node, folder: Path) -> None:
        self.receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.receiver.bind(("127.0.0.1", 0))
        self.receiver.setblocking(False)
        config = folder / "lights.yaml"
        port = self.receiver.getsockname()[1]
        config.write_text(f"heads: [{{movement: direct}}]\noutputs: [{{protocol: artnet, port: {port}}}]\n")
        self.head = MovingHead(parameter_overrides=[Parameter("config", value=str(config))])
        self.node, self.joints = node, list[Any]()
        node.create_subscription(JointState, "joint_states", self.joints.append, 10)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.head)
        self._executor.add_node(node)

    def publish(self, kind: type[Any], topic: str, message: Any) -> None:
        """Publish a message."""
        self.node.create_publisher(kind, topic, 1).publish(message)

    def until(self, holds: Callable[[], bool]) -> None:
        """Spin until a condition holds."""
        for _ in range(3000):
            if holds():
                return
            self._executor.spin_once(timeout_sec=0.01)
        raise AssertionError("it did not become true")

    def newest(self) -> bytes:
        """Return the newest levels, or none."""
        data = b""
        while True:
            try:
                data = artnet.parse_dmx(self.receiver.recv(2048)).data
            except BlockingIOError:
                return data

    def points_at(self, x: float, y: float, z: float) -> Callable[[], bool]:
        """Return a condition: the head aims at a point of the world."""

        def holds() -> bool:
            if not self.joints or self.joints[-1].name != ["pan_joint", "tilt_joint"]:
                return False
            pan, tilt = self.joints[-1].position
            way = math.dist((0.0, 0.0, 2.8), (x, y, z))
            # The workshop's formula, with the head upside down: y and z change their signs.
            reached = (
                -way * math.cos(pan) * math.sin(tilt), way * math.sin(pan) * math.sin(tilt), 2.8 - way * math.cos(tilt)
            )  # fmt: skip
            return math.dist(reached, (x, y, z)) < 1e-3

        return holds


@pytest.fixture
def cell(node: Node, tmp_path: Path) -> Iterator[Cell]:
    one = Cell(node, tmp_path)
    yield one
    one.head.destroy_node()
    assert one.newest()[5] == 0  # dark at the end
    one.receiver.close()


def point(frame: str, x: float, y: float, z: float) -> PointStamped:
    message = PointStamped()
    message.header.frame_id = frame
    message.point.x, message.point.y, message.point.z = x, y, z
    return message


def frame(name: str, x: float, y: float, z: float) -> TransformStamped:
    message = TransformStamped(child_frame_id=name)
    message.header.frame_id = "world"
    shift, turn = message.transform.translation, message.transform.rotation
    shift.x, shift.y, shift.z = x, y, z
    turn.z = turn.w = math.sqrt(0.5)  # a quarter turn
    return message


def test_points_frames_and_colors(cell: Cell) -> None:
    cell.publish(PointStamped, "point", point("world", 0.5, -0.3, 0.8))
    cell.until(cell.points_at(0.5, -0.3, 0.8))
    cell.until(lambda: (cell.newest() or bytes(6))[5] == 255)

    broadcaster = StaticTransformBroadcaster(cell.node)
    broadcaster.sendTransform(frame("part_7", 1.0, 0.2, 0.1))
    cell.publish(String, "aim_frame", String(data="part_7"))
    cell.until(cell.points_at(1.0, 0.2, 0.1))
    broadcaster.sendTransform(frame("part_7", -0.5, 0.4, 0.1))  # the part moves, the light follows
    cell.until(cell.points_at(-0.5, 0.4, 0.1))
    cell.publish(PointStamped, "point", point("part_7", 0.1, 0.0, 0.0))
    cell.until(cell.points_at(-0.5, 0.5, 0.1))

    cell.publish(ColorRGBA, "color", ColorRGBA(r=1.0, g=0.0, b=0.0, a=0.5))
    cell.until(lambda: 10 <= (cell.newest() or bytes(8))[7] <= 14)


def test_what_cannot_be_reached_changes_nothing(cell: Cell) -> None:
    cell.publish(PointStamped, "point", point("", 0.5, -0.3, 0.8))
    cell.until(cell.points_at(0.5, -0.3, 0.8))
    for message in (point("world", 0.0, 0.0, 9.0), point("nowhere", 0.0, 0.0, 0.0)):
        cell.publish(PointStamped, "point", message)
    count = len(cell.joints)
    cell.until(lambda: len(cell.joints) > count + 20)
    assert cell.points_at(0.5, -0.3, 0.8)()


def test_texts_of_mqtt(cell: Cell) -> None:
    errors = list[Any]()
    cell.node.create_subscription(String, "error", errors.append, 10)
    cell.publish(String, "point_text", String(data="[0.5, -0.3, 0.8]"))
    cell.until(cell.points_at(0.5, -0.3, 0.8))
    for text, problem in (("[1, 2]", "is no point"), ("[NaN, 0, 0]", "is no point"), ("[0, 0, 9]", "out of range")):
        del errors[:]
        cell.publish(String, "point_text", String(data=text))
        cell.until(lambda: bool(errors))
        assert problem in errors[0].data
    assert cell.points_at(0.5, -0.3, 0.8)()


@pytest.mark.usefixtures("graph")
def test_a_controller_turns_the_head_at_its_speed(node: Node) -> None:
    found = list[Any]()
    node.create_subscription(JointTrajectory, "head_controller/joint_trajectory", found.append, 10)
    head = MovingHead(parameter_overrides=[Parameter("controller", value="head_controller")])
    executor = SingleThreadedExecutor()
    executor.add_node(head)
    executor.add_node(node)
    node.create_publisher(PointStamped, "point", 1).publish(point("world", 0.5, -0.3, 0.8))
    end = time.monotonic() + 20.0
    while not found:
        assert time.monotonic() < end
        executor.spin_once(timeout_sec=0.01)
    way = found[0].points[0]
    assert [math.degrees(one) for one in way.positions] == pytest.approx([30.964, -16.254], abs=1e-3)
    seconds = way.time_from_start.sec + 1e-9 * way.time_from_start.nanosec
    assert seconds == pytest.approx(math.radians(30.964) / head._head.limits.pan_speed, rel=1e-3)
    head.destroy_node()


@pytest.mark.usefixtures("graph")
def test_faults_of_parameters_are_named() -> None:
    with pytest.raises(UserError, match="there is no head 'sopt'"):
        MovingHead(parameter_overrides=[Parameter("head", value="sopt")])
    rclpy.try_shutdown()
