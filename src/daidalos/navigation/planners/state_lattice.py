"""State lattices: motions that lead from one pose of a regular grid of poses to another, and their files.

The files are those of Nav2's primitive generator: JSON with `lattice_metadata` and `primitives`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.documents import DocumentError, parse_json, read_text
from daidalos.common.errors import Location, UserError
from daidalos.common.suggestions import hint

MOTION_MODELS = ("ackermann", "diff", "omni")
_SAME_ANGLE = 1e-3
_ROUNDED = 0.05


class LatticeError(UserError):
    """File of a state lattice that cannot be used."""


class MotionPrimitive(NamedTuple):
    """Motion from the origin, at one heading of the lattice, to a cell and another heading.

    Attributes
    ----------
    start, end : int
        Headings, as their indices.
    left_turn : bool
        Whether the arc turns left; true of motions without an arc.
    radius : float
        Of the arc [m]; 0 without one.
    length, arc_length, straight_length : float
        Of the whole, of its arc and of its straight parts [m]; a turn in place has none.
    poses : ndarray, shape (n, 3)
        Poses (x [m], y [m], yaw [rad]) along it; the last is its end.
    """

    start: int
    end: int
    left_turn: bool
    radius: float
    length: float
    arc_length: float
    straight_length: float
    poses: Array

    @property
    def turn(self) -> int:
        """Side to which it turns on the way: 1 to the left, -1 to the right, 0 for straight on or in place."""
        if self.arc_length < 1e-3:
            return 0
        return 1 if self.left_turn else -1


@dataclass(frozen=True)
class StateLattice:
    """Lattice of poses, by the motions between them.

    Attributes
    ----------
    motion_model : str
        ``ackermann``, ``diff`` (turns in place) or ``omni`` (these, and sideways).
    turning_radius : float
        Of the narrowest arc [m].
    grid_resolution : float
        Edge of the cells [m] at whose centres motions end.
    headings : ndarray, shape (n,)
        Angles [rad], increasing.
    primitives : tuple of MotionPrimitive
    """

    motion_model: str
    turning_radius: float
    grid_resolution: float
    headings: Array
    primitives: tuple[MotionPrimitive, ...]

    def nearest_heading(self, yaw: float) -> int:
        """Return the index of the heading nearest to a yaw [rad]."""
        apart = np.remainder(self.headings - yaw + math.pi, 2.0 * math.pi) - math.pi
        return int(np.argmin(np.abs(apart)))

    @property
    def is_symmetric(self) -> bool:
        """Whether the opposite of each heading is a heading too, so that motions can be driven backwards."""
        count = self.headings.size
        if count % 2:
            return False
        apart = np.roll(self.headings, count // 2) - self.headings
        return bool((np.abs(np.remainder(apart, 2.0 * math.pi) - math.pi) < _SAME_ANGLE).all())


def read_lattice(path: Path | str) -> StateLattice:
    """Return the lattice of a file.

    Raises
    ------
    LatticeError
        The file cannot be read or used; the message says where.
    """
    file = str(path)
    try:
        document = parse_json(read_text(path), file)
    except DocumentError as error:
        raise LatticeError(error.problem, error.location) from None
    except OSError as error:
        raise LatticeError(f"cannot be read: {error.strerror or error}", Location(file)) from None
    return _Reader(file).lattice(document)


def lattice_document(lattice: StateLattice, metadata: dict[str, Any], date: str) -> dict[str, Any]:
    """Return the content of a lattice's file.

    Parameters
    ----------
    lattice : StateLattice
    metadata : dict
        What it was generated with, beside what is in the lattice.
    date : str
        Day on which it was generated, as YYYY-MM-DD.
    """
    ordered = sorted(lattice.primitives, key=lambda one: (one.start, one.end))
    return {
        "version": 1.0,
        "date_generated": date,
        "lattice_metadata": {
            "motion_model": lattice.motion_model,
            "turning_radius": lattice.turning_radius,
            "grid_resolution": lattice.grid_resolution,
            **metadata,
            "num_of_headings": lattice.headings.size,
            "heading_angles": lattice.headings.tolist(),
            "number_of_trajectories": len(lattice.primitives),
        },
        "primitives": [
            {
                "trajectory_id": index,
                "start_angle_index": one.start,
                "end_angle_index": one.end,
                "left_turn": one.left_turn,
                "trajectory_radius": one.radius,
                "trajectory_length": one.length,
                "arc_length": one.arc_length,
                "straight_length": one.straight_length,
                "poses": one.poses.tolist(),
            }
            for index, one in enumerate(ordered)
        ],
    }


class _Reader:
    """Reader of one document, which knows the place of each value for error messages."""

    def __init__(self, file: str) -> None:
        self._file = file

    def lattice(self, document: Any) -> StateLattice:
        metadata = self._field(document, "", "lattice_metadata", dict, "an object")
        place = "lattice_metadata"
        angles = self._field(metadata, place, "heading_angles", list, "a list of angles")
        self._require(
            len(angles) > 1 and all(_is_number(one) for one in angles) and bool((np.diff(angles) > 0.0).all()),
            f"{place}.heading_angles", "must be increasing angles",
        )  # fmt: skip
        model = metadata.get("motion_model", "ackermann")
        self._require(
            model in MOTION_MODELS, f"{place}.motion_model", f"is {model!r}, expected {', '.join(MOTION_MODELS)}"
        )
        headings = np.array(angles, dtype=np.float64)
        radius, resolution = (
            self._number(metadata, place, name, above=True) for name in ("turning_radius", "grid_resolution")
        )
        given = self._field(document, "", "primitives", list, "a list")
        primitives = tuple(
            self._primitive(one, f"primitives[{i}]", headings, resolution) for i, one in enumerate(given)
        )
        self._require(bool(primitives), "primitives", "is empty")
        missing = sorted(set(range(headings.size)) - {one.start for one in primitives})
        self._require(not missing, "primitives", f"has no motion from the headings {', '.join(map(str, missing))}")
        return StateLattice(str(model), radius, resolution, headings, primitives)

    def _primitive(self, given: Any, place: str, headings: Array, resolution: float) -> MotionPrimitive:
        start, end = (self._index(given, place, f"{name}_angle_index", headings.size) for name in ("start", "end"))
        left = self._field(given, place, "left_turn", bool, "true or false")
        names = ("trajectory_radius", "trajectory_length", "arc_length", "straight_length")
        radius, length, arc, straight = (self._number(given, place, name) for name in names)
        poses = self._field(given, place, "poses", list, "a list of poses")
        is_valid = bool(poses) and all(
            isinstance(one, list) and len(one) == 3 and all(_is_number(value) for value in one) for one in poses
        )
        self._require(is_valid, f"{place}.poses", "must be poses of three numbers")
        found = np.array(poses, dtype=np.float64)
        turned = math.remainder(found[-1, 2] - headings[end], 2.0 * math.pi)
        self._require(abs(turned) < _SAME_ANGLE, f"{place}.poses", f"end at {found[-1, 2]:g} rad, not at heading {end}")
        way = float(np.hypot(*np.diff(found[:, :2], axis=0, prepend=0.0).T).sum())
        self._require(
            length >= (1.0 - _ROUNDED) * way,
            f"{place}.trajectory_length",
            f"is {length:g}, but its poses span {way:g} m",
        )
        cells = found[-1, :2] / resolution
        self._require(
            bool((np.abs(cells - np.round(cells)) < _ROUNDED).all()),
            f"{place}.poses", "do not end at the centre of a cell of grid_resolution",
        )  # fmt: skip
        return MotionPrimitive(start, end, left, radius, length, arc, straight, found)

    def _field(self, owner: Any, place: str, name: str, kind: type, words: str) -> Any:
        self._require(isinstance(owner, dict), place or name, "is missing, expected an object with it")
        where = f"{place}.{name}" if place else name
        self._require(name in owner, where, f"is missing{hint(name, [str(one) for one in owner])}")
        value = owner[name]
        self._require(isinstance(value, kind), where, f"is {str(value)[:40]!r}, expected {words}")
        return value

    def _number(self, owner: Any, place: str, name: str, *, above: bool = False) -> float:
        value = self._field(owner, place, name, object, "a number")
        is_valid = _is_number(value) and (value > 0.0 if above else value >= 0.0)
        bound = "above 0" if above else "of at least 0"
        self._require(is_valid, f"{place}.{name}", f"is {str(value)[:40]}, expected a number {bound}")
        return float(value)

    def _index(self, owner: Any, place: str, name: str, count: int) -> int:
        value = self._field(owner, place, name, object, "an index")
        is_valid = _is_number(value) and value == int(value) and 0 <= value < count
        self._require(is_valid, f"{place}.{name}", f"is {str(value)[:40]}, expected an index from 0 to {count - 1}")
        return int(value)

    def _require(self, holds: bool, place: str, problem: str) -> None:
        if not holds:
            raise LatticeError(f"{place} {problem}", Location(self._file))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e6
