"""`robot_state_publisher`: transforms of all links from joint states and a URDF, or a model in SDF."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.kinematics import KinematicTree
from daidalos.nodes.conversions import nanoseconds
from daidalos.nodes.description_files import read_description
from daidalos.nodes.packages import package_share
from daidalos.nodes.robot_state_publisher._transform_bytes import TransformBytes
from daidalos.nodes.runner import UserError, run

if TYPE_CHECKING:
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class RobotStatePublisher(Node):
    """Publishes ``/tf``, ``/tf_static`` and ``/robot_description``.

    Parameters of the node are those of ROS 2's: ``robot_description``, ``publish_frequency`` [Hz],
    ``ignore_timestamp``, ``frame_prefix``.

    Parameters
    ----------
    source : str
        Where the description comes from, for messages about its faults.
    **kwargs
        Of `Node`.

    Raises
    ------
    UserError
        When the description is missing or faulty.
    """

    def __init__(self, source: str = "robot_description", **kwargs: Any) -> None:
        super().__init__("robot_state_publisher", **kwargs)
        from sensor_msgs.msg import JointState
        from std_msgs.msg import String
        from tf2_msgs.msg import TFMessage
        from tf2_ros import StaticTransformBroadcaster

        self.declare_parameter("robot_description", "")
        self.declare_parameter("publish_frequency", 20.0)
        self.declare_parameter("ignore_timestamp", False)
        self.declare_parameter("frame_prefix", "")
        self._description_publisher = self.create_publisher(String, "robot_description", _LATCHED)
        self._tf_publisher = self.create_publisher(TFMessage, "/tf", 100)
        self._static_broadcaster = StaticTransformBroadcaster(self)
        self._read(self.get_parameter("robot_description").value, source)
        self.create_subscription(JointState, "joint_states", self._on_joint_states, 10)
        self.add_on_set_parameters_callback(self._on_set_parameters)

    def _read(self, text: str, source: str = "robot_description") -> None:
        """Take a description and publish what does not move."""
        from std_msgs.msg import String

        if not text:
            raise UserError("the parameter 'robot_description' must hold a URDF document, it is empty")
        try:
            robot = _parse(text, source)
        except DescriptionError as error:
            raise UserError(str(error)) from None
        self._tree = KinematicTree(robot)
        self._positions = np.zeros(len(self._tree.joint_names))
        self._index = {name: i for i, name in enumerate(self._tree.joint_names)}
        self._moving = np.flatnonzero(self._tree.moving)
        self._names: list[str] = []
        self._rows = self._columns = np.zeros(0, dtype=np.intp)
        self._last_ns = -1
        self._prefix = self.get_parameter("frame_prefix").value
        self._bytes = TransformBytes(
            [self._prefix + self._tree.parents[row] for row in self._moving],
            [self._prefix + self._tree.children[row] for row in self._moving],
        )
        self._static_broadcaster.sendTransform(
            self._transforms(np.flatnonzero(~self._tree.moving), self.get_clock().now().to_msg())
        )
        self._description_publisher.publish(String(data=text))
        self.get_logger().info("Robot initialized")

    def _transforms(self, rows: Any, stamp: Any) -> list[Any]:
        from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
        from std_msgs.msg import Header

        translations, rotations = self._tree.joint_transforms(self._positions)
        result = []
        for row in rows.tolist():
            x, y, z = translations[row].tolist()
            qx, qy, qz, qw = rotations[row].tolist()
            result.append(
                TransformStamped(
                    header=Header(stamp=stamp, frame_id=self._prefix + self._tree.parents[row]),
                    child_frame_id=self._prefix + self._tree.children[row],
                    transform=Transform(
                        translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)
                    ),
                )
            )
        return result

    def _on_joint_states(self, message: Any) -> None:
        if len(message.position) < len(message.name):
            self.get_logger().error(
                "Robot state publisher ignored an invalid JointState message: it has fewer positions than names",
                throttle_duration_sec=5.0,
            )
            return
        self._take(message.name, message.position)
        if self._is_due(nanoseconds(message.header.stamp)):
            stamp = message.header.stamp
            if self.get_parameter("ignore_timestamp").value:
                stamp = self.get_clock().now().to_msg()
            self._publish(stamp)

    def _take(self, names: list[str], positions: Any) -> None:
        """Take the positions of joints; where each goes is looked up once for as long as the names stay."""
        if names != self._names:
            self._names = list(names)
            rows = [(self._index[name], i) for i, name in enumerate(names) if name in self._index]
            self._rows, self._columns = np.array(rows, dtype=np.intp).reshape(-1, 2).T
        self._positions[self._rows] = np.asarray(positions, dtype=np.float64)[self._columns]

    def _publish(self, stamp: Any) -> None:
        if len(self._moving):
            translations, rotations = self._tree.joint_transforms(self._positions)
            rows = self._moving
            message = self._bytes.write(stamp.sec, stamp.nanosec, translations[rows], rotations[rows])
            self._tf_publisher.publish(message)

    def _is_due(self, stamp_ns: int) -> bool:
        """Tell whether the last transforms are old enough, by the stamps of joint states."""
        if self.get_parameter("ignore_timestamp").value:
            stamp_ns = self.get_clock().now().nanoseconds
        frequency = self.get_parameter("publish_frequency").value
        period = 0.0 if frequency <= 0.0 else 1e9 / frequency
        # A stamp before the last one is a clock that was set back.
        if self._last_ns <= stamp_ns < self._last_ns + period:
            return False
        self._last_ns = stamp_ns
        return True

    def _on_set_parameters(self, parameters: list[Parameter[Any]]) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            if parameter.name == "robot_description":
                try:
                    self._read(parameter.value)
                except UserError as error:
                    return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


def _parse(text: str, source: str) -> Robot | Model:
    if "<sdf" in text[:2000]:
        from daidalos.description import sdf

        return sdf.parse_model(text, source, package_share)
    return urdf.parse(text, source, package_share)


def _from_file(path: str) -> RobotStatePublisher:
    """Make a node of a description in a file: the old command line names one."""
    text = read_description(Path(path))
    return RobotStatePublisher(source=path, parameter_overrides=[Parameter("robot_description", value=text)])


def main() -> int:
    """Run the node."""
    files = remove_ros_args(sys.argv)[1:]
    return run(lambda: _from_file(files[0]) if files else RobotStatePublisher())


if __name__ == "__main__":
    sys.exit(main())
