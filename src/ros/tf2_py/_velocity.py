"""Velocities of frames, from how they moved during a span of time."""

from __future__ import annotations

from collections.abc import Callable

from daidalos.common.pose3 import Vector, rotate, rotation_vector

from ._rigid import Rigid, compose, inverse

Lookup = Callable[[str, str, int], tuple[int, Rigid]]
"""Returns the time [ns] and the transform of a target frame, a source frame and a time [ns]."""


def velocity(
    lookup: Lookup, latest_ns: int, tracking: str, observation: str, middle_ns: int, span_ns: int
) -> tuple[Vector, Vector]:
    """Return the linear and angular velocity of the tracking frame's origin, in the axes of the observation frame."""
    return velocity_of_point(
        lookup, latest_ns, tracking, observation, observation, (0.0, 0.0, 0.0), tracking, middle_ns, span_ns
    )


def velocity_of_point(
    lookup: Lookup,
    latest_ns: int,
    tracking: str,
    observation: str,
    reference: str,
    point: Vector,
    point_frame: str,
    middle_ns: int,
    span_ns: int,
) -> tuple[Vector, Vector]:
    """Return the velocity of a point that moves with the tracking frame, in the axes of `reference`."""
    end_ns = min(middle_ns + span_ns // 2, latest_ns)
    start_ns = max(end_ns - span_ns, 1)
    seconds = (end_ns - start_ns) / 1e9
    if seconds <= 0.0:
        raise ValueError(f"there is no span of time to average over: {span_ns} ns that end at {end_ns} ns")
    _, start = lookup(observation, tracking, start_ns)
    _, end = lookup(observation, tracking, end_ns)
    _, axes = lookup(reference, observation, middle_ns)
    _, origin = lookup(reference, tracking, middle_ns)
    _, place = lookup(reference, point_frame, middle_ns)
    moved = ((end[0] - start[0]) / seconds, (end[1] - start[1]) / seconds, (end[2] - start[2]) / seconds)
    turned = rotation_vector(compose(inverse(start), end)[3:])
    turned = rotate(start[3:], turned)
    linear = rotate(axes[3:], moved)
    angular = rotate(axes[3:], (turned[0] / seconds, turned[1] / seconds, turned[2] / seconds))
    x, y, z = rotate(place[3:], point)
    arm = (x + place[0] - origin[0], y + place[1] - origin[1], z + place[2] - origin[2])
    return (
        (
            linear[0] + angular[1] * arm[2] - angular[2] * arm[1],
            linear[1] + angular[2] * arm[0] - angular[0] * arm[2],
            linear[2] + angular[0] * arm[1] - angular[1] * arm[0],
        ),
        angular,
    )
