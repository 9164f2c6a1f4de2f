"""Forward kinematics on arrays: joint positions in, poses of links out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.joint import Joint, JointType
from daidalos.description.robot import Robot
from daidalos.description.world import Model

_TURNING = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.SCREW)
_SLIDING = (JointType.PRISMATIC,)
_NEXT, _LAST = np.array((1, 2, 0)), np.array((2, 0, 1))


class UnknownJointError(KeyError):
    """Unknown joint name; the message lists the known ones."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        super().__init__(name)
        self.name = name
        self.known = tuple(known)

    def __str__(self) -> str:
        return f"joint {self.name!r} is not in the robot; movable are {', '.join(self.known) or 'none'}"


@dataclass(frozen=True)
class _Motion:
    """Index of the position that moves each joint k, with its rotation and translation per unit."""

    position_index: NDArray[np.intp]
    multiplier: Array
    offset: Array
    turn: Array
    slide: Array

    def of(self, rows: NDArray[np.intp]) -> _Motion:
        """Return the motion of some of the joints."""
        return _Motion(*(getattr(self, field.name)[rows] for field in fields(self)))


class KinematicTree:
    """Joints of a robot as arrays, ordered so that parents come before children.

    Parameters
    ----------
    robot : Robot or Model
        Joints that close a loop (a model's link that has a parent already) are left out. Floating,
        planar and ball joints, and the second axis of joints that have two, stay at zero.

    Attributes
    ----------
    joint_names : tuple of str
        The n independent joints, in the order of the robot; mimic joints follow theirs.
    link_names : tuple of str
        The m links, roots first.
    parents, children, transform_joints : tuples of str
        Of each of the k joints, for its transform: parent link, child link, joint name.
    moving : array (k,) of bool
        Whether a joint's transform depends on the positions.
    drivers : array (k,) of int
        The position that moves a joint; n for those that none moves.
    floating : array (k,) of bool
        Whether a joint holds its child nowhere.
    """

    def __init__(self, robot: Robot | Model) -> None:
        joints = _ordered(robot)
        self.transform_joints = tuple(joint.name for joint in joints)
        self.parents = tuple(joint.parent for joint in joints)
        self.children = tuple(joint.child for joint in joints)
        placed = set(self.transform_joints)
        independent = [
            joint
            for joint in robot.joints.values()
            if joint.name in placed and joint.mimic is None and joint.type in _TURNING + _SLIDING
        ]
        self.joint_names = tuple(joint.name for joint in independent)
        roots = [name for name in robot.links if name not in set(self.children)]
        self.link_names = (*roots, *self.children)
        self._roots = _PoseArray.of([robot.links[name].pose for name in roots])
        self._index = {name: i for i, name in enumerate(self.joint_names)}
        self._motion = _motion(joints, robot.joints, self._index)
        self.moving = np.any(self._motion.turn != 0, axis=1) | np.any(self._motion.slide != 0, axis=1)
        self.drivers = np.where(self.moving, self._motion.position_index, len(self.joint_names))
        self.floating = np.array([joint.type is JointType.FLOATING for joint in joints], dtype=bool)
        self._origin = _PoseArray.of([joint.origin for joint in joints])
        self._anchor_inverse = _PoseArray.of([joint.anchor.inverse for joint in joints])
        self._anchored = any(joint.anchor != Pose() for joint in joints)
        row = {name: i for i, name in enumerate(self.link_names)}
        self._parent_rows = np.array(
            [*range(len(roots)), *(row.get(parent, -1) for parent in self.parents)], dtype=np.intp
        )
        self._root_count = len(roots)

    def index(self, joint: str) -> int:
        """Return a joint's index in the positions.

        Raises
        ------
        UnknownJointError
            When it is not an independent joint of the robot.
        """
        try:
            return self._index[joint]
        except KeyError:
            raise UnknownJointError(joint, self.joint_names) from None

    def positions(self, values: Mapping[str, float]) -> Array:
        """Return positions (n,) with the named joints set and the others at zero."""
        positions = np.zeros(len(self.joint_names))
        for name, value in values.items():
            positions[self.index(name)] = value
        return positions

    def joint_transforms(self, positions: Array, rows: NDArray[np.intp] | None = None) -> tuple[Array, Array]:
        """Return child links' poses in their parent links.

        Parameters
        ----------
        positions : array (n,)
            Of the independent joints [rad, m].
        rows : array (r,) of int, optional
            Places of the joints that are asked for; all k where None.

        Returns
        -------
        translations : array (r, 3)
            [m].
        rotations : array (r, 4)
            Quaternions x, y, z, w.
        """
        motion, origin, anchor_inverse = self._motion, self._origin, self._anchor_inverse
        if rows is not None:
            motion, origin, anchor_inverse = motion.of(rows), origin.rows(rows), anchor_inverse.rows(rows)
        followed = np.append(np.asarray(positions, dtype=np.float64), 0.0)[motion.position_index]
        q = motion.multiplier * followed + motion.offset
        half = 0.5 * q[:, None] * motion.turn
        angle = np.linalg.norm(half, axis=1, keepdims=True)
        turned = np.concatenate((half * np.sinc(angle / np.pi), np.cos(angle)), axis=1)
        poses = _compose(origin, _PoseArray(q[:, None] * motion.slide, turned))
        if self._anchored:
            poses = _compose(poses, anchor_inverse)
        return poses.translations, poses.rotations

    def link_poses(self, positions: Array) -> tuple[Array, Array]:
        """Return the pose of every link in the robot's frame.

        Parameters
        ----------
        positions : array (n,)
            Of the independent joints [rad, m].

        Returns
        -------
        translations : array (m, 3)
            [m], in the order of `link_names`.
        rotations : array (m, 4)
            Quaternions x, y, z, w.
        """
        translations, rotations = self.joint_transforms(positions)
        poses = _PoseArray(
            np.concatenate((self._roots.translations, translations)),
            np.concatenate((self._roots.rotations, rotations)),
        )
        return _to_root(poses, self._parent_rows, self._root_count)

    def link_matrices(self, positions: Array) -> Array:
        """Return the pose of every link in the robot's frame as homogeneous matrices (m, 4, 4)."""
        translations, rotations = self.link_poses(positions)
        matrices = np.zeros((len(translations), 4, 4))
        x, y, z, w = rotations.T
        matrices[:, 0, 0], matrices[:, 0, 1], matrices[:, 0, 2] = (
            1 - 2 * (y * y + z * z),
            2 * (x * y - z * w),
            2 * (x * z + y * w),
        )
        matrices[:, 1, 0], matrices[:, 1, 1], matrices[:, 1, 2] = (
            2 * (x * y + z * w),
            1 - 2 * (x * x + z * z),
            2 * (y * z - x * w),
        )
        matrices[:, 2, 0], matrices[:, 2, 1], matrices[:, 2, 2] = (
            2 * (x * z - y * w),
            2 * (y * z + x * w),
            1 - 2 * (x * x + y * y),
        )
        matrices[:, :3, 3] = translations
        matrices[:, 3, 3] = 1.0
        return matrices


def link_poses_at_zero(robot: Robot) -> dict[str, Pose]:
    """Return each link's pose in the root link with every joint at zero, by name."""
    poses = {robot.root: Pose()}
    for joint in _ordered(robot):
        poses[joint.child] = poses[joint.parent] @ joint.origin @ joint.anchor.inverse
    return poses


@dataclass(frozen=True)
class _PoseArray:
    translations: Array
    rotations: Array

    @classmethod
    def of(cls, poses: Sequence[Pose]) -> _PoseArray:
        return cls(
            np.array([pose.position for pose in poses], dtype=np.float64).reshape(-1, 3),
            np.array([pose.orientation for pose in poses], dtype=np.float64).reshape(-1, 4),
        )

    def rows(self, rows: NDArray[np.intp]) -> _PoseArray:
        return _PoseArray(self.translations[rows], self.rotations[rows])


def _compose(left: _PoseArray, right: _PoseArray) -> _PoseArray:
    axis, w = left.rotations[:, :3], left.rotations[:, 3:]
    twice = 2 * _cross(axis, right.translations)
    moved = right.translations + w * twice + _cross(axis, twice) + left.translations
    other, v = right.rotations[:, :3], right.rotations[:, 3:]
    vector = w * other + v * axis + _cross(axis, other)
    scalar = w * v - np.sum(axis * other, axis=1, keepdims=True)
    return _PoseArray(moved, np.concatenate((vector, scalar), axis=1))


def _cross(left: Array, right: Array) -> Array:
    """Return the cross products of rows; numpy's own takes longer for a few rows."""
    product: Array = left[:, _NEXT] * right[:, _LAST] - left[:, _LAST] * right[:, _NEXT]
    return product


def _to_root(poses: _PoseArray, parents: NDArray[np.intp], roots: int) -> tuple[Array, Array]:
    """Compose each pose with its ancestors by pointer jumping: log2(depth) rounds over whole arrays."""
    translations, rotations = poses.translations.copy(), poses.rotations.copy()
    parents = parents.copy()
    waiting = np.arange(roots, len(parents))
    waiting = waiting[parents[waiting] >= 0]
    while waiting.size:
        above = parents[waiting]
        composed = _compose(
            _PoseArray(translations[above], rotations[above]),
            _PoseArray(translations[waiting], rotations[waiting]),
        )
        done = above < roots
        translations[waiting], rotations[waiting] = composed.translations, composed.rotations
        parents[waiting] = np.where(done, -1, parents[above])
        waiting = waiting[parents[waiting] >= 0]
    return translations, rotations


def _ordered(robot: Robot | Model) -> list[Joint]:
    """Return the joints that form the tree, parents first, level by level in file order."""
    by_parent: dict[str, list[Joint]] = {}
    has_parent: set[str] = set()
    for joint in robot.joints.values():
        if joint.child not in has_parent and joint.type is not JointType.GEARBOX:
            has_parent.add(joint.child)
            by_parent.setdefault(joint.parent, []).append(joint)
    level = [name for name in robot.links if name not in has_parent]
    level += [name for name in by_parent if name not in robot.links]
    ordered: list[Joint] = []
    while level:
        found = [joint for name in level for joint in by_parent.get(name, ())]
        ordered += found
        level = [joint.child for joint in found]
    return ordered


def _motion(joints: Iterable[Joint], by_name: Mapping[str, Joint], index: Mapping[str, int]) -> _Motion:
    rows = [_follow(joint, by_name) for joint in joints]
    joints = list(joints)
    free = len(index)  # the extra position that is always zero
    return _Motion(
        position_index=np.array([index.get(name, free) for name, _, _ in rows], dtype=np.intp),
        multiplier=np.array([multiplier for _, multiplier, _ in rows], dtype=np.float64),
        offset=np.array([offset for _, _, offset in rows], dtype=np.float64),
        turn=np.array([_turn(joint) for joint in joints], dtype=np.float64).reshape(-1, 3),
        slide=np.array([_slide(joint) for joint in joints], dtype=np.float64).reshape(-1, 3),
    )


def _follow(joint: Joint, by_name: Mapping[str, Joint]) -> tuple[str, float, float]:
    """Return the independent joint at the end of a chain of mimics, and the factor and offset to it."""
    multiplier, offset = 1.0, 0.0
    seen = {joint.name}
    while joint.mimic is not None:
        offset += multiplier * joint.mimic.offset
        multiplier *= joint.mimic.multiplier
        joint = by_name[joint.mimic.joint]
        if joint.name in seen:
            return "", 0.0, 0.0
        seen.add(joint.name)
    return joint.name, multiplier, offset


def _turn(joint: Joint) -> tuple[float, float, float]:
    return joint.axis.xyz if joint.type in _TURNING else (0.0, 0.0, 0.0)


def _slide(joint: Joint) -> tuple[float, float, float]:
    if joint.type is JointType.SCREW:
        x, y, z = joint.axis.xyz
        return x * joint.thread_pitch, y * joint.thread_pitch, z * joint.thread_pitch
    return joint.axis.xyz if joint.type in _SLIDING else (0.0, 0.0, 0.0)
