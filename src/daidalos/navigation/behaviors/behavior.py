"""The contract of a behaviour: started with a command, then asked for a velocity every cycle."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.errors import NavigationError

Array = NDArray[np.float64]
Command = TypeVar("Command")


class BehaviorError(NavigationError):
    """A behaviour ended before it was done; the message says why."""


class CollisionAhead(BehaviorError):
    """The robot would touch something."""

    code = "COLLISION_AHEAD"


class TimedOut(BehaviorError):
    """The time allowance is used up."""

    code = "TIMEOUT"


class InvalidInput(BehaviorError):
    """The command makes no sense."""

    code = "INVALID_INPUT"


@dataclass(frozen=True)
class BehaviorStep:
    """What one cycle gave.

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


class Behavior(ABC, Generic[Command]):
    """A motion that goes on until it is done, fails, or is no longer asked for.

    Parameters
    ----------
    footprint : Footprint
        Outline of the robot.
    cycle_frequency : float
        Cycles per second.
    """

    def __init__(self, footprint: Footprint, cycle_frequency: float = 10.0) -> None:
        self.footprint = footprint
        self.period = 1.0 / cycle_frequency

    @abstractmethod
    def start(self, command: Command, pose: Array, now: float) -> None:
        """Begin.

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
        """Find the velocity for the next cycle.

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
            It can not go on: `CollisionAhead` or `TimedOut`.
        """


def contact_ahead(
    costmap: Costmap, footprint: Footprint, pose: Array, speed: float, turn: float, duration: float
) -> bool:
    """Whether a robot that keeps its velocity for a while comes to touch what it does not touch now.

    Parameters
    ----------
    costmap : Costmap
        Inflated costs around the robot.
    footprint : Footprint
        Outline of the robot.
    pose : ndarray, shape (3,)
        Where it is.
    speed, turn : float
        Forward [m/s] and angular [rad/s] velocity.
    duration : float
        How far to look ahead [s].
    """
    checker = FootprintCollisionChecker(costmap, footprint)
    if checker.in_collision(pose):
        return False
    motion = max(abs(speed), abs(turn) * footprint.circumscribed_radius)
    steps = max(int(np.ceil(motion * duration / costmap.resolution)), 1)
    elapsed = np.arange(1, steps + 1) * (duration / steps)
    headings = pose[2] + turn * elapsed
    ahead = speed * elapsed * np.sinc(turn * elapsed / (2.0 * np.pi))
    chords = pose[2] + 0.5 * turn * elapsed
    poses = np.stack([pose[0] + ahead * np.cos(chords), pose[1] + ahead * np.sin(chords), headings], axis=-1)
    return any(checker.in_collision(at) for at in poses)
