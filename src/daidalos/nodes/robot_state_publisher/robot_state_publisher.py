"""`robot_state_publisher`: transforms of all links from joint states and a URDF or SDF model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.parameters import Parameters, parameter
from daidalos.description.kinematics import KinematicTree
from daidalos.nodes.description_files import parse_description, read_description
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.robot_state_publisher._transform_bytes import TransformBytes
from daidalos.nodes.runner import program_arguments, run
from daidalos.samples.fields import nanoseconds

_KEPT = 100
"""Sets of joints that are told of together; a robot has a few."""

_SET_BACK_NS = 1_000_000_000
"""States that are older than this mean that the clock was set back; younger ones are another publisher's, and late."""


@dataclass(frozen=True)
class _JointUpdate:
    """Cached indices of a message about a set of joints.

    Parameters
    ----------
    columns, rows : arrays of int
        Places of the robot's joints in the message, and in the positions.
    moved : array of int
        Transforms that depend on them.
    bytes : TransformBytes
        Writes those.
    """

    columns: NDArray[np.intp]
    rows: NDArray[np.intp]
    moved: NDArray[np.intp]
    bytes: TransformBytes


@dataclass(frozen=True)
class RobotStatePublisherParameters(Parameters):
    """Parameters of ``robot_state_publisher``."""

    robot_description: str = parameter("", "Description of the robot, as URDF or SDF.", not_empty=True)
    publish_frequency: float = parameter(
        20.0, "Highest rate of transforms; 0 for every joint state.", unit="Hz", minimum=0.0, maximum=1000.0
    )
    ignore_timestamp: bool = parameter(False, "Whether to publish every joint state, whatever its stamp.")
    frame_prefix: str = parameter("", "Put before the names of all frames.")


class RobotStatePublisher(Node):
    """Node that publishes ``/tf``, ``/tf_static`` and ``/robot_description``.

    As in ROS 2, a joint has a transform only once its state is told, and what a floating joint holds is left to others.

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

        self._settings = declare(self, RobotStatePublisherParameters, reconfigure=self._reconfigure)
        self._description_publisher = self.create_publisher(String, "robot_description", LATCHED)
        self._tf_publisher = self.create_publisher(TFMessage, "/tf", 100)
        self._static_broadcaster = StaticTransformBroadcaster(self)
        self._read(self._settings, source)
        self.create_subscription(JointState, "joint_states", self._on_joint_states, 10)

    def _read(self, settings: RobotStatePublisherParameters, source: str = "robot_description") -> None:
        """Read a description and publish its static transforms."""
        from std_msgs.msg import String

        self._tree = KinematicTree(parse_description(settings.robot_description, source))
        self._positions = np.zeros(len(self._tree.joint_names))
        self._last_ns = np.zeros(len(self._tree.joint_names), dtype=np.int64)
        self._told: dict[tuple[str, ...], _JointUpdate] = {}
        self._prefix = settings.frame_prefix
        self._static_broadcaster.sendTransform(
            self._transforms(np.flatnonzero(~self._tree.moving & ~self._tree.floating), self.get_clock().now().to_msg())
        )
        self._description_publisher.publish(String(data=settings.robot_description))
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
        told = self._meaning(tuple(message.name))
        if not len(told.rows):
            return
        self._positions[told.rows] = np.asarray(message.position, dtype=np.float64)[told.columns]
        stamp = message.header.stamp
        if self._settings.ignore_timestamp or self._is_due(nanoseconds(stamp), told.rows):
            poses = self._tree.joint_transforms(self._positions, told.moved)
            self._tf_publisher.publish(told.bytes.write(stamp.sec, stamp.nanosec, *poses))

    def _meaning(self, names: tuple[str, ...]) -> _JointUpdate:
        """Return the cached indices of a message about these joints."""
        if names not in self._told:
            if len(self._told) >= _KEPT:
                self._told.clear()
            index = {name: row for row, name in enumerate(self._tree.joint_names)}
            places = [(column, index[name]) for column, name in enumerate(names) if name in index]
            columns, rows = np.array(places, dtype=np.intp).reshape(-1, 2).T
            moved = np.flatnonzero(np.isin(self._tree.drivers, rows))
            self._told[names] = _JointUpdate(
                columns,
                rows,
                moved,
                TransformBytes(
                    [self._prefix + self._tree.parents[row] for row in moved],
                    [self._prefix + self._tree.children[row] for row in moved],
                ),
            )
        return self._told[names]

    def _is_due(self, stamp_ns: int, rows: NDArray[np.intp]) -> bool:
        """Return whether the last transforms of joints are old enough, by the stamps of joint states.

        States that come at the wanted rate are late and early in turn: up to one period is kept for the early ones.
        """
        if stamp_ns == 0:
            self.get_logger().warning(
                "joint states without a time are not published; set header.stamp", throttle_duration_sec=10.0
            )
            return False
        frequency = self._settings.publish_frequency
        period = 0 if frequency <= 0.0 else round(1e9 / frequency)
        last = int(self._last_ns[rows].min())
        if stamp_ns < last - _SET_BACK_NS:
            last = stamp_ns - period
        if stamp_ns < last + period:
            return False
        self._last_ns[rows] = max(last + period, stamp_ns - period)
        return True

    def _reconfigure(self, parameters: RobotStatePublisherParameters) -> None:
        before = self._settings
        changed = (parameters.robot_description, parameters.frame_prefix)
        if changed != (before.robot_description, before.frame_prefix):
            self._read(parameters)
        self._settings = parameters


def _from_file(path: str) -> RobotStatePublisher:
    """Make a node of a description in a file: the old command line names one."""
    text = read_description(Path(path))
    return RobotStatePublisher(source=path, parameter_overrides=[Parameter("robot_description", value=text)])


def main() -> int:
    """Run the node."""
    files = program_arguments()
    return run(lambda: _from_file(files[0]) if files else RobotStatePublisher())
