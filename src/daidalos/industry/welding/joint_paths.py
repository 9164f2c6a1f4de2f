"""Joint angles along paths of the tool, and what keeps an arm from following them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.elasticity.jacobians import jacobians
from daidalos.industry.motion.kinematics import Singularity, inverse, singularities
from daidalos.industry.robots.arm import Arm

SINGULAR_ANGLE = math.radians(1.0)
"""Angle from a singularity of wrist or elbow up to which a path is refused [rad]."""
SINGULAR_DISTANCE = 0.02
"""Distance of the wrist's centre from axis 1 up to which a path is refused [m]."""
MAX_STEP = 0.35
"""Change of an angle between two points beyond which a path leaves its branch [rad]."""

_TURN = 2.0 * math.pi


def branches(arm: Arm, flanges: NDArray[np.float64]) -> tuple[NDArray[np.float64], list[int], list[str]]:
    """Compute the angles along a path for all eight branches.

    Parameters
    ----------
    arm : Arm
        The arm.
    flanges : array of shape (n, 4, 4)
        Poses of tool0 in the base.

    Returns
    -------
    joints : array of shape (8, n, 6)
        Angles without jumps [rad]; NaN where a pose is out of reach.
    usable : list of int
        The branches, values of `cfx`, that can be followed.
    problems : list of str
        What is wrong with each branch; empty where it can be followed.
    """
    joints = np.moveaxis(inverse(arm, flanges).joints, 1, 0).copy()
    problems = []
    for branch in joints:
        reachable = np.isfinite(branch[:, 0])
        if not reachable.all():
            problems.append(f"point {int(np.argmin(reachable)) + 1} is out of reach")
            continue
        branch[:] = _into_ranges(arm, np.unwrap(branch, axis=0))
        problems.append(_problem(arm, branch))
    return joints, [number for number, text in enumerate(problems) if not text], problems


def choose_branch(arm: Arm, flanges: NDArray[np.float64], title: str) -> tuple[NDArray[np.float64], int]:
    """Return the angles (n, 6) [rad] and the `cfx` of the branch that stays farthest inside the ranges of the axes.

    Raises
    ------
    UserError
        Where no branch can be followed; the message names the nearest to it and its point.
    """
    joints, usable, problems = branches(arm, flanges)
    if not usable:
        raise UserError(f"{title}: {arm.title} can not follow the path: {_nearest_problem(problems)}")
    best = max(usable, key=lambda branch: margin(arm, joints[branch]))
    return joints[best], best


def margin(arm: Arm, joints: NDArray[np.float64]) -> float:
    """Return the least distance of joint angles (n, 6) from the ends of their ranges, as a share of the ranges."""
    lower, upper = arm.limits.T
    return float((np.minimum(joints - lower, upper - joints) / (upper - lower)).min())


def joint_speeds(
    joints: NDArray[np.float64], distances: NDArray[np.float64], speed: float | NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the joint speeds (n, 6) [rad/s] along a path at one speed of the tool, or one for each point [m/s]."""
    gradient: NDArray[np.float64] = np.gradient(joints, distances, axis=0) * np.reshape(speed, (-1, 1))
    return gradient


def check_speeds(arm: Arm, speeds: NDArray[np.float64], title: str) -> None:
    """Raise a UserError where a joint would be faster than it can (n, 6) [rad/s]."""
    shares = np.abs(speeds) / arm.speeds
    if shares.max() > 1.0:
        point, axis = (int(one) for one in np.unravel_index(shares.argmax(), shares.shape))
        raise UserError(
            f"{title}: point {point + 1}: axis {axis + 1} needs {math.degrees(abs(speeds[point, axis])):.1f} deg/s, "
            f"but has {math.degrees(arm.speeds[axis]):.1f} deg/s; weld slower"
        )


def condition_numbers(arm: Arm, joints: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the condition numbers (n,) of the Jacobians, with lengths in metres."""
    values: NDArray[np.float64] = np.linalg.cond(jacobians(arm, joints, points))
    return values


def _into_ranges(arm: Arm, joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return angles shifted by the whole turns that put the middle of each axis nearest to that of its range."""
    middles = 0.5 * (joints.max(axis=0) + joints.min(axis=0))
    turns: NDArray[np.float64] = np.round((arm.limits.mean(axis=1) - middles) / _TURN)
    return joints + turns * _TURN


def _problem(arm: Arm, joints: NDArray[np.float64]) -> str:
    """Return what keeps angles (n, 6) from being followed, or nothing."""
    lower, upper = arm.limits.T
    outside = (joints < lower) | (joints > upper)
    if outside.any():
        point, axis = (int(one) for one in np.argwhere(outside)[0])
        return (
            f"point {point + 1} needs axis {axis + 1} at {math.degrees(joints[point, axis]):.1f} deg, outside "
            f"{math.degrees(lower[axis]):g} to {math.degrees(upper[axis]):g} deg"
        )
    singular = singularities(arm, joints, SINGULAR_ANGLE, SINGULAR_DISTANCE)
    if singular.any():
        point = int(np.argmax(singular != 0))
        names = " and ".join(one.name.lower() for one in Singularity(int(singular[point])) if one.name)
        return f"point {point + 1} is in the {names} singularity"
    steps = np.abs(np.diff(joints, axis=0))
    if steps.size and steps.max() > MAX_STEP:
        point, axis = (int(one) for one in np.unravel_index(steps.argmax(), steps.shape))
        turn = math.degrees(steps[point, axis])
        return f"axis {axis + 1} turns by {turn:.0f} deg between points {point + 1} and {point + 2}"
    return ""


def _nearest_problem(problems: list[str]) -> str:
    """Return the problem of the branch that gets farthest."""
    return next((text for text in problems if "out of reach" not in text), problems[0])
