"""Poses of actors over the time of their scripts."""

from __future__ import annotations

import bisect

from daidalos.common.pose3 import Pose, interpolate
from daidalos.description.world import Actor


def actor_pose(actor: Actor, time: float) -> Pose:
    """Return an actor's pose in the world.

    Parameters
    ----------
    actor : Actor
    time : float
        Since the simulation began [s]. Between two waypoints the actor goes straight and turns evenly.
    """
    points = actor.waypoints
    if not points:
        return actor.pose
    elapsed = time - actor.delay_start if actor.auto_start else 0.0
    if actor.loop and points[-1].time > 0 and elapsed > 0:
        elapsed %= points[-1].time
    after = bisect.bisect_right([point.time for point in points], elapsed)
    if after == 0:
        return points[0].pose
    if after == len(points):
        return points[-1].pose
    first, second = points[after - 1], points[after]
    return interpolate(first.pose, second.pose, (elapsed - first.time) / (second.time - first.time))
