"""Contracts of behaviours and of tasks at waypoints."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Generic, TypeVar

from daidalos.common.arrays import Array
from daidalos.navigation.contracts.extension import NavigationExtension
from daidalos.navigation.contracts.topics import Input
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint

Command = TypeVar("Command")


@dataclass(frozen=True)
class BehaviorStep:
    """Result of one cycle.

    Attributes
    ----------
    velocity : ndarray, shape (3,)
        Velocity command (x [m/s], y [m/s], yaw [rad/s]) in the robot's frame.
    done : bool
        Whether the behaviour is done; the velocity is zero then.
    feedback : float
        What is done so far: distance [m], angle [rad]; the time left [s] of a wait.
    """

    velocity: Array
    done: bool
    feedback: float


class Behavior(NavigationExtension, Generic[Command]):
    """Motion that continues until it is done, fails or is cancelled.

    A behaviour is asked for by an action of its own name.

    Attributes
    ----------
    action : str
        Class attribute: type of the action, such as ``nav2_msgs/action/Spin``.
    feedback : str
        Class attribute: field of the action's feedback for what is done so far; empty where there is none.
    moves : bool
        Class attribute: whether it moves the robot, and so needs to know what is around it.
    """

    action: ClassVar[str]
    feedback: ClassVar[str] = ""
    moves: ClassVar[bool] = True

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the behaviour subscribes to."""
        return ()

    @property
    def period(self) -> float:
        """Period of a cycle [s]."""
        return 1.0 / self.context.frequency

    def set_footprint(self, footprint: Footprint) -> None:
        """Use another outline of the robot from the next cycle on."""
        self.context = replace(self.context, footprint=footprint)

    @classmethod
    @abstractmethod
    def command(cls, goal: Any) -> Command:
        """Return the command of an action's goal, whose fields are attributes; durations are in seconds."""

    @abstractmethod
    def start(self, command: Command, pose: Array, now: float) -> None:
        """Start.

        Parameters
        ----------
        command : Command
            How far, how fast, how long.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot, in the frame of all that follow.
        now : float
            Time [s].

        Raises
        ------
        InvalidInput
            The command makes no sense.
        """

    @abstractmethod
    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Compute the velocity of the next cycle.

        Parameters
        ----------
        pose, velocity : ndarray, shape (3,)
            Pose of the robot in the costmap's frame, and its velocity in its own.
        costmap : Costmap
            Inflated costs around the robot.
        now : float
            Time [s].

        Raises
        ------
        BehaviorError
            It cannot go on: `CollisionAhead` or `TimedOut`.
        """


class WaypointTask(NavigationExtension):
    """Task that is carried out at each waypoint."""

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the task subscribes to."""
        return ()

    @abstractmethod
    def start(self, index: int, pose: Array, now: float) -> None:
        """Start the task.

        Parameters
        ----------
        index : int
            Which waypoint the robot has reached, from 0.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the waypoint in its own frame.
        now : float
            Time [s].
        """

    @abstractmethod
    def step(self, now: float) -> bool:
        """Return whether the task is done at a time [s].

        Raises
        ------
        TaskFailed
            It cannot be done.
        """
