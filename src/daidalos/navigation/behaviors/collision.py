"""Collision checks of motions."""

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker


def contact_ahead(
    costmap: Costmap, footprint: Footprint, pose: Array, speed: float, turn: float, duration: float
) -> bool:
    """Return whether a robot that keeps its velocity for a time collides; see `time_to_contact`.

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
    velocity = np.array([speed, 0.0, turn])
    return time_to_contact(costmap, footprint, pose, velocity, duration, duration) < duration


def time_to_contact(
    costmap: Costmap, footprint: Footprint, pose: Array, velocity: Array, duration: float, step: float
) -> float:
    """Return how long [s] a robot can keep a velocity before it collides; `duration` where it does not until then.

    A robot that collides already may move on if it is free at the end: it drives away from the obstacle.

    Parameters
    ----------
    costmap : Costmap
        Inflated costs around the robot.
    footprint : Footprint
        Outline of the robot.
    pose : ndarray, shape (3,)
        Where it is.
    velocity : ndarray, shape (3,)
        Velocity (x [m/s], y [m/s], yaw [rad/s]) in its own frame.
    duration : float
        How far to look ahead [s].
    step : float
        Time [s] between two poses that are checked; shorter where the robot moves by more than a cell meanwhile.
    """
    checker = FootprintCollisionChecker(costmap, footprint)
    speed = float(np.hypot(velocity[0], velocity[1])) + abs(float(velocity[2])) * footprint.circumscribed_radius
    count = max(int(np.ceil(duration / step)), int(np.ceil(speed * duration / costmap.resolution)), 1)
    elapsed = np.arange(count + 1) * (duration / count)
    turned = velocity[2] * elapsed
    chord = elapsed * np.sinc(turned / (2.0 * np.pi))
    heading = pose[2] + 0.5 * turned
    x = pose[0] + chord * (velocity[0] * np.cos(heading) - velocity[1] * np.sin(heading))
    y = pose[1] + chord * (velocity[0] * np.sin(heading) + velocity[1] * np.cos(heading))
    poses = np.stack([x, y, pose[2] + turned], axis=-1)
    if checker.in_collision(poses[0]):
        return 0.0 if checker.in_collision(poses[-1]) else duration
    for before, at in zip(elapsed[:-1], poses[1:], strict=True):
        if checker.in_collision(at):
            return float(before)
    return duration
