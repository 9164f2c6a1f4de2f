"""B-splines of degree 4 through paths of poses, with as many knots as a tolerance needs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

DEGREE = 4
POSITION_TOLERANCE = 5e-6
"""Greatest distance of a point from its spline [m]."""
ANGLE_TOLERANCE = 2e-5
"""Greatest angle between an orientation and its spline [rad]."""


@dataclass(frozen=True)
class Piece:
    """A spline through one smooth part of a path.

    Attributes
    ----------
    first, last : int
        Indices of its first and last point.
    position, orientation : scipy.interpolate.BSpline
        Position [m], and quaternion x, y, z, w that is yet to be normalised, over the length of the path [m].
    """

    first: int
    last: int
    position: Any
    orientation: Any


@dataclass(frozen=True)
class PathSpline:
    """Splines through a path, one for each smooth part.

    Attributes
    ----------
    pieces : tuple of Piece
        The parts, in order; the tool moves straight from one to the next.
    residuals : array of shape (n,)
        Distance of each point from the splines [m].
    angle_residuals : array of shape (n,)
        Angle between each orientation and that of the splines [rad].
    poses : array of shape (n, 4, 4)
        The splines at the points.
    """

    pieces: tuple[Piece, ...]
    residuals: NDArray[np.float64]
    angle_residuals: NDArray[np.float64]
    poses: NDArray[np.float64]

    def knots(self) -> tuple[int, int]:
        """Return the number of inner knots in position and in orientation."""
        counts = [(_inner(one.position), _inner(one.orientation)) for one in self.pieces]
        return sum(one for one, _ in counts), sum(one for _, one in counts)


def fit_path(
    distances: NDArray[np.float64],
    poses: NDArray[np.float64],
    breaks: Sequence[int] = (),
    position_tolerance: float = POSITION_TOLERANCE,
    angle_tolerance: float = ANGLE_TOLERANCE,
) -> PathSpline:
    """Fit splines of degree 4 to a path by least squares.

    Knots are added in the middle of those spans in which a point is farther away than the tolerance, until none is
    or each point has its own.

    Parameters
    ----------
    distances : array of shape (n,)
        Length of the path at each point, increasing [m].
    poses : array of shape (n, 4, 4)
        The poses.
    breaks : sequence of int
        Indices of points at which a new piece begins, since the path jumps there.
    position_tolerance, angle_tolerance : float
        [m], [rad]
    """
    from scipy.spatial.transform import Rotation

    bounds = [0, *sorted(set(breaks) - {0}), len(distances)]
    pieces = []
    fitted = np.array(poses)
    for first, end in itertools.pairwise(bounds):
        at, part = distances[first:end], poses[first:end]
        quaternions = _continuous(Rotation.from_matrix(part[:, :3, :3]).as_quat())
        position = _fit(at, part[:, :3, 3], position_tolerance)
        orientation = _fit(at, quaternions, 0.5 * angle_tolerance)
        pieces.append(Piece(first, end - 1, position, orientation))
        fitted[first:end, :3, 3] = position(at)
        fitted[first:end, :3, :3] = Rotation.from_quat(orientation(at)).as_matrix()
    residuals = np.linalg.norm(fitted[:, :3, 3] - poses[:, :3, 3], axis=1)
    return PathSpline(tuple(pieces), residuals, angles_between(fitted[:, :3, :3], poses[:, :3, :3]), fitted)


def angles_between(ones: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angles between rotations (n, 3, 3) and others (n, 3, 3), as (n,) [rad]."""
    chords = np.linalg.norm(ones - others, axis=(1, 2)) / np.sqrt(8.0)
    angles: NDArray[np.float64] = 2.0 * np.arcsin(np.minimum(chords, 1.0))
    return angles


def _continuous(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return quaternions (n, 4) with the signs that keep each near the one before it."""
    signs = np.where(np.einsum("ni,ni->n", quaternions[1:], quaternions[:-1]) < 0.0, -1.0, 1.0)
    continuous: NDArray[np.float64] = quaternions * np.concatenate([[1.0], np.cumprod(signs)])[:, None]
    return continuous


def _fit(at: NDArray[np.float64], values: NDArray[np.float64], tolerance: float) -> Any:
    from scipy.interpolate import BSpline, make_interp_spline, make_lsq_spline

    if len(at) == 1:
        return BSpline([at[0], at[0] + 1.0], values, 0, extrapolate=True)
    degree = min(DEGREE, len(at) - 1)
    inner = np.empty(0)
    while len(inner) + degree + 1 < len(at):
        knots = np.concatenate([[at[0]] * (degree + 1), inner, [at[-1]] * (degree + 1)])
        spline = make_lsq_spline(at, values, knots, degree)
        errors = np.linalg.norm(spline(at) - values, axis=1)
        if errors.max() <= tolerance:
            return spline
        more = _with_new_knots(at, inner, errors > tolerance, degree)
        if len(more) == len(inner):
            break
        inner = more
    return make_interp_spline(at, values, degree)


def _with_new_knots(
    at: NDArray[np.float64], inner: NDArray[np.float64], wrong: NDArray[np.bool_], degree: int
) -> NDArray[np.float64]:
    """Return inner knots with one more in each span that holds a wrong point and can be parted."""
    edges = np.concatenate([[at[0]], inner, [at[-1]]])
    spans = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, len(edges) - 2)
    added = []
    for span in np.unique(spans[wrong]):
        members = np.flatnonzero(spans == span)
        if len(members) >= 4:
            middle = len(members) // 2
            added.append(0.5 * (at[members[middle - 1]] + at[members[middle]]))
    return np.sort(np.concatenate([inner, added]))


def _inner(spline: Any) -> int:
    return max(int(len(spline.t) - 2 * (spline.k + 1)), 0)
