"""Distances between the links of a robot with two arms, over arrays.

Links are capsules that enclose their shapes, so that a distance is never greater than the true one. Not compared are
links that a joint connects, those that lie two joints apart, which the ranges of the axes keep away from each other,
and the links of the shoulders with the body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled
from daidalos.industry.motion.redundant_kernels import link_frames
from daidalos.industry.robots.redundant import AXES, Capsule, TwoArmedRobot

Array = NDArray[np.float64]

_NEIGHBOURS = 2
"""Joints between two links of an arm up to which they are not compared."""

_BODY = 16


@dataclass(frozen=True)
class Closest:
    """Pairs of links that are closest to each other.

    Attributes
    ----------
    distances : array of shape (...)
        [m]; negative where the capsules are in each other.
    pairs : array of shape (..., 2)
        Indices of the links in `link_names`.
    """

    distances: Array
    pairs: NDArray[np.int64]


def link_names(robot: TwoArmedRobot) -> list[str]:
    """Return the names of the links by their indices: eight of each arm, the body last."""
    return [f"{side} link {number}" for side in robot.bases for number in range(AXES + 1)] + ["body"]


def closest_links(robot: TwoArmedRobot, joints: Array) -> Closest:
    """Compute the least distances between links.

    Parameters
    ----------
    robot : TwoArmedRobot
        The robot.
    joints : array of shape (..., 2, 7)
        Angles of the arms in the order of `robot.bases`, from the base on [rad].
    """
    angles = np.ascontiguousarray(joints, dtype=np.float64)
    if angles.ndim < 2 or angles.shape[-2:] != (2, AXES):
        raise ValueError(f"joint angles have the shape {angles.shape}, but (..., 2, {AXES}) is needed")
    shape = angles.shape[:-2]
    flat = angles.reshape(-1, 2, AXES)
    frames = np.empty((len(flat), _BODY + 1, 4, 4))
    frames[:, _BODY] = np.eye(4)
    for number, side in enumerate(robot.bases):
        part = np.empty((len(flat), AXES + 1, 4, 4))
        link_frames(np.ascontiguousarray(flat[:, number]), robot.arm.geometry, robot.side(side), part)
        frames[:, number * (AXES + 1) : (number + 1) * (AXES + 1)] = part
    links, capsules = _capsules(robot)
    distances, pairs = np.empty(len(flat)), np.empty((len(flat), 2), dtype=np.int64)
    _closest(frames, links, capsules, _compared(robot, links), distances, pairs)
    return Closest(distances.reshape(shape), pairs.reshape(*shape, 2))


def _capsules(robot: TwoArmedRobot) -> tuple[NDArray[np.int64], Array]:
    """Return the links of all capsules (N,), and their ends and radii (N, 7)."""
    placed: list[tuple[int, Capsule]] = [
        (side * (AXES + 1) + number, one)
        for side in range(2)
        for number, capsules in enumerate(robot.arm.links)
        for one in capsules
    ] + [(_BODY, one) for one in robot.body]
    links = np.array([link for link, _ in placed], dtype=np.int64)
    return links, np.array([[*one.start, *one.end, one.radius] for _, one in placed])


def _compared(robot: TwoArmedRobot, links: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the pairs of capsules (M, 2) that are compared."""
    pairs = []
    for first in range(len(links)):
        for second in range(first + 1, len(links)):
            a, b = int(links[first]), int(links[second])
            if b == _BODY:
                is_compared = a != _BODY and a % (AXES + 1) > robot.free_links
            elif a // (AXES + 1) == b // (AXES + 1):
                is_compared = b - a > _NEIGHBOURS
            else:
                is_compared = True
            if is_compared:
                pairs.append((first, second))
    return np.array(pairs, dtype=np.int64)


@compiled
def _segment_distance(a: Array, b: Array, c: Array, d: Array) -> float:
    """Return the distance of the segments from a to b and from c to d.

    As in Ericson, "Real-Time Collision Detection", section 5.1.9.
    """
    u, v, w = b - a, d - c, a - c
    uu, vv, uv, uw, vw = (u * u).sum(), (v * v).sum(), (u * v).sum(), (u * w).sum(), (v * w).sum()
    tiny = 1e-18
    if uu <= tiny and vv <= tiny:
        s = t = 0.0
    elif uu <= tiny:
        s, t = 0.0, min(max(vw / vv, 0.0), 1.0)
    elif vv <= tiny:
        s, t = min(max(-uw / uu, 0.0), 1.0), 0.0
    else:
        across = uu * vv - uv * uv
        s = min(max((uv * vw - uw * vv) / across, 0.0), 1.0) if across > tiny else 0.0
        t = (uv * s + vw) / vv
        if t < 0.0:
            s, t = min(max(-uw / uu, 0.0), 1.0), 0.0
        elif t > 1.0:
            s, t = min(max((uv - uw) / uu, 0.0), 1.0), 1.0
    gap = w + s * u - t * v
    return float(np.sqrt((gap * gap).sum()))


@compiled
def _closest(
    frames: Array,
    links: NDArray[np.int64],
    capsules: Array,
    compared: NDArray[np.int64],
    distances: Array,
    pairs: NDArray[np.int64],
) -> None:
    """Find the closest pairs of capsules in frames (N, 17, 4, 4)."""
    ends = np.empty((capsules.shape[0], 2, 3))
    for n in range(frames.shape[0]):
        for one in range(capsules.shape[0]):
            frame = frames[n, links[one]]
            for end in range(2):
                for k in range(3):
                    place = frame[k, 3]
                    for i in range(3):
                        place += frame[k, i] * capsules[one, 3 * end + i]
                    ends[one, end, k] = place
        distances[n] = np.inf
        for pair in range(compared.shape[0]):
            first, second = compared[pair]
            distance = _segment_distance(ends[first, 0], ends[first, 1], ends[second, 0], ends[second, 1])
            distance -= capsules[first, 6] + capsules[second, 6]
            if not distance >= distances[n]:
                distances[n] = distance
                pairs[n, 0], pairs[n, 1] = links[first], links[second]
