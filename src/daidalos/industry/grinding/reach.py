"""Poses of the arm along lines, and whether it can follow them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.grinding.cell import Tool
from daidalos.industry.grinding.height_field import Workpiece
from daidalos.industry.robots import arm_named
from daidalos.industry.welding.joint_paths import choose_branch

TOOL_LENGTH = 0.55
"""From the flange to the disc at the middle of the stroke [m]."""


def flange_poses(tools: Sequence[Tool], piece: Workpiece) -> NDArray[np.float64]:
    """Return the poses of the flange in the base (n, 4, 4): z into the workpiece, x towards the contact."""
    normals = np.array([[-tool.slope_x, -tool.slope_y, 1.0] for tool in tools])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    leans = np.array([[tool.lean_x, tool.lean_y, 0.0] for tool in tools])
    leans -= np.einsum("ni,ni->n", leans, normals)[:, None] * normals
    leans /= np.linalg.norm(leans, axis=1, keepdims=True)
    poses = np.tile(np.eye(4), (len(tools), 1, 1))
    poses[:, :3, :3] = np.stack([leans, np.cross(-normals, leans), -normals], axis=2)
    heights = [float(piece.target[piece.index(tool.x, tool.y)]) for tool in tools]
    places = np.array([[tool.x, tool.y, height] for tool, height in zip(tools, heights, strict=True)])
    poses[:, :3, 3] = places + TOOL_LENGTH * normals
    return piece.pose @ poses


def joints_along(robot: str, tools: Sequence[Sequence[Tool]], piece: Workpiece) -> list[NDArray[np.float64]]:
    """Return the joint angles (n, 6) of an arm of a name at the points of each line [rad].

    Raises
    ------
    UserError
        Where there is no such arm, or it cannot follow a line; the message names the line and the point.
    """
    try:
        arm = arm_named(robot)
    except ValueError as error:
        raise UserError(str(error)) from None
    return [choose_branch(arm, flange_poses(line, piece), f"line {number}")[0] for number, line in enumerate(tools, 1)]
