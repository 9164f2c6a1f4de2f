"""The seam between a program and what moves: a small protocol, and a robot that needs nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from daidalos.industry.rapid.runtime.errors import FatalError
from daidalos.industry.rapid.runtime.poses import IDENTITY, Pose, angle_between, pose_inverse, pose_product


@dataclass(frozen=True)
class MotionSettings:
    r"""What instructions such as AccSet and ConfL have said about the movements that follow.

    Attributes
    ----------
    acceleration, ramp
        Shares of the acceleration and of its rate of change, 0 to 1 (AccSet).
    path_acceleration
        Greatest acceleration along the path [m/s^2] (PathAccLim).
    checks_line, checks_joint
        Whether the configuration of a target has to be met (ConfL, ConfJ).
    turns_wrist
        Whether a wrist singularity may be passed by turning the tool (SingArea \Wrist).
    circle
        How the tool turns on a circle (CirPathMode): ``path``, ``object`` or ``point``.
    greatest_speed
        Greatest speed of the tool [mm/s], whatever the instruction says: that of manual mode.
    """

    acceleration: float = 1.0
    ramp: float = 1.0
    path_acceleration: float = math.inf
    checks_line: bool = True
    checks_joint: bool = True
    turns_wrist: bool = False
    circle: Literal["path", "object", "point"] = "path"
    greatest_speed: float = math.inf


@dataclass(frozen=True)
class Event:
    """What happens at a place of a movement.

    Attributes
    ----------
    action
        What to do.
    distance
        From the movement's end, mm.
    is_from_start
        Whether the distance is from its beginning.
    time_before
        Seconds before that place.
    """

    action: Callable[[], Any]
    distance: float = 0.0
    is_from_start: bool = False
    time_before: float = 0.0


@dataclass(frozen=True)
class Move:
    r"""A movement as an instruction orders it; all data is in RAPID's form and units (mm, degrees, mm/s).

    Attributes
    ----------
    instruction
        ``MoveL``, ``MoveJ``, ``MoveC`` or ``MoveAbsJ``.
    target
        A robtarget, or a jointtarget for MoveAbsJ.
    via
        The robtarget on the circle of MoveC, else None.
    speed, zone, tool, wobj
        speeddata with what ``\V`` and VelSet say, zonedata, tooldata and wobjdata.
    duration
        What ``\T`` says, in seconds; None without it.
    line
        ``file:line`` of the instruction.
    settings
        What holds for it besides.
    events
        What happens on the way.
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
    settings: MotionSettings = MotionSettings()
    events: tuple[Event, ...] = ()

    def tool_pose(self) -> Pose:
        """Return the pose of the tool's centre point in the base frame at the target, mm."""
        return pose_product(wobj_pose(self.wobj), [self.target[0], self.target[1]])


class Robot(Protocol):
    """What carries out movements while time passes, which only `advance` lets it do; times are in seconds."""

    @property
    def title(self) -> str:
        """Return the maker's name of it."""
        ...

    @property
    def count(self) -> int:
        """Return how many movements were taken."""
        ...

    def order(self, move: Move) -> bool:
        """Take a movement; return False, with nothing taken, where the robot has to stand first.

        Raises
        ------
        RapidError, FatalError
            Where the movement cannot be done.
        """
        ...

    def room(self) -> float:
        """Return how long the program has to wait before it may order more; infinity while the robot is stopped."""
        ...

    def lead(self) -> float:
        """Return the time until instructions behind the latest movement run: at its end, or at its corner path."""
        ...

    def remaining(self) -> float:
        """Return the time until the robot stands in the latest target; infinity while it is stopped."""
        ...

    def advance(self, seconds: float) -> None:
        """Advance time."""
        ...

    def next_event(self) -> float | None:
        """Return the time until the next event on the path; None where there is none."""
        ...

    def serve(self) -> None:
        """Do what is due."""
        ...

    def stop(self) -> float:
        """Stop on the path, and return how long that takes."""
        ...

    def resume(self) -> None:
        """Go on after a stop."""
        ...

    def clear(self) -> None:
        """Forget the rest of the path, where the robot stands."""
        ...

    def stretch(self, seconds: float) -> None:
        """Make the movement that begins now take so long, where it would take less."""
        ...

    def follow(self, leader: Robot) -> float:
        """Move in proportion to another robot, whose movement begins now too and takes longer.

        Returns
        -------
        float
            By how much both have to be slowed, 1 or more.
        """
        ...

    def robtarget(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where the robot is."""
        ...

    def jointtarget(self) -> list[Any]:
        """Return where its joints are."""
        ...

    def target_of(self, joints: list[Any], tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return the robtarget of a jointtarget."""
        ...

    def joints_of(self, target: list[Any], tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return the jointtarget of a robtarget.

        Raises
        ------
        RapidError
            ERR_ROBLIMIT, where it is out of reach.
        """
        ...

    def store(self) -> None:
        """Keep the rest of the path on which the robot is stopped, and forget it."""
        ...

    def restore(self) -> None:
        """Take up the rest of the path that was kept latest."""
        ...

    def watch(self, look: Callable[[], None]) -> None:
        """Call a function again and again while the robot moves."""
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
    _left: float = 0.0
    _events: list[tuple[float, Event]] = field(default_factory=list)
    _is_stopped: bool = False
    _kept: list[tuple[float, list[tuple[float, Event]]]] = field(default_factory=list)
    _watchers: list[Callable[[], None]] = field(default_factory=list)

    @property
    def title(self) -> str:
        """Return that it is none of a maker."""
        return "robot without joints"

    @property
    def count(self) -> int:
        """Return how many movements were taken."""
        return len(self.moves)

    def order(self, move: Move) -> bool:
        """Take a movement, where none is under way."""
        if self._left > 0.0:
            return False
        if move.instruction == "MoveAbsJ":
            length, angle = self._turn(move)
        else:
            length, angle = self._arrive(move)
        self.moves.append(move)
        self._left = max(_share(length, move.speed[0]), _share(angle, move.speed[1]))
        if move.duration is not None:
            self._left = max(move.duration, _share(length, move.settings.greatest_speed))
        speed = length / self._left if self._left > 0.0 else math.inf
        for event in move.events:
            before = length - event.distance if event.is_from_start else event.distance
            self._events.append((min(max(before / speed + event.time_before, 0.0), self._left), event))
        return True

    def room(self) -> float:
        """Return the time that is left of the movement: there is no look-ahead."""
        return self.remaining()

    lead = room

    def remaining(self) -> float:
        """Return the time that is left of the movement."""
        return math.inf if self._is_stopped and self._left > 0.0 else self._left

    def advance(self, seconds: float) -> None:
        """Advance time."""
        if not self._is_stopped:
            self._left = self._left - seconds if self._left - seconds > 1e-12 else 0.0

    def next_event(self) -> float | None:
        """Return the time until the next event."""
        if self._is_stopped or not self._events:
            return None
        return max(self._left - max(before for before, _ in self._events), 0.0)

    def serve(self) -> None:
        """Do what is due."""
        for look in self._watchers:
            look()
        due = [one for one in self._events if self._left <= one[0] + 1e-9]
        self._events = [one for one in self._events if one not in due]
        for _, event in sorted(due, key=lambda one: -one[0]):
            event.action()

    def stop(self) -> float:
        """Stop at once."""
        self._is_stopped = True
        return 0.0

    def resume(self) -> None:
        """Go on."""
        self._is_stopped = False

    def stretch(self, seconds: float) -> None:
        """Make the movement that begins now take so long."""
        if 0.0 < self._left < seconds:
            self._events = [(before * seconds / self._left, one) for before, one in self._events]
            self._left = seconds

    def follow(self, leader: Robot) -> float:
        """Take as long as another robot."""
        self.stretch(leader.remaining())
        return 1.0

    def clear(self) -> None:
        """Forget the rest of the movement."""
        self._left, self._events = 0.0, []

    def robtarget(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where the robot is, after the latest movement to a robtarget."""
        at = pose_product(pose_inverse(wobj_pose(wobj)), pose_product(self._flange, tool[1]))
        return [at[0], at[1], list(self._configuration), list(self._external)]

    def jointtarget(self) -> list[Any]:
        """Return the joint positions of the latest movement by joints."""
        return [list(self._joints[0]), list(self._joints[1])]

    def target_of(self, joints: list[Any], tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Refuse: there are no joints."""
        raise FatalError("the robtarget of angles needs an arm, such as --robot irb120")

    joints_of = target_of

    def store(self) -> None:
        """Keep the rest of the movement."""
        self._kept.append((self._left, self._events))
        self.clear()

    def restore(self) -> None:
        """Take up the rest of the movement."""
        if not self._kept:
            raise FatalError("there is no path to restore; StorePath comes first")
        self._left, self._events = self._kept.pop()

    def watch(self, look: Callable[[], None]) -> None:
        """Call a function whenever time has passed."""
        self._watchers.append(look)

    def _turn(self, move: Move) -> tuple[float, float]:
        before, after = self._joints[0], move.target[0]
        self._joints = [list(after), list(move.target[1])]
        return 0.0, max(abs(b - a) for a, b in zip(before, after, strict=True))

    def _arrive(self, move: Move) -> tuple[float, float]:
        """Go to a target, and return the length and the angle of the way."""
        goal = move.tool_pose()
        start = pose_product(self._flange, move.tool[1])
        length = math.dist(start[0], goal[0])
        if move.via is not None:
            via = pose_product(wobj_pose(move.wobj), [move.via[0], move.via[1]])
            length = arc_length(start[0], via[0], goal[0])
        self._flange = pose_product(goal, pose_inverse(move.tool[1]))
        self._configuration, self._external = list(move.target[2]), list(move.target[3])
        return length, angle_between(start[1], goal[1])


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
