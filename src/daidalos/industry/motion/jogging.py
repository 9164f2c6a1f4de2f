"""Jogging: small movements of an arm by its axes, or of its tool along and about the axes of a frame."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from daidalos.industry.motion.branches import check_ranges, joints_at
from daidalos.industry.motion.faults import SINGULARITY, MotionFault
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.orientations import Array
from daidalos.industry.robots import Arm

Frame = Literal["axis", "base", "tool", "wobj"]
FRAMES: tuple[Frame, ...] = ("axis", "base", "tool", "wobj")
LARGEST_TURN = np.radians(30.0)
"""Greatest turn of an axis in a step of the tool [rad]: beyond it, the arm would change its configuration."""


def jog_axis(arm: Arm, joints: Array, axis: int, angle: float) -> Array:
    """Return the angles (6,) [rad] with one axis, from 0, turned.

    Raises
    ------
    MotionFault
        Where the axis leaves its range.
    """
    moved = joints.copy()
    moved[axis] += angle
    check_ranges(arm, moved[None])
    return moved


def jog_tool(arm: Arm, joints: Array, tool: Array, rotation: Array, translation: Array, turn: Array) -> Array:
    """Return the angles (6,) [rad] with the tool moved in a frame, and turned about its tip.

    Parameters
    ----------
    tool
        The tool on the flange (4, 4) [m].
    rotation
        The frame's axes in the base (3, 3); those of the tool itself move with it.
    translation, turn
        Along and about the axes of the frame (3,) [m, rad].

    Raises
    ------
    MotionFault
        Where the arm does not reach, an axis leaves its range, or a singularity is in the way.
    """
    pose = forward(arm, joints) @ tool
    moved = pose.copy()
    moved[:3, 3] += rotation @ translation
    moved[:3, :3] = Rotation.from_rotvec(rotation @ turn).as_matrix() @ pose[:3, :3]
    found = joints_at(arm, moved @ np.linalg.inv(tool), None, joints)
    if np.abs(found - joints).max() > LARGEST_TURN:
        axis = int(np.abs(found - joints).argmax())
        raise MotionFault(SINGULARITY, f"axis {axis + 1} would turn by more than 30 deg; jog by axis")
    return found


def axes_of(frame: Frame, arm: Arm, joints: Array, tool: Array, wobj: Array) -> Array:
    """Return the axes (3, 3) of a frame in the base."""
    if frame == "tool":
        return np.asarray((forward(arm, joints) @ tool)[:3, :3])
    return wobj[:3, :3] if frame == "wobj" else np.eye(3)
