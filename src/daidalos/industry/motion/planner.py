"""Motion of an arm along a path that grows while the arm moves.

Movements are appended one by one, with a look-ahead: the plan always ends at rest in the latest point, and is made
anew when another movement follows, from where the arm is. Time passes only in `Planner.advance`. The same calls give
the same motion, bit for bit.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.motion.corners import JointCorner, PoseCorner, Zone, reduced
from daidalos.industry.motion.curves import SHORTEST, Curve, JointCurve
from daidalos.industry.motion.faults import CORNER_PATH, SINGULARITY, MotionFault
from daidalos.industry.motion.orientations import Array
from daidalos.industry.motion.pieces import (
    Limits,
    Piece,
    Sampled,
    piece_between,
    sample_curve,
    sample_joint_path,
    sample_tool_path,
)
from daidalos.industry.motion.profile import Profile
from daidalos.industry.motion.timing_kernels import greatest_speeds, refine, stopping_speeds
from daidalos.industry.robots import Arm

_CORRECTIONS = 12
_TOLERANCE = 1.01
_EASE = 0.7
"""Exponent with which limits are lowered where they are exceeded: small ones find faster motions, in more steps."""

_MEASURE_STEP = 0.002
_MOST_MEASURED = 4000
_FOLLOW_SAMPLES = 1000
_END = 1e18
_TICK = 1e-9
"""Time below which there is none left [s]."""

_MEETS = 1e-5
_NEAR_RANGE = math.radians(2.0)
_ROWS = ("s", "first", "second", "accelerations")


@dataclass
class Movement:
    """A movement as it is appended.

    Attributes
    ----------
    curve : Line, Circle or JointCurve
        Its geometry, without corner paths.
    limits : Limits
        Its limits.
    zone : Zone or None
        Corner path at its end; None for a stop.
    tool : array of shape (4, 4)
        The tool on the flange.
    label : str
        Where it was programmed.
    sampled : Sampled, optional
        Its angles, where they are known already.
    blends_joints : bool
        Whether its corner paths are those of the angles, as those of joint movements are.
    offset : float
        Where it begins on the whole path [m].
    """

    curve: Curve
    limits: Limits
    zone: Zone | None
    tool: Array
    label: str = ""
    sampled: Sampled | None = None
    blends_joints: bool = False
    offset: float = 0.0

    @property
    def end(self) -> float:
        """Return where its end is on the whole path [m]."""
        return self.offset + self.curve.length


@dataclass(frozen=True)
class CornerReport:
    """A corner path as it became.

    Attributes
    ----------
    label : str
        Movement whose end it rounds.
    wanted, distance : float
        Distances of its beginning from the point: programmed, and after reduction [m].
    deviation : float
        Least distance of the path from the point [m].
    position : array of shape (3,)
        The point [m].
    """

    label: str
    wanted: float
    distance: float
    deviation: float
    position: Array


@dataclass(frozen=True)
class PathRest:
    """The rest of a path that an arm has left while it was stopped on it.

    Attributes
    ----------
    joints : array of shape (6,)
        Angles where it was left [rad].
    position : float
        Where that is on the path [m].
    movements, pieces, length
        The path.
    ramp_time : float
        Length of the mean of its motion [s].
    """

    joints: Array
    position: float
    movements: list[Movement]
    pieces: list[Piece]
    length: float
    ramp_time: float


@dataclass
class Planner:
    """An arm in motion.

    Attributes
    ----------
    arm : Arm
        The arm.
    joints : array of shape (6,)
        Angles at rest [rad].
    now : float
        Time [s].
    is_stopped : bool
        Whether the arm rests, or comes to rest, on its path until `resume`.
    version : int
        Counts the plans that were made.
    corners : list of CornerReport
        All corner paths so far.
    warnings : list of str
        What happened that does not end a program.
    """

    arm: Arm
    joints: Array
    now: float = 0.0
    is_stopped: bool = False
    version: int = 0
    corners: list[CornerReport] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    _movements: list[Movement] = field(default_factory=list)
    _pieces: list[Piece] = field(default_factory=list)
    _profile: Profile | None = None
    _length: float = 0.0
    _is_planned: bool = True
    _free: float = 0.0

    # Appending

    @property
    def end_joints(self) -> Array:
        """Return the angles at the end of the path (6,) [rad]."""
        if not self._movements:
            return self.joints
        latest = self._movements[-1]
        assert latest.sampled is not None
        return np.asarray(latest.sampled.joints[-1])

    @property
    def is_at_rest(self) -> bool:
        """Return whether nothing is left to do."""
        return not self._movements

    @property
    def waiting(self) -> int:
        """Return how many movements have not been passed yet."""
        position = self._position_before_mean()
        return sum(one.end > position for one in self._movements)

    def append(self, movement: Movement) -> bool:
        """Append a movement; return False, with nothing appended, where the arm has to come to rest first.

        Raises
        ------
        MotionFault
            Where the movement cannot be carried out.
        """
        if movement.curve.length < SHORTEST:
            return self._finish_at_point(movement)
        if movement.sampled is None:
            movement.sampled = sample_curve(self.arm, movement.tool, movement.curve, self.end_joints)
        self._warn_of_ranges(movement)
        if not self._movements:
            movement.offset = self._length
            self._movements.append(movement)
            self._pieces = [self._body(movement, 0.0)]
            self._length = movement.end
            self._is_planned = False
            return True
        return self._append_behind(self._movements[-1], movement)

    def _warn_of_ranges(self, movement: Movement) -> None:
        """Warn where a movement comes close to the end of an axis's range."""
        assert movement.sampled is not None
        low, high = self.arm.limits.T
        gaps = np.minimum(movement.sampled.joints - low, high - movement.sampled.joints).min(axis=0)
        axis = int(gaps.argmin())
        text = f"{movement.label}: axis {axis + 1} comes within {math.degrees(gaps[axis]):.1f} deg of its range's end"
        if gaps[axis] < _NEAR_RANGE and text not in self.warnings:
            self.warnings.append(text)

    def _finish_at_point(self, movement: Movement) -> bool:
        """Stop in the latest point where a movement to the same point asks for it."""
        if self._movements and movement.zone is None:
            self._movements[-1].zone = None
            return False
        return True

    def _append_behind(self, before: Movement, movement: Movement) -> bool:
        if before.zone is None:
            return False
        is_of_joints = _blends_joints(before, movement)
        distance, turning = reduced(before.zone, before.curve, movement.curve, is_of_joints)
        edge = before.end - turning
        if distance < SHORTEST:
            before.zone = None
            return False
        if self._position_before_mean() > edge + 1e-9:
            self._fail_corner(before, "the next movement came too late")
            return False
        movement.offset = before.end
        try:
            corner = self._corner(before, movement, distance, turning)
        except MotionFault as fault:
            self._fail_corner(before, fault.detail)
            return False
        last = self._pieces.pop()
        if edge - last.start > _MEETS:
            inside = last.s[last.s < edge - 0.1 * _MEETS]
            self._pieces.append(Piece(last.sampled, last.offset, np.append(inside, edge), last.limits, self.arm))
        self._pieces += [*corner]
        if movement.curve.length - turning > _MEETS:
            self._pieces.append(self._body(movement, turning))
        self._movements.append(movement)
        self._length = movement.end
        self._is_planned = False
        return True

    def _fail_corner(self, before: Movement, why: str) -> None:
        number, title = CORNER_PATH
        self.warnings.append(f"{before.label}: {number} {title}: {why}; the arm stops in the point")
        before.zone = None

    def _body(self, movement: Movement, start: float) -> Piece:
        assert movement.sampled is not None
        return piece_between(movement.sampled, movement.offset, start, movement.curve.length, movement.limits, self.arm)

    def _corner(self, before: Movement, after: Movement, distance: float, turning: float) -> list[Piece]:
        assert before.sampled is not None
        assert after.sampled is not None
        assert before.zone is not None
        length, point = before.curve.length, before.end
        if _blends_joints(before, after):
            joints = JointCorner(before.sampled, after.sampled, length, distance)
            stretches = [sample_joint_path(self.arm, before.tool, joints.joints, -distance, distance)]
        else:
            path = PoseCorner(before.curve, after.curve, distance, turning)
            start = before.sampled.joints_at(np.array([length - turning]))[0]
            edges = sorted({-turning, -distance, distance, turning})
            stretches = []
            for x0, x1 in itertools.pairwise(edges):
                if x1 - x0 > _MEETS:
                    stretches.append(sample_tool_path(self.arm, before.tool, path.poses, x0, x1, start))
                    start = stretches[-1].joints[-1]
            arrival = after.sampled.joints_at(np.array([turning]))[0]
            if np.abs(start - arrival).max() > 1e-4:
                raise MotionFault(SINGULARITY, "the corner path ends with another configuration")
        pieces = []
        for one in stretches:
            x0, x1 = float(one.x[0]), float(one.x[-1])
            parts = [(x0, 0.0, before.limits), (0.0, x1, after.limits)] if x0 < 0.0 < x1 else []
            for a, b, limits in parts or [(x0, x1, before.limits if x1 <= 0.0 else after.limits)]:
                pieces.append(piece_between(one, point, a, b, limits, self.arm))
        self._report_corner(before, distance, stretches)
        return pieces

    def _report_corner(self, before: Movement, distance: float, stretches: list[Sampled]) -> None:
        assert before.zone is not None
        assert before.sampled is not None
        target = before.sampled.positions[-1]
        middle = next(one for one in stretches if one.x[0] < 0.0 < one.x[-1])
        deviation = float(
            np.linalg.norm(middle.positions_at(np.linspace(middle.x[0], middle.x[-1], 65)) - target, axis=1).min()
        )
        self.corners.append(CornerReport(before.label, before.zone.position, distance, deviation, target))

    # Time

    def advance(self, seconds: float) -> None:
        """Advance time."""
        self._plan()
        self.now += seconds
        if self._profile is None:
            return
        if self.now >= self._profile.end_time - _TICK:
            self._come_to_rest()
            return
        self._profile.forget(self.now)
        reached = float(self._profile.at(np.array([self.now]))[0][0])
        while len(self._pieces) > 1 and self._pieces[0].end < reached - 1e-9:
            self._pieces.pop(0)
        while len(self._movements) > 1 and self._movements[0].end < self._pieces[0].start:
            self._movements.pop(0)

    def _come_to_rest(self) -> None:
        assert self._profile is not None
        position = float(self._profile.at(np.array([self._profile.end_time]))[0][0])
        if position > self._length - 1e-9:
            self.joints = self.end_joints.copy()
            self._movements, self._pieces, self._profile = [], [], None
        elif self.is_stopped:
            self._profile = Profile(self.now, position, self._profile.ramp_time)
        self._is_planned = True

    def remaining(self) -> float:
        """Return the time until the arm is at rest at the end of its path [s]; infinity while it is stopped."""
        if self.is_stopped and self._movements:
            return math.inf
        self._plan()
        if self._profile is None:
            return 0.0
        return _left(self._profile.end_time - self.now)

    def braking(self) -> float:
        """Return the time until the arm rests, on its path or at the end of it [s]."""
        self._plan()
        return _left(self._profile.end_time - self.now) if self._profile is not None else 0.0

    def lead(self) -> float:
        """Return the time until the next movement has to be known [s]: before corner path and deceleration begin.

        Infinity while it is stopped.
        """
        if self.is_at_rest or self._movements[-1].zone is None:
            return self.remaining()
        if self.is_stopped:
            return math.inf
        self._plan()
        latest = self._movements[-1]
        assert self._profile is not None
        assert latest.zone is not None
        zone = min(max(latest.zone.position, latest.zone.orientation), 0.5 * latest.curve.length)
        return _left(self._profile.time_before_mean(min(self._free, latest.end - zone)) - self.now)

    def until_waiting(self, count: int) -> float:
        """Return the time until at most so many movements are waiting [s]; infinity while the arm is stopped."""
        if len(self._movements) <= count:
            return 0.0
        if self.is_stopped:
            return math.inf
        self._plan()
        assert self._profile is not None
        passed = self._movements[len(self._movements) - count - 1]
        return _left(self._profile.time_before_mean(passed.end) - self.now)

    def time_of(self, position: float) -> float:
        """Return when the arm is at a position on the path [s]; infinity where it does not come there."""
        self._plan()
        return self._profile.time_of(position) if self._profile is not None else math.inf

    @property
    def length(self) -> float:
        """Return the length of the whole path, from its first movement on [m]."""
        return self._length

    def share(self) -> float:
        """Return the share of the only movement that is done, 1 at rest."""
        if self._profile is None or not self._movements:
            return 0.0 if self._movements else 1.0
        first = self._movements[0]
        position = float(self._profile.at(np.array([self.now]))[0][0])
        return min(max((position - first.offset) / first.curve.length, 0.0), 1.0)

    # State

    def joints_at(self, times: Array) -> Array:
        """Return angles (n, 6) [rad] at times (n,), from the latest `advance` on."""
        return self.motion_at(times)[0]

    def motion_at(self, times: Array) -> tuple[Array, Array, Array]:
        """Return angles [rad], speeds [rad/s] and accelerations [rad/s^2], (n, 6) each, at times (n,)."""
        self._plan()
        if self._profile is None or not self._pieces:
            shape = (len(times), 6)
            return np.broadcast_to(self.joints, shape).copy(), np.zeros(shape), np.zeros(shape)
        s, v, a = self._profile.at(times)
        joints, first, second = (np.empty((len(times), 6)) for _ in range(3))
        for piece, rows in self._rows_of(s):
            joints[rows], first[rows], second[rows], *_ = piece.sampled.derivatives(s[rows] - piece.offset)
        return joints, first * v[:, None], first * a[:, None] + second * (v**2)[:, None]

    def label_at(self, times: Array) -> list[str]:
        """Return the labels of the movements that the arm is in at times (n,)."""
        if self._profile is None:
            return [""] * len(times)
        s = self._profile.at(times)[0]
        index = np.searchsorted([one.end for one in self._movements], s, side="left")
        return [self._movements[min(i, len(self._movements) - 1)].label for i in index]

    def _rows_of(self, s: Array) -> list[tuple[Piece, NDArray[np.intp]]]:
        """Return the pieces that positions (n,) lie in, each with the indices of its positions."""
        index = np.searchsorted([one.start for one in self._pieces[1:]], s, side="right")
        return [(self._pieces[i], np.flatnonzero(index == i)) for i in np.unique(index)]

    def _position_before_mean(self) -> float:
        if self._profile is None:
            return self._movements[0].offset if self._movements else self._length
        return float(self._profile.positions_before_mean(np.array([self.now]))[0])

    # Stopping

    def stop(self) -> None:
        """Stop on the path as fast as the limits allow."""
        self._plan()
        self.is_stopped = True
        self.version += 1
        if self._profile is None or self.now >= float(self._profile.times[-1]):
            return
        position, speed = self._profile.cut(self.now)
        ahead = self._ahead(position)
        s, first, second, limits = (np.concatenate([getattr(one, name) for one in ahead]) for name in _ROWS)
        x = np.zeros(len(s))
        last = stopping_speeds(s, first, second, limits, speed**2, x)
        x_before, x_after = x[last - 1], x[last]
        if x_after <= 0.0 and x_before > 0.0:
            share = x_before / (x_before - x_after)
            s[last] = s[last - 1] + share * (s[last] - s[last - 1])
            x[last] = 0.0
        if speed > 0.0:
            self._profile.extend(s[: last + 1], x[: last + 1])

    def resume(self) -> None:
        """Go on along the path."""
        self.is_stopped = False
        self._is_planned = not self._movements

    def stretch(self, seconds: float) -> None:
        """Slow a motion that begins now, from rest, so that it takes that time; it never becomes faster."""
        left = self.remaining()
        if self._profile is not None and 0.0 < left < seconds < math.inf:
            self._profile.stretch(self.now, seconds / left)
            self.version += 1

    def follow(self, other: Planner) -> float:
        """Move as another arm does that begins its motion now, in proportion to the lengths of both paths.

        Both rest, and each has one movement before it.

        Returns
        -------
        float
            By how much both have to be slowed so that this arm keeps its own limits; 1 where it does.
        """
        self._plan()
        other._plan()
        if self._profile is None or other._profile is None:
            return 1.0
        start, begin = self._movements[0].offset, other._movements[0].offset
        share = (self._length - start) / (other._length - begin)
        self._profile = other._profile.copy_for(self.now, start, other.now, share)
        self.version += 1
        times = self.now + np.linspace(0.0, self._profile.end_time - self.now, _FOLLOW_SAMPLES)
        return math.sqrt(max(1.0, float(self._ratios(times).max())))

    def clear(self) -> None:
        """Forget the path behind the point in which the arm rests."""
        self.joints = self.joints_at(np.array([self.now]))[0]
        self._movements, self._pieces, self._profile = [], [], None
        self._is_planned = True

    def store(self) -> PathRest:
        """Forget the path on which the arm is stopped, and return it."""
        position = float(self._profile.at(np.array([self.now]))[0][0]) if self._profile is not None else self._length
        ramp = self._profile.ramp_time if self._profile is not None else self.arm.ramp_time
        movements, pieces = self._movements, self._pieces
        self.clear()
        self.is_stopped = False
        return PathRest(self.joints, position, movements, pieces, self._length, ramp)

    def restore(self, rest: PathRest) -> None:
        """Take up a path where the arm has left it; the arm stays stopped until `resume`."""
        self._movements, self._pieces, self._length = list(rest.movements), list(rest.pieces), rest.length
        self._profile = Profile(self.now, rest.position, rest.ramp_time) if rest.movements else None
        self.is_stopped = True
        self._is_planned = True
        self.version += 1

    # Planning

    def _ahead(self, position: float) -> list[Piece]:
        """Return the pieces from a position on, the one that it is in divided there."""
        first = next(i for i, one in enumerate(self._pieces) if one.end > position + 1e-9)
        if self._pieces[first].start < position - 1e-9:
            self._pieces[first : first + 1] = self._pieces[first].split(position)
            first += 1
        return self._pieces[first:]

    def _plan(self) -> None:
        """Make the plan anew from now on, where movements were appended."""
        if self._is_planned or self.is_stopped:
            return
        self._is_planned = True
        self.version += 1
        if self._profile is None:
            ramp = (
                self.arm.ramp_time * min(self._movements[0].limits.acceleration, 1.0) / self._movements[0].limits.ramp
            )
            self._profile = Profile(self.now, self._movements[0].offset, ramp)
        for _ in range(_CORRECTIONS):
            position, speed = self._profile.cut(self.now)
            ahead = self._ahead(position)
            self._extend(ahead, speed)
            if not self._slow_down(ahead):
                break

    def _extend(self, ahead: list[Piece], speed: float) -> None:
        assert self._profile is not None
        s, first, second, limits = (np.concatenate([getattr(one, name) for one in ahead]) for name in _ROWS)
        caps = np.concatenate([one.caps * one.slowing for one in ahead])
        scratch, x, free = np.empty(len(s)), np.empty(len(s)), np.empty(len(s))
        greatest_speeds(s, first, second, limits, caps, speed**2, 0.0, scratch, x)
        greatest_speeds(s, first, second, limits, caps, speed**2, _END, scratch, free)
        slower = np.flatnonzero(x < free * (1.0 - 1e-9))
        self._free = float(s[max(int(slower[0]) - 1, 0)]) if len(slower) else float(s[-1])
        points = np.empty((3 * len(s), 2))
        count = refine(s, first, second, limits, caps, x, points)
        self._profile.extend(points[:count, 0], points[:count, 1])

    def _slow_down(self, ahead: list[Piece]) -> bool:
        """Lower the caps where the mean does not keep the limits; return whether there are such places."""
        assert self._profile is not None
        span = self._profile.end_time - self.now
        times = self.now + np.linspace(0.0, span, int(min(max(span / _MEASURE_STEP, 16), _MOST_MEASURED)))
        ratios = self._ratios(times)
        bad = np.flatnonzero(ratios > _TOLERANCE)
        if not len(bad):
            return False
        points = np.concatenate([one.s for one in ahead])
        factors = np.ones(len(points))
        low = np.searchsorted(points, self._profile.positions_before_mean(times[bad] - self._profile.ramp_time)) - 1
        high = np.searchsorted(points, self._profile.positions_before_mean(times[bad])) + 1
        for a, b, ratio in zip(np.maximum(low, 0), high, ratios[bad], strict=True):
            np.minimum(factors[a:b], ratio**-_EASE, out=factors[a:b])
        starts = np.cumsum([0, *(len(one.s) for one in ahead)])
        for one, begin in zip(ahead, starts, strict=False):
            share = factors[begin : begin + len(one.s)]
            one.slowing *= share
            one.accelerations = one.accelerations * share[:, None]
        return True

    def _ratios(self, times: Array) -> Array:
        """Return by how much the squared speeds and the accelerations at times (n,) are above their limits."""
        assert self._profile is not None
        s, v, a = self._profile.at(times)
        ratios = np.zeros(len(times))
        for piece, rows in self._rows_of(s):
            first, second, caps = piece.rows_at(s[rows])
            speeds = v[rows] ** 2
            forces = np.abs(first * a[rows][:, None] + second * speeds[:, None]) / piece.unreduced
            ratios[rows] = np.maximum(speeds / caps, forces.max(axis=1))
        return ratios


def _blends_joints(before: Movement, after: Movement) -> bool:
    return (
        before.blends_joints
        or after.blends_joints
        or isinstance(before.curve, JointCurve)
        or isinstance(after.curve, JointCurve)
        or not np.array_equal(before.tool, after.tool)
    )


def _left(seconds: float) -> float:
    return seconds if seconds > _TICK else 0.0
