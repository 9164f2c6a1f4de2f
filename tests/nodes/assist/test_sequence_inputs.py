"""What a work sequence hears from ROS topics: hands in depth images, points in other frames, and faults in them."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped, TransformStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Empty
from tf2_ros import StaticTransformBroadcaster

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Vector, quaternion_from_rpy
from daidalos.industry.assistance.sequence import HAND, TOPIC, Confirmation, read_sequence
from daidalos.nodes.sequence_inputs import SequenceInputs, is_needed

SEQUENCE = """
devices: {lamp: {kind: moving_head}}
camera: {depth: /depth, info: /info, frames: 3, hold: 0.2}
steps:
  - {name: Watch, show: {lamp: {follow: /target}}, confirm: {topic: /done}}
  - {name: Take, confirm: {hand: [0.2, 0.1, 0.75]}}
"""


class Run:
    """What a run is told."""

    def __init__(self) -> None:
        self.confirmed = list[Confirmation]()
        self.targets = list[tuple[str, Vector]]()
        self.confirm = self.confirmed.append

    def follow(self, topic: str, place: Vector) -> None:
        """Note a point."""
        self.targets.append((topic, place))


class Cell:
    """The node, and cameras and programs around it."""

    def __init__(self, node: Node, tmp_path: Path, text: str = SEQUENCE) -> None:
        file = tmp_path / "work.yaml"
        file.write_text(text)
        sequence = read_sequence(file)
        assert is_needed(sequence)
        self.run, self.lines = Run(), list[str]()
        self.inputs = SequenceInputs(sequence, self.run, self.lines.append)  # type: ignore[arg-type]
        self._node = node
        self.targets = node.create_publisher(PointStamped, "/target", 10)
        self.done = node.create_publisher(Empty, "/done", 10)
        self._depth = node.create_publisher(Image, "/depth", 10)
        self._info = node.create_publisher(CameraInfo, "/info", 10)
        self._frames = StaticTransformBroadcaster(node)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._executor.add_node(self.inputs)
        self._stamp = 100.0

    def place(self, frame: str, xyz: Vector, roll: float) -> None:
        """Publish where a frame is in the world."""
        found = TransformStamped(child_frame_id=frame)
        found.header.frame_id = "world"
        found.transform.translation.x, found.transform.translation.y, found.transform.translation.z = xyz
        turn = found.transform.rotation
        turn.x, turn.y, turn.z, turn.w = quaternion_from_rpy(roll, 0.0, 0.0)
        self._frames.sendTransform(found)

    def film(self, image: np.ndarray[Any, Any], encoding: str, holds: Callable[[], bool], focal: float = 200.0) -> None:
        """Publish an image again and again until a condition holds."""
        message = CvBridge().cv2_to_imgmsg(image, encoding)
        message.header.frame_id = "eye"
        info = CameraInfo(k=[focal, 0.0, 79.5, 0.0, focal, 59.5, 0.0, 0.0, 1.0])

        def step() -> bool:
            self._stamp += 0.1
            message.header.stamp = Time(nanoseconds=int(self._stamp * 1e9)).to_msg()
            self._info.publish(info)
            self._depth.publish(message)
            return holds()

        self.until(step)

    def until(self, holds: Callable[[], bool]) -> None:
        """Spin until a condition holds."""
        end = time.monotonic() + 20.0
        while not holds():
            assert time.monotonic() < end, self.lines
            for _ in range(5):
                self._executor.spin_once(timeout_sec=0.005)


@pytest.fixture
def cell(node: Node, tmp_path: Path) -> Iterator[Cell]:
    one = Cell(node, tmp_path)
    yield one
    one.inputs.destroy_node()


@pytest.mark.slow
def test_a_hand_in_depth_images_confirms(cell: Cell) -> None:
    table = np.full((120, 160), 1250, np.uint16)  # mm, as cameras of USB send them
    arm = table.copy()
    arm[38:54, 90:] = 1180
    cell.film(table, "16UC1", lambda: any("world" in line for line in cell.lines))  # the frame is not known yet
    cell.place("eye", (0.0, 0.0, 2.0), math.pi)
    cell.film(table, "16UC1", lambda: "the camera sees hands" in cell.lines)
    for _ in range(5):
        cell.film(table, "16UC1", lambda: True)
    cell.film(arm, "16UC1", lambda: bool(cell.run.confirmed))
    assert cell.run.confirmed == [Confirmation(HAND, "[0.2, 0.1, 0.75]")]
    cell.film(table.astype(np.float32) * 1e-3 - 0.3, "32FC1", lambda: "most of the depth image" in cell.lines[-1])
    cell.film(np.zeros((120, 160, 3), np.uint8), "bgr8", lambda: "encoding 'bgr8'" in cell.lines[-1])
    cell.film(table, "16UC1", lambda: "without focal lengths" in cell.lines[-1], focal=0.0)
    assert len(cell.run.confirmed) == 1
    cell.until(lambda: cell.lines[-1] == "/depth: no depth images come")


def test_points_of_other_frames_and_messages_that_confirm(cell: Cell) -> None:
    cell.place("arm_base", (1.0, 0.0, 0.5), 0.0)
    message = PointStamped()
    message.header.frame_id = "arm_base"
    message.point.x = 0.25

    def publish() -> bool:
        cell.targets.publish(message)
        return bool(cell.run.targets)

    cell.until(publish)
    assert cell.run.targets[-1] == ("/target", (1.25, 0.0, 0.5))
    message.header.frame_id = "world"
    count = len(cell.run.targets)
    cell.until(lambda: publish() and len(cell.run.targets) > count and cell.run.targets[-1][1] == (0.25, 0.0, 0.0))
    message.point.x = math.nan
    cell.until(lambda: publish() and "/target: the point is no finite number" in cell.lines)
    message.point.x, message.header.frame_id = 0.25, "nowhere"
    cell.until(lambda: publish() and "nowhere" in cell.lines[-1])
    cell.done.publish(Empty())
    cell.until(lambda: Confirmation(TOPIC, "/done") in cell.run.confirmed)


def test_an_unknown_type_is_named(node: Node, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="type of '/done' is not known"):
        Cell(node, tmp_path, SEQUENCE.replace("topic: /done", "topic: /done, type: std_msgs/msg/Emty"))
