"""`moving_head`: a head that points at places and follows frames, with its joints published."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA, String
from tf2_py import TransformException
from tf2_ros import Buffer, TransformListener
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.lighting import messages
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.fixture import FixtureError
from daidalos.industry.lighting.kinematics import Angles, PointingError
from daidalos.industry.lighting.show import FRAME_S, Show
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run


@dataclass(frozen=True)
class MovingHeadParameters(Parameters):
    """Parameters of ``moving_head``."""

    config: str = parameter(
        "", "File of heads and outputs, as `daidalos light` reads it; the built-in one where empty."
    )
    head: str = parameter("", "Name of the head; the first of the file where empty.")
    artnet_port: int = parameter(0, "Port of the Art-Net outputs; that of the file where 0.", minimum=0, maximum=65535)
    controller: str = parameter(
        "", "Joint trajectory controller that turns the head, in place of the outputs; none where empty."
    )
    world_frame: str = parameter("world", "Frame in which the file says where heads are.", not_empty=True)
    pan_joint: str = parameter("pan_joint", "Name of the pan axis in the joint states.", not_empty=True)
    tilt_joint: str = parameter("tilt_joint", "Name of the tilt axis in the joint states.", not_empty=True)


class MovingHead(Node):
    """Node that aims at ``point`` or follows the frame named on ``aim_frame``, in the colour of ``color``.

    DMX frames are sent by a timer of the node's clock. A point that cannot be reached is logged and changes nothing.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("moving_head", **kwargs)
        settings = declare(self, MovingHeadParameters)
        configuration = read_configuration(Path(settings.config) if settings.config else DEFAULT)
        configuration = configuration.with_artnet_port(settings.artnet_port)
        self._settings = settings
        self._show = Show(configuration.make_heads())
        self._head = self._show.head(settings.head or configuration.heads[0].name)
        self._outputs = [] if settings.controller else configuration.make_outputs()
        self._trajectories = (
            self.create_publisher(JointTrajectory, f"{settings.controller}/joint_trajectory", 1)
            if settings.controller
            else None
        )
        self._frame = ""
        self._sent: Angles | None = None
        self._buffer = Buffer(node=self)
        self._listener = TransformListener(self._buffer, self)
        self._joints = self.create_publisher(JointState, "joint_states", 10)
        self._errors = self.create_publisher(String, "error", 1)
        self.create_subscription(PointStamped, "point", self._take_point, 1)
        self.create_subscription(String, "aim_frame", self._take_frame, 1)
        self.create_subscription(String, "point_text", self._take_text, 1)
        self.create_subscription(ColorRGBA, "color", self._take_color, 1)
        self.create_timer(FRAME_S, self._step)

    def destroy_node(self) -> None:
        """Switch all heads dark and destroy the node."""
        self._show.blackout()
        self._send(float("inf"))
        for output in self._outputs:
            output.close()
        super().destroy_node()

    def _take_point(self, message: PointStamped) -> None:
        """Aim at a point of any frame, once."""
        self._frame = ""
        place = (message.point.x, message.point.y, message.point.z)
        frame = message.header.frame_id
        if frame and frame != self._settings.world_frame:
            found = self._look_up(frame, place)
            if found is None:
                return
            place = found
        self._aim(place)
        self._step()

    def _take_text(self, message: String) -> None:
        """Aim at a point ``[x, y, z]`` of the world, as it comes over MQTT."""
        try:
            place = messages.parse(messages.POINT, message.data.encode())
        except messages.MessageError as problem:
            self._refuse(str(problem))
            return
        self._frame = ""
        self._aim(place)

    def _take_frame(self, message: String) -> None:
        """Follow the origin of a frame from now on; an empty name ends that."""
        self._frame = message.data

    def _take_color(self, message: ColorRGBA) -> None:
        """Show a colour, its alpha as the brightness."""
        color = (message.r, message.g, message.b)
        if not all(0.0 <= one <= 1.0 for one in (*color, message.a)):
            self.get_logger().warning("colours and alpha must be from 0 to 1")
            return
        try:
            self._head.show(replace(self._head.look, color=color, dimmer=message.a))
        except FixtureError as problem:
            self.get_logger().warning(str(problem))
        self._show.mark(self._head)

    def _step(self) -> None:
        if self._frame:
            place = self._look_up(self._frame, (0.0, 0.0, 0.0))
            if place is not None:
                self._aim(place)
        self._send(self.get_clock().now().nanoseconds * 1e-9)
        if self._joints.get_subscription_count():
            angles = self._head.angles
            message = JointState(name=[self._settings.pan_joint, self._settings.tilt_joint])
            message.header.stamp = self.get_clock().now().to_msg()
            message.position = [angles.pan, angles.tilt]
            self._joints.publish(message)

    def _aim(self, place: Vector) -> None:
        before = self._head.angles
        try:
            wanted = self._head.point(place)
        except PointingError as problem:
            self._refuse(str(problem))
            return
        self._show.mark(self._head)
        if self._trajectories is not None and wanted != self._sent:
            self._trajectories.publish(self._trajectory(before, wanted))
            self._sent = wanted

    def _trajectory(self, before: Angles, wanted: Angles) -> JointTrajectory:
        """Return the way to some angles, at the speed of the fixture."""
        limits = self._head.limits
        way = max(abs(wanted.pan - before.pan) / limits.pan_speed, abs(wanted.tilt - before.tilt) / limits.tilt_speed)
        point = JointTrajectoryPoint(positions=[wanted.pan, wanted.tilt])
        point.time_from_start = Duration(seconds=max(way, FRAME_S)).to_msg()
        return JointTrajectory(joint_names=[self._settings.pan_joint, self._settings.tilt_joint], points=[point])

    def _refuse(self, problem: str) -> None:
        """Log and publish why something was refused; the head holds still."""
        self.get_logger().warning(problem, throttle_duration_sec=1.0)
        self._errors.publish(String(data=problem))

    def _look_up(self, frame: str, place: Vector) -> Vector | None:
        try:
            transform = self._buffer.lookup_transform(self._settings.world_frame, frame, Time())
        except TransformException as problem:
            self._refuse(f"cannot aim at frame '{frame}': {problem}")
            return None
        shift, turn = transform.transform.translation, transform.transform.rotation
        return Pose((shift.x, shift.y, shift.z), (turn.x, turn.y, turn.z, turn.w)).transform(place)

    def _send(self, now: float) -> None:
        for number, data in self._show.frames(now):
            for output in self._outputs:
                if output.universes is None or number in output.universes:
                    try:
                        output.send(number, data)
                    except OSError as problem:
                        self.get_logger().warning(f"cannot send: {problem}", throttle_duration_sec=5.0)
        if now < float("inf"):
            for output in self._outputs:
                output.maintain(now, output.universes or self._show.universes)


def main() -> int:
    """Run the node."""
    return run(MovingHead)
