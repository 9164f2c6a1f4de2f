"""`daidalos arm` for arms with seven axes: angles are printed in the controller's order, axis 7 last."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from daidalos.cli.daidalos.arm import rounded
from daidalos.common.pose3 import Pose

if TYPE_CHECKING:
    from daidalos.industry.robots.redundant import RedundantArm

_ARM_ANGLES_DEG = range(-180, 180, 30)


def show(arm: RedundantArm) -> None:
    """Print ranges and speeds."""
    print(f"{arm.title}: payload {arm.payload:g} kg and mass {arm.mass:g} kg of each arm")
    print(f"  order of the axes from the base: {', '.join(map(str, arm.numbers))}")
    for index in arm.controller_order:
        axis = arm.axes[index]
        lower, upper, speed = (math.degrees(value) for value in (axis.lower, axis.upper, axis.speed))
        print(f"  axis {arm.numbers[index]}  {lower:7.1f} to {upper:6.1f} deg, {speed:6.1f} deg/s")
    print(f"Source: {arm.source}")


def print_pose(arm: RedundantArm, degrees: list[float]) -> None:
    """Print the pose of tool0 in the base and the arm angle of angles in the controller's order."""
    from daidalos.industry.motion.redundant_kinematics import forward_of, within_ranges

    if len(degrees) != len(arm.axes):
        raise ValueError(f"{arm.title} has {len(arm.axes)} axes, not {len(degrees)}: axes 1 to 6, then axis 7")
    joints = np.empty(len(degrees))
    joints[arm.controller_order] = np.radians(degrees)
    matrix, arm_angle = forward_of(arm, joints)
    pose = Pose.from_matrix(matrix)
    x, y, z, w = (value if pose.orientation[3] >= 0.0 else -value for value in pose.orientation)
    position = ", ".join(rounded(1e3 * value, 3) for value in pose.position)
    orientation = ", ".join(rounded(value, 6) for value in (w, x, y, z))
    remark = "" if within_ranges(arm, joints) else "  an axis is out of range"
    print(f"[[{position}], [{orientation}]]  arm angle {rounded(math.degrees(float(arm_angle)), 3)} deg{remark}")


def print_solutions(arm: RedundantArm, pose: np.ndarray, arm_angle: float | None) -> None:
    """Print solutions of a pose of tool0 in the base: one at an arm angle [deg], or those all around.

    Raises
    ------
    ValueError
        Where none was found.
    """
    from daidalos.industry.motion.redundant_kinematics import inverse_of

    angles = np.array(_ARM_ANGLES_DEG if arm_angle is None else [arm_angle], dtype=np.float64)
    poses = np.broadcast_to(pose, (len(angles), 4, 4))
    solutions = inverse_of(arm, poses, np.radians(angles))
    found = np.isfinite(solutions).all(axis=1)
    if not found.any():
        where = "" if arm_angle is None else f" with an arm angle of {arm_angle:g} deg"
        raise ValueError(f"no solution was found within the ranges of {arm.title}{where}")
    print("arm angle" + "".join(f"    axis {arm.numbers[index]}" for index in arm.controller_order))
    for angle, joints in zip(angles[found], solutions[found], strict=True):
        columns = "".join(f"{rounded(value, 3):>10}" for value in np.degrees(joints[arm.controller_order]))
        print(f"{rounded(angle, 3):>9}{columns}")
