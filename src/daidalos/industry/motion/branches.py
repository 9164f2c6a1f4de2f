"""Angles along a path of the tool: one solution of the inverse kinematics, followed without a jump."""

from __future__ import annotations

import math

import numpy as np

from daidalos.industry.motion.faults import CONFIGURATION, JOINT_RANGE, OUT_OF_REACH, SINGULARITY, MotionFault
from daidalos.industry.motion.kinematics import (
    JointRangeError,
    confdata,
    inverse,
    joints_of_configuration,
    singularities,
)
from daidalos.industry.motion.orientations import Array, matrices
from daidalos.industry.robots import Arm

MAX_JUMP = math.radians(25.0)
"""Angle between two samples of a path above which the arm passes a singularity [rad]."""

_SINGULAR_ANGLE = math.radians(0.05)
_SINGULAR_DISTANCE = 0.5e-3
_TURN = 2.0 * math.pi
_NAMES = {1: "axes 4 and 6 are in line", 2: "the arm is stretched or folded", 4: "the wrist is above axis 1"}


def flange_poses(positions: Array, orientations: Array, tool: Array) -> Array:
    """Return the poses (n, 4, 4) of the flange for poses of the tool, which is given on the flange as (4, 4)."""
    poses = np.zeros((len(positions), 4, 4))
    poses[:, :3, :3] = matrices(orientations)
    poses[:, :3, 3] = positions
    poses[:, 3, 3] = 1.0
    back = np.eye(4)
    back[:3, :3] = tool[:3, :3].T
    back[:3, 3] = -tool[:3, :3].T @ tool[:3, 3]
    return np.asarray(poses @ back)


def follow(arm: Arm, poses: Array, start: Array) -> Array:
    """Return the angles (n, 6) along poses of the flange (n, 4, 4), beginning nearest to some angles (6,).

    Raises
    ------
    MotionFault
        Out of reach, in or through a singularity, or out of an axis's range.
    """
    solutions = inverse(arm, poses).joints
    first = solutions[0] + _TURN * np.round((start - solutions[0]) / _TURN)
    distances = np.abs(first - start).max(axis=1)
    if not np.isfinite(distances).any():
        _raise_unreachable(arm, poses[0])
    index = int(np.nanargmin(distances))
    angles = solutions[:, index]
    lost = ~np.isfinite(angles[:, 0])
    if lost.any():
        _raise_unreachable(arm, poses[int(np.argmax(lost))])
    angles = np.unwrap(np.concatenate([start[None], angles]), axis=0)[1:]
    _check_singular(arm, angles)
    check_ranges(arm, angles)
    return np.asarray(angles)


def _raise_unreachable(arm: Arm, pose: Array) -> None:
    x, y, z = 1e3 * pose[:3, 3]
    raise MotionFault(OUT_OF_REACH, f"{arm.title} does not reach [{x:.1f},{y:.1f},{z:.1f}] mm of the flange so turned")


def _check_singular(arm: Arm, angles: Array) -> None:
    found = singularities(arm, angles, _SINGULAR_ANGLE, _SINGULAR_DISTANCE)
    jumps = np.abs(np.diff(angles, axis=0)).max(axis=1, initial=0.0) > MAX_JUMP
    crossed = np.diff(np.signbit(np.sin(angles[:, 4])).astype(int)) != 0
    if not found.any() and not jumps.any() and not crossed.any():
        return
    kind = int(found[np.argmax(found != 0)]) or 1
    name = next(text for value, text in _NAMES.items() if kind & value)
    raise MotionFault(SINGULARITY, f"{name} on the way; change the point, use MoveJ or SingArea \\Wrist")


def check_ranges(arm: Arm, angles: Array) -> None:
    """Raise a MotionFault where angles (n, 6) leave the ranges of the axes."""
    low, high = arm.limits.T
    outside = (angles < low - 1e-9) | (angles > high + 1e-9)
    if not outside.any():
        return
    row, axis = np.argwhere(outside)[0]
    raise MotionFault(
        JOINT_RANGE,
        f"axis {axis + 1} would be at {math.degrees(angles[row, axis]):.1f} deg, outside "
        f"{math.degrees(low[axis]):g} to {math.degrees(high[axis]):g} deg",
    )


def joints_at(arm: Arm, pose: Array, configuration: tuple[int, int, int, int] | None, near: Array) -> Array:
    """Return the angles (6,) of a pose of the flange (4, 4), with ABB's configuration or nearest to other angles.

    Raises
    ------
    MotionFault
        Out of reach, out of an axis's range, or where the configuration is not that of a solution.
    """
    solutions = inverse(arm, pose)
    if not solutions.reachable.any():
        _raise_unreachable(arm, pose)
    if configuration is not None:
        try:
            return joints_of_configuration(arm, pose, configuration)
        except JointRangeError as error:
            raise MotionFault(JOINT_RANGE, str(error)) from None
        except ValueError as error:
            raise MotionFault(CONFIGURATION, f"{error}; it is reached with {_known(arm, solutions.joints)}") from None
    angles = solutions.joints + _TURN * np.round((near - solutions.joints) / _TURN)
    low, high = arm.limits.T
    angles = np.where(angles < low, angles + _TURN, np.where(angles > high, angles - _TURN, angles))
    inside = ((angles >= low) & (angles <= high)).all(axis=1)
    if not inside.any():
        check_ranges(arm, angles[solutions.reachable][:1])
    distances = np.where(inside, np.abs(angles - near).max(axis=1), np.inf)
    return np.asarray(angles[int(np.argmin(distances))])


def _known(arm: Arm, joints: Array) -> str:
    """Return the configurations of solutions (8, 6) within limits, as text."""
    low, high = arm.limits.T
    good = joints[np.isfinite(joints[:, 0]) & (joints >= low).all(axis=1) & (joints <= high).all(axis=1)]
    found = dict.fromkeys(str(conf.tolist()).replace(" ", "") for conf in confdata(arm, good)) if len(good) else {}
    return " or ".join(list(found)[:4]) or "none that is within the ranges of the axes"


def check_configuration(arm: Arm, angles: Array, configuration: tuple[int, int, int, int]) -> None:
    """Raise a MotionFault where angles (6,) have another configuration; one at the border of two quadrants has both."""
    quarters = angles[[0, 3, 5]] / (0.5 * math.pi)
    wanted = np.array(configuration[:3])
    tolerance = 1e-3
    is_same = ((quarters >= wanted - tolerance) & (quarters <= wanted + 1.0 + tolerance)).all()
    found = confdata(arm, angles).tolist()
    if is_same and found[3] == configuration[3]:
        return
    text = str(found).replace(" ", "")
    wanted_text = str(list(configuration)).replace(" ", "")
    raise MotionFault(
        CONFIGURATION, f"the arm arrives with {text} and not {wanted_text}; correct it or use ConfL \\Off"
    )
