"""The seam between a program and what moves: a small protocol, and a robot that needs nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Protocol

from daidalos.industry.rapid.runtime.poses import IDENTITY, Pose, angle_between, pose_inverse, pose_product


@dataclass(frozen=True)
class Move:
    r"""A movement as an instruction orders it; all data is in RAPID's form and units (mm, degrees, mm/s).

    Attributes
    ----------
    instruction
        Its name, such as ``MoveL``.
    target
        A robtarget, or a jointtarget for MoveAbsJ and MoveExtJ.
    via
        The robtarget on the circle of MoveC, else None.
    speed, zone, tool, wobj
        speeddata with what ``\V`` says, zonedata, tooldata and wobjdata.
    duration
        What ``\T`` says, in seconds; None without it.
    line
        ``file:line`` of the instruction.
    """

    instruction: str
    target: list[Any]
    speed: list[float]
    zone: list[Any]
    tool: list[Any]
    wobj: list[Any]
    via: list[Any] | None = None
    duration: float | None = None
    line: str = ""

    def tool_pose(self) -> Pose:
        """Return the pose of the tool's centre point in the base frame at the target, mm."""
        return pose_product(wobj_pose(self.wobj), [self.target[0], self.target[1]])


class Robot(Protocol):
    """What carries out movements.

    Each method returns the time in seconds that the movement takes, and raises `RapidError` or `FatalError` where it
    cannot be done. A planner that looks ahead may return 0 and move later; `wait_in_position` returns what is left.
    """

    def move_l(self, move: Move) -> float:
        """Move along a line."""
        ...

    def move_j(self, move: Move) -> float:
        """Move by the joints to a pose."""
        ...

    def move_c(self, move: Move) -> float:
        """Move along a circle."""
        ...

    def move_abs_j(self, move: Move) -> float:
        """Move to joint positions."""
        ...

    def wait_in_position(self) -> float:
        """Wait until the robot stands."""
        ...

    def tool_pose(self) -> Pose:
        """Return the pose of the flange in the base frame, mm."""
        ...

    def robtarget(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where the robot is."""
        ...

    def jointtarget(self) -> list[Any]:
        """Return where its joints are."""
        ...


@dataclass
class SimpleRobot:
    """Robot without joints or limits: it is where it was sent, after distance divided by speed.

    Attributes
    ----------
    moves
        All movements so far.
    """

    moves: list[Move] = field(default_factory=list)
    _flange: Pose = field(default_factory=lambda: [list(IDENTITY[0]), list(IDENTITY[1])])
    _configuration: list[float] = field(default_factory=lambda: [0.0] * 4)
    _external: list[float] = field(default_factory=lambda: [9e9] * 6)
    _joints: list[Any] = field(default_factory=lambda: [[0.0] * 6, [9e9] * 6])

    def move_l(self, move: Move) -> float:
        """Move along a line."""
        goal = move.tool_pose()
        start = pose_product(self._flange, move.tool[1])
        return self._arrive(move, goal, math.dist(start[0], goal[0]), angle_between(start[1], goal[1]))

    move_j = move_l

    def move_c(self, move: Move) -> float:
        """Move along a circle, through the point between."""
        goal = move.tool_pose()
        start = pose_product(self._flange, move.tool[1])
        assert move.via is not None
        via = pose_product(wobj_pose(move.wobj), [move.via[0], move.via[1]])
        length = arc_length(start[0], via[0], goal[0])
        return self._arrive(move, goal, length, angle_between(start[1], goal[1]))

    def move_abs_j(self, move: Move) -> float:
        """Move to joint positions, at the speed of reorientation."""
        before, after = self._joints[0], move.target[0]
        self._joints = [list(after), list(move.target[1])]
        turned = max(abs(b - a) for a, b in zip(before, after, strict=True))
        self.moves.append(move)
        return move.duration if move.duration is not None else _share(turned, move.speed[1])

    def wait_in_position(self) -> float:
        """Return 0: each movement is done when its instruction ends."""
        return 0.0

    def tool_pose(self) -> Pose:
        """Return the pose of the flange in the base frame, mm."""
        return self._flange

    def robtarget(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where the robot is, after the latest movement to a robtarget."""
        at = pose_product(pose_inverse(wobj_pose(wobj)), pose_product(self._flange, tool[1]))
        return [at[0], at[1], list(self._configuration), list(self._external)]

    def jointtarget(self) -> list[Any]:
        """Return the joint positions of the latest movement by joints."""
        return [list(self._joints[0]), list(self._joints[1])]

    def _arrive(self, move: Move, goal: Pose, length: float, angle: float) -> float:
        self._flange = pose_product(goal, pose_inverse(move.tool[1]))
        self._configuration, self._external = list(move.target[2]), list(move.target[3])
        self.moves.append(move)
        if move.duration is not None:
            return move.duration
        return max(_share(length, move.speed[0]), _share(angle, move.speed[1]))


def _share(way: float, speed: float) -> float:
    return way / speed if speed > 0 else 0.0


def wobj_pose(wobj: list[Any]) -> Pose:
    """Return the pose of a work object's object frame in the base frame, mm."""
    return pose_product(wobj[3], wobj[4])


def arc_length(a: list[float], b: list[float], c: list[float]) -> float:
    """Return the length of the circle's arc from a through b to c; that of the lines where they are on one."""
    ab, bc, ac = math.dist(a, b), math.dist(b, c), math.dist(a, c)
    half = (ab + bc + ac) / 2
    area = math.sqrt(max(half * (half - ab) * (half - bc) * (half - ac), 0.0))
    if area < 1e-9 * max(ac, 1.0):
        return ab + bc
    radius = ab * bc * ac / (4 * area)
    return radius * (2 * math.asin(min(ab / (2 * radius), 1.0)) + 2 * math.asin(min(bc / (2 * radius), 1.0)))
