"""Paths of a robot with two arms that keep its links apart.

Straight paths move both tools in step, so that they may hold the same object. Free paths join two positions of the arms
by RRT-Connect (Kuffner and LaValle, 2000) where the straight line between the angles would bring links too close.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, interpolate
from daidalos.industry.motion.redundant_kinematics import forward_of, inverse_of
from daidalos.industry.motion.self_collision import closest_links, link_names
from daidalos.industry.robots.redundant import AXES, TwoArmedRobot

Array = NDArray[np.float64]

_STEP = 0.005
"""Greatest way of a tool between two points of a straight path [m]."""

_TURN = 0.05
"""Greatest turn of a tool between two points of a straight path [rad]."""

_JUMP = 0.5
"""Change of an angle between two points of a straight path that the arm cannot follow [rad]."""

_RESOLUTION = 0.05
"""Greatest change of an angle between two positions that are checked [rad]."""

_ROOM = 0.3
"""Distance from the end of an axis's range below which another solution is preferred [rad]."""

_EXTENSION = 0.4
_NODES = 3000
_ARM_ANGLES = 24


class TwoArmFault(ValueError):
    """Reason why the arms cannot make a movement."""


@dataclass(frozen=True)
class TimedPath:
    """A path of both arms over time, which begins and ends at rest.

    Attributes
    ----------
    times : array of shape (n,)
        [s], the first 0.
    positions, velocities : arrays of shape (n, 2, 7)
        [rad], [rad/s].
    """

    times: Array
    positions: Array
    velocities: Array


class TwoArms:
    """Planner of the movements of a robot with two arms.

    Parameters
    ----------
    robot : TwoArmedRobot
        The robot.
    tools : mapping of str to array (4, 4)
        Pose of each arm's tool in its tool0; tool0 itself where there is none.
    margin : float
        Least distance between links [m].
    seed : int
        Seed of the free paths, which are the same for the same seed.
    """

    def __init__(
        self,
        robot: TwoArmedRobot,
        tools: Mapping[str, Array] | None = None,
        margin: float = 0.005,
        seed: int = 1,
    ) -> None:
        if not (math.isfinite(margin) and margin >= 0.0):
            raise ValueError(f"the margin is {margin:g} m, but must be 0 or greater")
        self.robot = robot
        self.margin = margin
        self._sides = list(robot.bases)
        self._tools = {
            side: np.eye(4) if tools is None else np.asarray(tools.get(side, np.eye(4))) for side in self._sides
        }
        self._seed = seed

    def tool_poses(self, joints: Array) -> dict[str, Array]:
        """Return the poses of the tools in the body (4, 4), by side, at angles (2, 7) [rad]."""
        poses, _ = forward_of(self.robot.arm, joints)
        return {
            side: self.robot.side(side) @ pose @ self._tools[side]
            for side, pose in zip(self._sides, poses, strict=True)
        }

    def position_at(
        self, joints: Array, targets: Mapping[str, Array], then: Mapping[str, Array] | None = None
    ) -> Array:
        """Return angles (2, 7) with the tools at poses, as near to other angles as the links' distances allow.

        Parameters
        ----------
        joints : array of shape (2, 7)
            Present angles [rad]; an arm without a target keeps them.
        targets : mapping of str to array (4, 4)
            Poses of tools in the body, by side.
        then : mapping of str to array (4, 4) or None
            Poses to which the tools have to be able to go straight from there.

        Raises
        ------
        TwoArmFault
            Where a pose is out of reach, or links would be too close in every solution.
        """
        fault = TwoArmFault("")
        angles: Array
        for angles in self._candidates(joints, targets):
            try:
                if then is not None:
                    self.straight(angles, then)
            except TwoArmFault as reason:
                fault = reason
                continue
            return angles
        raise fault

    def _candidates(self, joints: Array, targets: Mapping[str, Array]) -> Array:
        """Return angles (n, 2, 7) with the tools at poses and the links apart, the best first."""
        found = [np.array(joints, dtype=np.float64)]
        for side, target in targets.items():
            number = self._number(side)
            choices = self._choices(side, target, joints[number])
            found = [_with_arm(one, number, choice) for one in found for choice in choices]
        candidates = np.array(found)
        apart = closest_links(self.robot, candidates).distances >= self.margin
        if not apart.any():
            raise TwoArmFault(f"links would be closer than {1e3 * self.margin:g} mm in every solution")
        costs = sum(self._cost(candidates[apart, k], joints[k]) for k in range(2))
        ordered: Array = candidates[apart][np.argsort(costs)]
        return ordered

    def _choices(self, side: str, target: Array, near: Array) -> Array:
        """Return angles (n, 7) of one arm with its tool at a pose, for arm angles all around."""
        flange = np.linalg.inv(self.robot.side(side)) @ target @ np.linalg.inv(self._tools[side])
        around = np.linspace(-math.pi, math.pi, _ARM_ANGLES, endpoint=False)
        poses = np.broadcast_to(flange, (_ARM_ANGLES, 4, 4))
        tilted = inverse_of(self.robot.arm, poses, around, near)
        every = np.concatenate([inverse_of(self.robot.arm, flange[None], None, near), tilted])
        reached = every[np.isfinite(every).all(axis=1)]
        if not len(reached):
            raise TwoArmFault(f"the {side} arm cannot reach {_place(target)}")
        best: Array = reached[np.argsort(self._cost(reached, near))][:8]
        return best

    def _cost(self, angles: Array, near: Array) -> Array:
        """Return how far angles (n, 7) are from others [rad], greater where an axis is close to its limit."""
        lower, upper = self.robot.arm.limits.T
        left = np.minimum(angles - lower, upper - angles).min(axis=1)
        cost: Array = np.abs(angles - near).max(axis=1) + 10.0 * np.maximum(_ROOM - left, 0.0)
        return cost

    def straight(self, joints: Array, targets: Mapping[str, Array]) -> Array:
        """Return a path (n, 2, 7) on which tools go straight to poses in the body, all in step.

        Raises
        ------
        TwoArmFault
            Where a point of it is out of reach or makes an arm jump, or links come too close.
        """
        start = {side: Pose.from_matrix(pose) for side, pose in self.tool_poses(joints).items() if side in targets}
        goal = {side: Pose.from_matrix(np.asarray(targets[side])) for side in start}
        for side in targets:
            self._number(side)
        count = max((_points(start[side], goal[side]) for side in start), default=1)
        path = np.repeat(np.asarray(joints, dtype=np.float64)[None], count + 1, axis=0)
        for n in range(1, count + 1):
            for side in start:
                number, pose = self._number(side), interpolate(start[side], goal[side], n / count).matrix
                flange = np.linalg.inv(self.robot.side(side)) @ pose @ np.linalg.inv(self._tools[side])
                angles = self._follow(flange, path[n - 1, number])
                if angles is None:
                    raise TwoArmFault(
                        f"the {side} arm cannot go straight to {_place(targets[side])}: not past {_place(pose)}"
                    )
                path[n, number] = angles
        self._check(path)
        return path

    def _follow(self, flange: Array, previous: Array) -> Array | None:
        """Return angles (7,) of one arm with its flange at a pose, a short way from others; None without any."""
        _, arm_angle = forward_of(self.robot.arm, previous)
        around = (arm_angle + np.radians([0.0, -3.0, 3.0, -8.0, 8.0]) + math.pi) % (2.0 * math.pi) - math.pi
        poses = np.broadcast_to(flange, (len(around), 4, 4))
        free = inverse_of(self.robot.arm, flange[None], None, previous)
        found = np.concatenate([inverse_of(self.robot.arm, poses, around, previous), free])
        with np.errstate(invalid="ignore"):
            close = found[np.abs(found - previous).max(axis=1) < _JUMP]
        return close[np.argmin(self._cost(close, previous))] if len(close) else None

    def free(self, start: Array, goal: Array) -> Array:
        """Return a path (n, 2, 7) from angles to others that keeps the links apart.

        Raises
        ------
        TwoArmFault
            Where links are too close at an end, or no path was found.
        """
        self._check(np.stack([start, goal]))
        if self._is_free(start.ravel(), goal.ravel()):
            return _dense(np.stack([start.ravel(), goal.ravel()])).reshape(-1, 2, AXES)
        nodes = self._connect(start.ravel(), goal.ravel())
        return _dense(self._shortened(nodes)).reshape(-1, 2, AXES)

    def timed(self, path: Array, share: float = 0.5) -> TimedPath:
        """Return a path (n, 2, 7) over time, as fast as a share of the axes' speeds allows.

        The way along the path is a polynomial of the fifth degree of the time, so that speed and acceleration are 0 at
        both ends. Angles that have the same change stay in step.
        """
        if not 0.0 < share <= 1.0:
            raise ValueError(f"the share of the speed is {share:g}, but must be above 0 and at most 1")
        changes = np.diff(path, axis=0)
        way = np.concatenate([[0.0], np.cumsum(np.abs(changes).max(axis=(1, 2)) + 1e-9)])
        along = way / way[-1] if way[-1] > 0.0 else way
        slopes: Array = np.zeros((len(path), 2 * AXES))
        if len(path) > 1:
            slopes[:] = np.gradient(path.reshape(len(path), -1), along, axis=0)
        speeds = np.tile(self.robot.arm.speeds, 2) * share
        duration = max(1.875 * float((np.abs(slopes) / speeds).max()), 0.1)
        times = np.linspace(0.0, duration, max(int(duration / 0.02) + 1, 2))
        u = times / duration
        s, rate = u**3 * (10.0 - 15.0 * u + 6.0 * u**2), 30.0 * u**2 * (1.0 - u) ** 2 / duration
        positions = _interpolated(s, along, path.reshape(len(path), -1))
        velocities = _interpolated(s, along, slopes) * rate[:, None]
        return TimedPath(times, positions.reshape(-1, 2, AXES), velocities.reshape(-1, 2, AXES))

    # Checks

    def _number(self, side: str) -> int:
        if side not in self._sides:
            raise TwoArmFault(f"{self.robot.title} has no arm '{side}', but {' and '.join(self._sides)}")
        return self._sides.index(side)

    def _check(self, path: Array) -> None:
        """Raise where links come closer than the margin."""
        closest = closest_links(self.robot, path)
        wrong = np.flatnonzero(~(closest.distances >= self.margin))
        if len(wrong):
            first, second = (link_names(self.robot)[k] for k in closest.pairs[wrong[0]])
            share = 100.0 * wrong[0] / max(len(path) - 1, 1)
            distance = 1e3 * closest.distances[wrong[0]]
            raise TwoArmFault(f"{first} comes within {distance:.0f} mm of {second} after {share:.0f} % of the way")

    def _is_free(self, start: Array, goal: Array) -> bool:
        between = _dense(np.stack([start, goal])).reshape(-1, 2, AXES)
        return bool((closest_links(self.robot, between).distances >= self.margin).all())

    # RRT-Connect

    def _connect(self, start: Array, goal: Array) -> Array:
        """Return corners (n, 14) of a path from angles (14,) to others."""
        moving = np.abs(goal - start) > 0.0
        limits = np.tile(self.robot.arm.limits, (2, 1))
        random = np.random.default_rng(self._seed)
        trees = [_Tree(start), _Tree(goal)]
        for turn in range(_NODES):
            grown, other = trees[turn % 2], trees[1 - turn % 2]
            aim = np.where(moving, random.uniform(*limits.T), start)
            new = self._extend(grown, aim)
            if new is None:
                continue
            reached = new
            while (step := self._extend(other, grown.points[new])) is not None:
                reached = step
                if np.abs(other.points[step] - grown.points[new]).max() < 1e-9:
                    paths = grown.way(new), other.way(reached)
                    first, second = paths if turn % 2 == 0 else paths[::-1]
                    return np.array([*first, *second[::-1]])
        raise TwoArmFault(f"no path that keeps the links {1e3 * self.margin:g} mm apart was found")

    def _extend(self, tree: _Tree, aim: Array) -> int | None:
        """Add a point towards another one; return its number, or None where links are in the way."""
        near = tree.nearest(aim)
        change = aim - tree.points[near]
        far = float(np.abs(change).max())
        if far == 0.0:
            return None
        point = aim if far <= _EXTENSION else tree.points[near] + change * (_EXTENSION / far)
        return tree.add(point, near) if self._is_free(tree.points[near], point) else None

    def _shortened(self, corners: Array) -> Array:
        """Return corners of a path without those that can be left out."""
        kept = [corners[0]]
        place = 0
        while place < len(corners) - 1:
            place = next(
                n for n in range(len(corners) - 1, place, -1) if n == place + 1 or self._is_free(kept[-1], corners[n])
            )
            kept.append(corners[place])
        return np.array(kept)


class _Tree:
    """Points that were reached from a first one."""

    def __init__(self, root: Array) -> None:
        self.points = [root]
        self._from = [0]

    def add(self, point: Array, origin: int) -> int:
        self.points.append(point)
        self._from.append(origin)
        return len(self.points) - 1

    def nearest(self, point: Array) -> int:
        return int(np.argmin(np.abs(np.array(self.points) - point).max(axis=1)))

    def way(self, number: int) -> list[Array]:
        """Return the points from the first one to another."""
        points = [self.points[number]]
        while number:
            number = self._from[number]
            points.append(self.points[number])
        return points[::-1]


def _with_arm(joints: Array, number: int, angles: Array) -> Array:
    changed = joints.copy()
    changed[number] = angles
    return changed


def _interpolated(places: Array, along: Array, values: Array) -> Array:
    """Return values (n, m) at places along a path, as (len(places), m)."""
    return np.stack([np.interp(places, along, column) for column in values.T], axis=1)


def _points(start: Pose, goal: Pose) -> int:
    """Return into how many pieces a straight path is cut."""
    turn = 2.0 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(start.orientation, goal.orientation, strict=True)))))
    return max(math.ceil(math.dist(start.position, goal.position) / _STEP), math.ceil(turn / _TURN), 1)


def _dense(corners: Array) -> Array:
    """Return a path (n, 14) with points at most `_RESOLUTION` apart."""
    pieces = [corners[:1]]
    for start, end in pairwise(corners):
        count = max(math.ceil(np.abs(end - start).max() / _RESOLUTION), 1)
        pieces.append(start + (end - start) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(pieces)


def _place(pose: Array) -> str:
    x, y, z = 1e3 * np.asarray(pose)[:3, 3]
    return f"({x:.0f}, {y:.0f}, {z:.0f}) mm"
