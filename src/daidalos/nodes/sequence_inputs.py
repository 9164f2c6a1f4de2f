"""What a work sequence hears from ROS topics: confirmations, points that devices follow, and hands in depth images."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from rosidl_runtime_py.utilities import get_message
from sensor_msgs.msg import CameraInfo, Image
from tf2_py import TransformException
from tf2_ros import Buffer, TransformListener

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.industry.assistance.hand import Camera, HandDetector, HandError
from daidalos.industry.assistance.sequence import HAND, TOPIC, Confirmation
from daidalos.nodes.depth_images import METRES

if TYPE_CHECKING:
    from daidalos.industry.assistance.runner import Runner
    from daidalos.industry.assistance.sequence import Sequence

SILENCE_S = 2.0
"""Time without a depth image after which the camera is reported."""

_LEAST_PERIOD_S = 0.06
"""Time between two images that are looked at."""


def is_needed(sequence: Sequence) -> bool:
    """Return whether a sequence hears anything from ROS topics."""
    follows = any(one.follow for step in sequence.steps for one in step.showings)
    return follows or bool(sequence.confirmations(TOPIC) or sequence.confirmations(HAND))


class SequenceInputs(Node):
    """Node that passes on to a run what its sequence waits for.

    Parameters
    ----------
    sequence : Sequence
    runner : Runner
    report : callable
        Called with a line when something is wrong, and when it works again.

    Raises
    ------
    UserError
        When the type of a topic is not known.
    """

    def __init__(self, sequence: Sequence, runner: Runner, report: Callable[[str], None]) -> None:
        super().__init__("assist")
        self._runner, self._report, self._frame = runner, report, sequence.world_frame
        self._reported: dict[str, str] = {}
        for one in sequence.confirmations(TOPIC):
            self.create_subscription(_message_class(one), one.name, partial(self._confirm, one), 10)
        self._buffer = Buffer(node=self)
        self._listener = TransformListener(self._buffer, self)
        for topic in sorted({one.follow for step in sequence.steps for one in step.showings if one.follow}):
            self.create_subscription(PointStamped, topic, partial(self._follow, topic), 1)
        self._hands = {one.name: one for one in sequence.confirmations(HAND)}
        if self._hands:
            self._watch_hands(sequence)

    def _watch_hands(self, sequence: Sequence) -> None:
        places = {name: one.place for name, one in self._hands.items() if one.place is not None}
        self._detector = HandDetector(sequence.camera, places)
        self._was_ready = False
        self._info: CameraInfo | None = None
        self._seen, self._looked = self.get_clock().now(), -np.inf
        self._topic = sequence.camera.depth
        self.create_subscription(CameraInfo, sequence.camera.info, self._take_info, qos_profile_sensor_data)
        self.create_subscription(Image, self._topic, self._look, qos_profile_sensor_data)
        self.create_timer(0.5 * SILENCE_S, self._check_silence)

    def _confirm(self, confirmation: Confirmation, message: Any) -> None:
        self._runner.confirm(Confirmation(TOPIC, confirmation.name))

    def _follow(self, topic: str, message: PointStamped) -> None:
        place = (message.point.x, message.point.y, message.point.z)
        if not np.isfinite(place).all():
            self._tell(topic, f"{topic}: the point is no finite number")
            return
        pose = self._pose_of(message.header.frame_id, topic)
        if pose is not None:
            self._tell(topic, "")
            self._runner.follow(topic, pose.transform(place))

    def _take_info(self, message: CameraInfo) -> None:
        self._info = message

    def _look(self, image: Image) -> None:
        self._seen = self.get_clock().now()
        stamp = Time.from_msg(image.header.stamp).nanoseconds * 1e-9
        if self._info is None or abs(stamp - self._looked) < _LEAST_PERIOD_S:
            return
        self._looked = stamp
        scale, info = METRES.get(image.encoding), self._info
        if scale is None or not (info.k[0] > 0.0 and info.k[4] > 0.0):
            problem = f"encoding '{image.encoding}'" if scale is None else "a calibration without focal lengths"
            self._tell(self._topic, f"{self._topic}: {problem}; expected one of {', '.join(METRES)} and a focal length")
            return
        pose = self._pose_of(image.header.frame_id, self._topic)
        if pose is None:
            return
        from cv_bridge import CvBridge

        depth = np.asarray(CvBridge().imgmsg_to_cv2(image), dtype=np.float64) * scale
        try:
            pressed = self._detector.update(depth, Camera(info.k[0], info.k[4], info.k[2], info.k[5], pose), stamp)
        except HandError as error:
            self._tell(self._topic, f"{self._topic}: {error}")
            return
        if self._detector.is_ready:
            self._tell(self._topic, "")
        if self._detector.is_ready != self._was_ready:
            self._was_ready = self._detector.is_ready
            self._report("the camera sees hands" if self._was_ready else "the camera learns the background")
        for name in pressed:
            self._runner.confirm(Confirmation(HAND, name))

    def _check_silence(self) -> None:
        if (self.get_clock().now() - self._seen).nanoseconds * 1e-9 > SILENCE_S:
            self._tell(self._topic, f"{self._topic}: no depth images come")
        elif self._info is None:
            self._tell(self._topic, f"{self._topic}: its camera_info does not come")

    def _pose_of(self, frame: str, topic: str) -> Pose | None:
        """Return the pose of a frame in the world, None where it is not known."""
        if frame in ("", self._frame):
            return Pose()
        try:
            found = self._buffer.lookup_transform(self._frame, frame, Time()).transform
        except TransformException as error:
            self._tell(topic, f"{topic}: {error}")
            return None
        shift, turn = found.translation, found.rotation
        return Pose((shift.x, shift.y, shift.z), (turn.x, turn.y, turn.z, turn.w))

    def _tell(self, topic: str, problem: str) -> None:
        """Report a problem of a topic once, until there is another one or none."""
        if problem and self._reported.get(topic) != problem:
            self._report(problem)
        self._reported[topic] = problem


def _message_class(confirmation: Confirmation) -> Any:
    try:
        return get_message(confirmation.type_name)
    except (AttributeError, ImportError, ValueError) as error:
        raise UserError(f"the type of '{confirmation.name}' is not known: {error}") from None
