"""Contract of types of docks."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.navigation.contracts import NavigationExtension


class DockType(NavigationExtension):
    """Type of docks: where the robot waits before one, how it sees one, and when it is docked and charging.

    All poses are (x, y, yaw) in one fixed frame; a dock's yaw is the direction in which it is approached.
    """

    @property
    def is_charger(self) -> bool:
        """Whether such docks charge."""
        return True

    @property
    def is_backward(self) -> bool:
        """Whether the robot drives into the dock with its back ahead."""
        return False

    @property
    def rotates_to_dock(self) -> bool:
        """Whether the robot turns its back to the dock once it has seen it."""
        return False

    @property
    def detection_topic(self) -> str:
        """Topic of the ``geometry_msgs/msg/PoseStamped`` of docks that are seen; empty where none is used."""
        return ""

    @property
    def battery_topic(self) -> str:
        """Topic of the ``sensor_msgs/msg/BatteryState``; empty where it is not used."""
        return ""

    @property
    def joint_topic(self) -> str:
        """Topic of the ``sensor_msgs/msg/JointState``; empty where it is not used."""
        return ""

    def take_detection(self, pose: Pose, stamp: float) -> None:
        """Take a dock that was seen at a time [s]."""

    def take_battery(self, current: float) -> None:
        """Take the current [A] of the battery, positive while it is charged."""

    def take_joints(self, names: Sequence[str], velocities: Sequence[float], efforts: Sequence[float]) -> None:
        """Take velocities and efforts of joints."""

    @abstractmethod
    def staging_pose(self, dock: Array) -> Array:
        """Return the pose before a dock from which it is approached."""

    @abstractmethod
    def start(self, dock: Array) -> None:
        """Start docking or undocking at a dock whose pose is known roughly."""

    @abstractmethod
    def refined_pose(self, dock: Array, now: float) -> Array:
        """Return the pose of the dock at a time [s].

        Parameters
        ----------
        dock : ndarray, shape (3,)
            The last one that was known.
        now : float

        Raises
        ------
        FailedToDetectDock
            It is not seen.
        """

    @abstractmethod
    def is_docked(self, robot: Array) -> bool:
        """Return whether a robot at a pose is docked."""

    def is_charging(self, robot: Array) -> bool:
        """Return whether a robot at a pose is charged."""
        return self.is_docked(robot)

    def disable_charging(self) -> bool:
        """Return whether charging has been switched off, so that the robot may leave."""
        return True

    def has_stopped_charging(self, robot: Array) -> bool:
        """Return whether a robot that has left the dock is no longer charged."""
        return not self.is_charging(robot)
