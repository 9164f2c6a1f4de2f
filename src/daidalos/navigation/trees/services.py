"""Services of the robot for a tree: time and tasks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from daidalos.common.arrays import Array
    from daidalos.navigation.trees.action_node import ActionNode


class ErrorCode(str):
    """Name of an error code of an action, with its number.

    Parameters
    ----------
    name : str
        Such as ``NO_VALID_PATH``.
    number : int
        Value of the constant of that name in the action's result.
    """

    number: int

    def __new__(cls, name: str, number: int) -> ErrorCode:
        """Create the name with its number."""
        code = super().__new__(cls, name)
        code.number = number
        return code


NO_ERROR = ErrorCode("NONE", 0)
"""Error code of a success."""


@dataclass(frozen=True)
class Outcome:
    """Result of a task.

    Attributes
    ----------
    succeeded : bool
        Whether it did what was asked.
    outputs : mapping of str to object
        Values for the output ports of the node that asked (`path`, ...).
    error_code : str
        Name of the error code of the action, an `ErrorCode` where its number is known; `NO_ERROR` on success.
    error_msg : str
        Why it failed, for people.
    """

    succeeded: bool
    outputs: Mapping[str, Any] = field(default_factory=dict)
    error_code: str = NO_ERROR
    error_msg: str = ""


class Task(Protocol):
    """Started task."""

    def poll(self) -> Outcome | None:
        """Return the outcome; `None` while the task runs. Never blocks."""

    def feedback(self) -> Mapping[str, Any]:
        """Return values of output ports from the latest feedback; empty where none has come since the last call."""

    def update(self, goal: Mapping[str, Any]) -> None:
        """Replace the goal (such as a new path while following one)."""

    def halt(self) -> None:
        """Stop the task; it is not polled afterwards."""


class Services(Protocol):
    """Binding of a tree's leaves to a robot: actions and services of ROS, or direct calls."""

    def now(self) -> float:
        """Return the time [s]."""

    def robot_pose(self, frame: str = "", base: str = "") -> Array | None:
        """Return the latest pose (x, y, yaw) of the robot, None where it is not known.

        Parameters
        ----------
        frame, base : str
            Frames of the pose and of the robot; the navigator's own where empty.
        """

    def robot_pose_stamped(self, frame: str = "", base: str = "") -> Any | None:
        """Return the same as a ``geometry_msgs/msg/PoseStamped``."""

    def pose_in(self, pose: Any, frame: str = "") -> Array | None:
        """Return a ``PoseStamped`` as (x, y, yaw) in a frame, the navigator's where empty; None where not known."""

    def can_transform(self, target: str, source: str) -> bool:
        """Return whether there is a transform between two frames."""

    def velocity(self) -> Array | None:
        """Return the robot's velocity (x, y, yaw) by its odometry, None where there is none."""

    def latest(self, topic: str, kind: str, *, latched: bool = False) -> Any | None:
        """Return the last message of a topic, None until one has come; it is subscribed to from the first call on.

        Parameters
        ----------
        topic : str
        kind : str
            Type of its messages, such as ``std_msgs/msg/String``.
        latched : bool
            Whether messages from before the subscription are asked for.
        """

    def start(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        """Start a task.

        Parameters
        ----------
        node : type
            Class of the leaf that asks.
        goal : mapping of str to object
            Its input ports by name. A port that the tree does not set has the node's default.
        """
