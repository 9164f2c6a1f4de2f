"""Kinematic chain between two links: pose and Jacobian of its tip."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daidalos.common.arrays import Array
from daidalos.control.errors import ControlError, UnknownError
from daidalos.description.joint import JointType
from daidalos.description.kinematics import KinematicTree
from daidalos.description.robot import Robot
from daidalos.description.world import Model

_SLIDING = (JointType.PRISMATIC,)
_TURNING = (JointType.REVOLUTE, JointType.CONTINUOUS)


class Chain:
    """Kinematic chain between a base and a tip.

    Parameters
    ----------
    robot : Robot or Model
    base, tip : str
        Links; the tip hangs on the base.
    joints : sequence of n strings
        Those that move, in the order of positions; other joints stay at zero.

    Raises
    ------
    UnknownError
        When the robot has no such link or joint.
    ControlError
        When the tip does not hang on the base, or a joint cannot be moved.
    """

    def __init__(self, robot: Robot | Model, base: str, tip: str, joints: Sequence[str]) -> None:
        # In the simulation the world is no link of the model, and is where its fixed joints begin.
        outside = {joint.parent for joint in robot.joints.values()} - set(robot.links)
        for link in (base, tip):
            if link not in robot.links and link not in outside:
                raise UnknownError("link", link, robot.links)
        above = {joint.child: joint for joint in robot.joints.values()}
        path = []
        link = tip
        while link != base:
            if link not in above:
                raise ControlError(f"link '{tip}' does not hang on '{base}'")
            path.append(above[link].name)
            link = above[link].parent
        for name in joints:
            if name not in robot.joints:
                raise UnknownError("joint", name, robot.joints)
            if robot.joints[name].type not in _TURNING + _SLIDING or robot.joints[name].mimic is not None:
                raise ControlError(f"joint '{name}' cannot be moved by a controller")
        self._tree = KinematicTree(robot)
        count = len(self._tree.link_names)
        self._rows = {name: row for row, name in enumerate(self._tree.link_names)} | dict.fromkeys(outside, count)
        self._base, self._tip = self._rows[base], self._rows[tip]
        self._places = np.array([self._tree.index(name) for name in joints], dtype=np.intp)
        self._axes = [
            (self._rows[robot.joints[name].child], np.array(robot.joints[name].axis.xyz), robot.joints[name].type)
            if name in path
            else None
            for name in joints
        ]

    def _matrices(self, positions: Array) -> Array:
        full = np.zeros(len(self._tree.joint_names))
        full[self._places] = positions
        matrices = np.concatenate((self._tree.link_matrices(full), np.eye(4)[None]))
        base = matrices[self._base]
        inverse = np.eye(4)
        inverse[:3, :3], inverse[:3, 3] = base[:3, :3].T, -base[:3, :3].T @ base[:3, 3]
        moved: Array = inverse @ matrices
        return moved

    def pose(self, positions: Array, link: str | None = None) -> tuple[Array, Array]:
        """Return position (3,) [m] and rotation (3, 3) of a link (the tip where None) in the base."""
        matrix = self._matrices(positions)[self._tip if link is None else self.row(link)]
        return matrix[:3, 3], matrix[:3, :3]

    def row(self, link: str) -> int:
        """Return the index of a link; raises an error for an unknown name."""
        if link not in self._rows:
            raise UnknownError("link", link, self._rows)
        return self._rows[link]

    def jacobian(self, positions: Array) -> Array:
        """Return the tip's geometric Jacobian (6, n) in the base's axes: linear rows first."""
        matrices = self._matrices(positions)
        tip = matrices[self._tip][:3, 3]
        jacobian = np.zeros((6, len(self._axes)))
        for column, entry in enumerate(self._axes):
            if entry is None:
                continue
            row, axis, kind = entry
            direction = matrices[row][:3, :3] @ axis
            if kind in _SLIDING:
                jacobian[:3, column] = direction
            else:
                jacobian[:3, column] = np.cross(direction, tip - matrices[row][:3, 3])
                jacobian[3:, column] = direction
        return jacobian
