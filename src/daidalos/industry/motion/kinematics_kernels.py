"""Kernels of `daidalos.industry.motion.kinematics`: one loop over poses or joint angles each.

`dimensions` is `Arm.dimensions`, `limits` is `Arm.limits`. The columns of a pose are those of a 4 x 4 matrix.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

_TURN = 2.0 * math.pi
_RELATIVE_TOLERANCE = 1e-12
"""Share by which a wrist may lie beyond the stretched arm, since rounding puts it there."""

_ROTATION_TOLERANCE = 1e-6
"""Deviation from 1 and 0 of the products of a rotation's columns above which it is no rotation."""

_IN_LINE = 1e-12
"""Sine of axis 5 below which axis 4 is zero: its direction is rounding alone."""


@compiled
def forward_kernel(joints: NDArray[np.float64], dimensions: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Compute base from tool0 (N, 4, 4) of joint angles (N, 6)."""
    height, shoulder, lower, elbow, forearm, flange = dimensions
    for n in range(joints.shape[0]):
        c1, s1 = math.cos(joints[n, 0]), math.sin(joints[n, 0])
        c2, s2 = math.cos(joints[n, 1]), math.sin(joints[n, 1])
        pitch = joints[n, 1] + joints[n, 2]
        cp, sp = math.cos(pitch), math.sin(pitch)
        c4, s4 = math.cos(joints[n, 3]), math.sin(joints[n, 3])
        c5, s5 = math.cos(joints[n, 4]), math.sin(joints[n, 4])
        c6, s6 = math.cos(joints[n, 5]), math.sin(joints[n, 5])
        # Columns of Rx(q4) Ry(q5) Rx(q6) Ry(pi/2): -third, second, first of the product of the first three.
        wrist = (
            (-s5 * c6, s5 * s6, c5),
            (s4 * c5 * c6 + c4 * s6, c4 * c6 - s4 * c5 * s6, s4 * s5),
            (-(c4 * c5 * c6 - s4 * s6), s4 * c6 + c4 * c5 * s6, -c4 * s5),
        )
        for column in range(3):
            forward = cp * wrist[0][column] + sp * wrist[2][column]
            left = wrist[1][column]
            out[n, 0, column] = c1 * forward - s1 * left
            out[n, 1, column] = s1 * forward + c1 * left
            out[n, 2, column] = cp * wrist[2][column] - sp * wrist[0][column]
            out[n, 3, column] = 0.0
        radius = shoulder + lower * s2 + elbow * sp + forearm * cp
        out[n, 0, 3] = c1 * radius + flange * out[n, 0, 2]
        out[n, 1, 3] = s1 * radius + flange * out[n, 1, 2]
        out[n, 2, 3] = height + lower * c2 + elbow * cp - forearm * sp + flange * out[n, 2, 2]
        out[n, 3, 3] = 1.0


@compiled
def is_pose(pose: NDArray[np.float64]) -> bool:
    """Return whether a 4 x 4 matrix is a rotation, a finite translation and the last row 0 0 0 1."""
    for i in range(3):
        if not math.isfinite(pose[i, 3]) or pose[3, i] != 0.0:
            return False
        for j in range(i, 3):
            product = pose[0, i] * pose[0, j] + pose[1, i] * pose[1, j] + pose[2, i] * pose[2, j]
            if not abs(product - (1.0 if i == j else 0.0)) < _ROTATION_TOLERANCE:
                return False
    triple = (
        pose[0, 0] * (pose[1, 1] * pose[2, 2] - pose[2, 1] * pose[1, 2])
        - pose[1, 0] * (pose[0, 1] * pose[2, 2] - pose[2, 1] * pose[0, 2])
        + pose[2, 0] * (pose[0, 1] * pose[1, 2] - pose[1, 1] * pose[0, 2])
    )
    return bool(triple > 0.0 and pose[3, 3] == 1.0)


@compiled
def inverse_kernel(
    poses: NDArray[np.float64],
    dimensions: NDArray[np.float64],
    limits: NDArray[np.float64],
    joints: NDArray[np.float64],
    within: NDArray[np.bool_],
) -> int:
    """Compute the eight solutions (N, 8, 6) of poses (N, 4, 4), and which are within the limits (N, 8).

    Return the index of the first matrix that is no pose, else -1.
    """
    height, shoulder, lower, elbow, forearm, flange = dimensions
    reach = math.sqrt(elbow * elbow + forearm * forearm)
    slope = math.atan2(elbow, forearm)
    for n in range(poses.shape[0]):
        pose = poses[n]
        if not is_pose(pose):
            return n
        x, y = pose[0, 3] - flange * pose[0, 2], pose[1, 3] - flange * pose[1, 2]
        z = pose[2, 3] - flange * pose[2, 2] - height
        radius = math.sqrt(x * x + y * y)
        heading = math.atan2(y, x)
        c1, s1 = (x / radius, y / radius) if radius > 0.0 else (1.0, 0.0)
        for behind in range(2):
            sign = 1.0 - 2.0 * behind
            q1 = heading + math.pi * behind
            forward = sign * radius - shoulder
            squared = forward * forward + z * z
            # Products for 1 + cos and 1 - cos of the elbow, which keep their digits near the stretched arm.
            stretched = (lower + reach) ** 2 - squared
            folded = squared - (lower - reach) ** 2
            slack = _RELATIVE_TOLERANCE * (lower + reach) ** 2
            if stretched < -slack or folded < -slack:
                joints[n, 4 * behind : 4 * behind + 4] = math.nan
                within[n, 4 * behind : 4 * behind + 4] = False
                continue
            stretched, folded = math.sqrt(max(stretched, 0.0)), math.sqrt(max(folded, 0.0))
            bend = 2.0 * math.atan2(stretched, folded)
            inner = math.atan2(stretched * folded, squared + lower * lower - reach * reach)
            elevation = math.atan2(z, forward)
            for over in range(2):
                side = 1.0 - 2.0 * over
                q2 = 0.5 * math.pi - elevation - side * inner
                q3 = slope - 0.5 * math.pi + side * bend
                first = 4 * behind + 2 * over
                wrist_kernel(pose, sign * c1, sign * s1, q2 + q3, joints[n, first], joints[n, first + 1])
                for solution in range(first, first + 2):
                    joints[n, solution, 0] = q1
                    joints[n, solution, 1] = q2
                    joints[n, solution, 2] = q3
                    within[n, solution] = turn_to_range(joints[n, solution], limits)
    return -1


@compiled
def wrist_kernel(
    pose: NDArray[np.float64],
    c1: float,
    s1: float,
    pitch: float,
    positive: NDArray[np.float64],
    negative: NDArray[np.float64],
) -> None:
    """Compute axes 4 to 6 with axis 5 positive and negative, where `pitch` is the sum of axes 2 and 3.

    Axis 6 follows from axis 4 rather than from the first row: then the rotation keeps its digits near axis 5 at zero.
    """
    cp, sp = math.cos(pitch), math.sin(pitch)
    # First, second and third column of the wrist are tool0's z, y and -x, seen from the forearm.
    a0, a1, a2 = pose[0, 2], pose[1, 2], pose[2, 2]
    b0, b1, b2 = pose[0, 1], pose[1, 1], pose[2, 1]
    c0, c_1, c2 = -pose[0, 0], -pose[1, 0], -pose[2, 0]
    ahead = c1 * a0 + s1 * a1
    m00, m10, m20 = cp * ahead - sp * a2, c1 * a1 - s1 * a0, sp * ahead + cp * a2
    ahead = c1 * b0 + s1 * b1
    m11, m21 = c1 * b1 - s1 * b0, sp * ahead + cp * b2
    ahead = c1 * c0 + s1 * c_1
    m12, m22 = c1 * c_1 - s1 * c0, sp * ahead + cp * c2
    s5 = math.sqrt(m10 * m10 + m20 * m20)
    in_line = s5 < _IN_LINE
    c4, s4 = (1.0, 0.0) if in_line else (-m20 / s5, m10 / s5)
    q4 = math.atan2(s4, c4)
    q5 = math.atan2(s5, m00)
    q6 = math.atan2(-(c4 * m12 + s4 * m22), c4 * m11 + s4 * m21)
    positive[3], positive[4], positive[5] = q4, q5, q6
    if in_line:
        negative[3], negative[4], negative[5] = q4, q5, q6
    else:
        negative[3], negative[4], negative[5] = q4 + math.pi, -q5, q6 + math.pi


@compiled
def turn_to_range(joints: NDArray[np.float64], limits: NDArray[np.float64]) -> bool:
    """Add whole turns to six angles so that each is nearest to the middle of its range; return whether all are in."""
    inside = True
    for axis in range(6):
        middle = 0.5 * (limits[axis, 0] + limits[axis, 1])
        angle = joints[axis]
        while angle - middle > math.pi:
            angle -= _TURN
        while angle - middle <= -math.pi:
            angle += _TURN
        joints[axis] = angle
        inside &= limits[axis, 0] <= angle <= limits[axis, 1]
    return inside
