"""Generation of state lattices: few motions of bounded curvature out of which others can be put together.

M. Pivtoraiko and A. Kelly, Generating near minimal control sets for constrained motion planning in discrete state
spaces (2005). A motion is a straight line and an arc, in either order, or one of them alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.navigation.planners.state_lattice import MOTION_MODELS, MotionPrimitive, StateLattice

MAX_CELLS = 100
"""Largest turning radius [cells]."""
MAX_TURN = 0.5 * math.pi
"""Largest angle [rad] by which a motion turns; those that turn more are put together."""
REACH = 2.0
"""Distance, in turning radii, beyond which no motions are looked for."""


@dataclass(frozen=True)
class LatticeOptions(Parameters):
    """Options of the generation, by the names in the configuration files of Nav2's generator."""

    motion_model: str = parameter(
        "ackermann", "How the robot moves: by arcs, also by turns in place, also sideways.", choices=MOTION_MODELS
    )
    turning_radius: float = parameter(0.5, "Radius of the narrowest arc.", unit="m", above=0.0)
    grid_resolution: float = parameter(0.05, "Edge of the cells at whose centres motions end.", unit="m", above=0.0)
    stopping_threshold: int = parameter(
        5, "Distances one after the other without any new motion that end the generation.", minimum=1
    )
    num_of_headings: int = parameter(16, "Headings of a full turn; a multiple of 8.", minimum=8, maximum=128)
    trajectory_distinctness_ratio: float = parameter(
        0.9,
        "A motion is left out when its end is nearer to another's of the same heading than this share of its length.",
        minimum=0.0,
    )

    def check(self) -> None:
        """Check the number of headings, and the radius beside the cells."""
        if self.num_of_headings % 8:
            raise ParameterError("num_of_headings", f"must be a multiple of 8, got {self.num_of_headings}")
        largest = MAX_CELLS * self.grid_resolution
        if self.turning_radius > largest:
            raise ParameterError(
                "turning_radius", f"must be at most {largest:g} for this grid_resolution, got {self.turning_radius:g}"
            )


@lru_cache(maxsize=4)
def generate_lattice(options: LatticeOptions) -> StateLattice:
    """Generate a lattice whose headings are those of straight lines through centres of cells."""
    count, resolution = options.num_of_headings, options.grid_resolution
    quarter = count // 4
    directions = _directions(count)
    headings = np.arctan2(directions[:, 1], directions[:, 0])
    headings = np.concatenate([headings + 0.5 * math.pi * k for k in range(4)])
    shortest = options.turning_radius * float(np.diff(headings).min())
    primitives = []
    for start in range(quarter):
        straight = math.ceil(shortest / (resolution * math.hypot(*directions[start])) - 0.25) * directions[start]
        arcs = list(_arcs_from(start, headings, straight, shortest, options))
        for turned in range(4):
            heading = (start + turned * quarter) % count
            primitives.append(_line(heading, headings, _rotated(straight, turned), resolution))
            primitives += [one.placed(headings, turned, resolution, mirrored=False) for one in arcs]
            primitives += [one.placed(headings, turned, resolution, mirrored=True) for one in arcs]
            if options.motion_model != "ackermann":
                primitives += [_turn(heading, side, headings) for side in (1, -1)]
            if options.motion_model == "omni":
                primitives += [
                    _line(heading, headings, _rotated(straight, turned + side), resolution) for side in (1, 3)
                ]
    primitives.sort(key=lambda one: (one.start, one.end))
    return StateLattice(options.motion_model, options.turning_radius, resolution, headings, tuple(primitives))


class _Arc(NamedTuple):
    """Motion that turns left: straight on, then along an arc, then straight on; one of the lines has no length."""

    start: int
    end: int
    column: int
    row: int
    before: float
    radius: float
    after: float

    def poses(self, headings: Array, spacing: float) -> Array:
        """Return poses (n, 3) along it at most `spacing` [m] apart, the origin left out."""
        turn = (headings[self.end] - headings[self.start]) % (2.0 * math.pi)
        borders = np.cumsum([0.0, self.before, self.radius * turn, self.after])
        along = np.concatenate([_steps(a, b, spacing) for a, b in pairwise(borders)])
        straight, angle, rest = (np.clip(along - a, 0.0, b - a) for a, b in pairwise(borders))
        angle /= self.radius
        x = straight + self.radius * np.sin(angle) + rest * math.cos(turn)
        y = self.radius * (1.0 - np.cos(angle)) + rest * math.sin(turn)
        cosine, sine = math.cos(headings[self.start]), math.sin(headings[self.start])
        yaw = (headings[self.start] + angle) % (2.0 * math.pi)
        yaw[-1] = headings[self.end]
        return np.stack([cosine * x - sine * y, sine * x + cosine * y, yaw], axis=-1)

    def placed(self, headings: Array, quarters: int, resolution: float, *, mirrored: bool) -> MotionPrimitive:
        """Return the motion turned by quarters of a turn, after it was mirrored at the x axis or not."""
        count = headings.size
        side = -1 if mirrored else 1
        start, end = ((side * one + quarters * count // 4) % count for one in (self.start, self.end))
        poses = self.poses(headings, resolution)
        poses[-1, :2] = np.array([self.column, self.row]) * resolution
        poses[:, :2] = _rotated(poses[:, :2] * (1, side), quarters)
        poses[:, 2] = (side * poses[:, 2] + 0.5 * math.pi * quarters) % (2.0 * math.pi)
        poses[-1, 2] = headings[end]
        turn = (headings[self.end] - headings[self.start]) % (2.0 * math.pi)
        arc, straight = self.radius * turn, self.before + self.after
        return MotionPrimitive(start, end, not mirrored, self.radius, arc + straight, arc, straight, poses)


def _steps(begin: float, end: float, spacing: float) -> Array:
    """Return numbers at most `spacing` apart from one to another, the first left out; none where they are the same."""
    count = math.ceil((end - begin) / spacing - 1e-9)
    return begin + (end - begin) * np.arange(1, count + 1) / max(count, 1)


def _directions(count: int) -> Array:
    """Return the directions (count / 4, 2) of the headings of a quarter of a turn, as shortest steps over cells."""
    edge = count // 8
    steps = [(edge, k) for k in range(edge)] + [(edge - k, edge) for k in range(edge)]
    return np.array([(x // math.gcd(x, y), y // math.gcd(x, y)) for x, y in steps])


def _arcs_from(
    start: int, headings: Array, straight: Array, shortest: float, options: LatticeOptions
) -> Iterator[_Arc]:
    """Yield the motions that turn left from a heading and pass no end of another one, the nearest first."""
    resolution = options.grid_resolution
    ends = [np.array([*(straight * resolution), headings[start]])]
    idle = 0
    farthest = math.ceil(REACH * options.turning_radius / resolution) + options.num_of_headings
    for distance in range(max(int(shortest / resolution), 1), farthest):
        kept = 0
        for arc, length in _candidates(start, headings, distance, shortest, options):
            poses = arc.poses(headings, 0.5 * resolution)
            if _is_needed(poses, length, np.array(ends), options):
                ends.append(poses[-1])
                kept += 1
                yield arc
        idle = 0 if kept else idle + 1
        if len(ends) > 1 and idle >= options.stopping_threshold:
            return


def _is_needed(poses: Array, length: float, ends: Array, options: LatticeOptions) -> bool:
    """Return whether a motion (n, 3) passes none of the ends (m, 3), and its own end is far enough from theirs."""
    near = 0.5 * math.pi / options.num_of_headings
    apart = np.hypot(*(poses[:, None, :2] - ends[:, :2]).transpose(2, 0, 1))
    turned = np.abs(np.remainder(poses[:, None, 2] - ends[:, 2] + math.pi, 2.0 * math.pi) - math.pi)
    passes = (apart < 0.5 * options.grid_resolution) & (turned < near)
    similar = (apart[-1] < options.trajectory_distinctness_ratio * length) & (turned[-1] < 1e-6)
    return not passes.any() and not similar.any()


def _candidates(
    start: int, headings: Array, distance: int, shortest: float, options: LatticeOptions
) -> list[tuple[_Arc, float]]:
    """Return motions that turn left to cells at a distance (the larger of columns and rows), the shortest first."""
    line = np.arange(-distance, distance + 1)
    columns, rows = (one.ravel() for one in np.meshgrid(line, line))
    is_there = np.maximum(np.abs(columns), np.abs(rows)) == distance
    columns, rows = columns[is_there], rows[is_there]
    cosine, sine = math.cos(headings[start]), math.sin(headings[start])
    x = options.grid_resolution * (cosine * columns + sine * rows)
    y = options.grid_resolution * (cosine * rows - sine * columns)
    found = []
    for end in range(headings.size):
        turn = (headings[end] - headings[start]) % (2.0 * math.pi)
        if not 1e-9 < turn < MAX_TURN + 1e-9:
            continue
        after = y / math.sin(turn)  # from where the lines through both ends meet
        before = x - after * math.cos(turn)
        tangent = np.minimum(before, after)
        radius = tangent / math.tan(0.5 * turn)
        length = radius * turn + before + after - 2.0 * tangent
        is_possible = (radius > options.turning_radius * (1.0 - 1e-9)) & (length > shortest * (1.0 - 1e-9))
        found += [
            (
                _Arc(
                    start, end, int(columns[i]), int(rows[i]), before[i] - tangent[i], radius[i], after[i] - tangent[i]
                ),
                float(length[i]),
            )
            for i in np.flatnonzero(is_possible)
        ]
    return sorted(found, key=lambda one: (one[1], one[0][1:4]))


def _rotated(points: Array, quarters: int) -> Array:
    """Return points (..., 2) turned by quarters of a turn, exactly."""
    for _ in range(quarters % 4):
        points = np.stack([-points[..., 1], points[..., 0]], axis=-1)
    return points


def _line(heading: int, headings: Array, cells: Array, resolution: float) -> MotionPrimitive:
    """Return the motion straight to a cell, looking at a heading all the way."""
    length = resolution * math.hypot(*cells)
    count = max(math.ceil(length / resolution - 1e-9), 1)
    share = np.arange(1, count + 1)[:, None] / count
    poses = np.concatenate([share * cells * resolution, np.full((count, 1), headings[heading])], axis=1)
    return MotionPrimitive(heading, heading, True, 0.0, length, 0.0, length, poses)


def _turn(heading: int, side: int, headings: Array) -> MotionPrimitive:
    """Return the motion in place to the next heading on a side: 1 for the left, -1 for the right."""
    end = (heading + side) % headings.size
    angle = math.remainder(headings[end] - headings[heading], 2.0 * math.pi)
    count = max(math.ceil(abs(angle) / 0.15), 1)
    poses = np.zeros((count + 1, 3))
    poses[:, 2] = (headings[heading] + angle * np.arange(count + 1) / count) % (2.0 * math.pi)
    poses[-1, 2] = headings[end]
    return MotionPrimitive(heading, end, side > 0, 0.0, 0.0, 0.0, 0.0, poses)
