"""Circles in the picture of a camera, and which known point each of them is."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.assistance.homography import Homography, fit

Array = NDArray[np.float64]
MIN_CIRCLES = 5
_MAX_CANDIDATES = 20
_MIN_PIXELS, _MAX_SHARE = 20, 0.05
"""Size of a circle: in pixels, and as a share of the picture."""

_CONTRAST = 0.15
"""Least difference of a circle's brightness from its surroundings, as a share of the picture's range."""

_ROUNDNESS = 0.12
"""Greatest relative difference of a blob's area from that of the ellipse with its moments."""

_TOLERANCE = 0.01
"""Greatest distance of a circle from where the others say that it is, as a share of the picture's width."""

_CLARITY = 3.0
"""How many times worse any other assignment of circles to points has to be."""


class DetectionError(UserError):
    """Error of a picture in which something is not found; the message states the remedy."""


@dataclass(frozen=True)
class _Assignment:
    """Circles of the known points in their order, and the greatest distance from where they should be [pixels]."""

    indices: tuple[int, ...]
    distance: float


def find_circles(picture: Array) -> Array:
    """Return the centres ``(n, 2)`` of compact blobs such as circles, columns and rows [pixels], the darkest first.

    Parameters
    ----------
    picture : (height, width) array
        Brightness; circles are darker than what is around them.
    """
    from scipy.ndimage import find_objects, label, uniform_filter

    span = float(np.ptp(picture))
    if span <= 0.0:
        return np.zeros((0, 2))
    around = uniform_filter(picture, max(picture.shape) // 6)
    darkness = around - picture
    blobs, _ = label(darkness > _CONTRAST * span)
    found = []
    for number, region in enumerate(find_objects(blobs), 1):
        rows, columns = np.nonzero(blobs[region] == number)
        center = _ellipse_center(rows, columns, darkness[region], picture.size)
        if center is not None:
            weight = float(darkness[region][rows, columns].mean())
            found.append((weight, center[0] + region[1].start, center[1] + region[0].start))
    return np.array([one[1:] for one in sorted(found, reverse=True)]).reshape(-1, 2)


def _ellipse_center(
    rows: NDArray[np.intp], columns: NDArray[np.intp], darkness: Array, size: int
) -> tuple[float, float] | None:
    """Return column and row of a blob's middle, None of one that is long, ragged or hollow."""
    if not _MIN_PIXELS <= len(rows) <= _MAX_SHARE * size:
        return None
    covariance = np.cov(columns, rows, bias=True) + np.eye(2) / 12.0  # a pixel is a square
    small, large = np.linalg.eigvalsh(covariance)
    if small < 0.05 * large or abs(4.0 * np.pi * np.sqrt(small * large) / len(rows) - 1.0) > _ROUNDNESS:
        return None
    weights = darkness[rows, columns]
    return float(np.average(columns, weights=weights)), float(np.average(rows, weights=weights))


def locate(points: Array, circles: Array, width: int) -> Homography:
    """Return the homography from points of a plane, seen from above, to a picture with a circle at each of them.

    Parameters
    ----------
    points : (n, 2) array
        At least `MIN_CIRCLES` known points [m].
    circles : (m, 2) array
        Circles of the picture [pixels]; others than those of the points may be among them.
    width : int
        Of the picture [pixels].

    Raises
    ------
    DetectionError
        When there are too few, none fit, or they fit in several ways.
    """
    if len(points) < MIN_CIRCLES:
        raise DetectionError(
            f"at least {MIN_CIRCLES} known points are needed, so that they look different from each side"
        )
    circles = circles[:_MAX_CANDIDATES]
    if len(circles) < len(points):
        raise DetectionError(
            f"the camera sees {len(circles)} of {len(points)} circles: all have to be in the picture, dark and filled"
        )
    found = sorted(_assignments(points, circles, _TOLERANCE * width), key=lambda one: one.distance)
    if not found:
        raise DetectionError("the circles in the picture do not lie as the known points do; check their coordinates")
    best = found[0]
    if any(one.indices != best.indices and one.distance < _CLARITY * max(best.distance, 0.5) for one in found[1:]):
        raise DetectionError("the known points look the same from several sides; move one of them, or add one")
    return fit(points.tolist(), circles[list(best.indices)].tolist())


def _assignments(points: Array, circles: Array, tolerance: float) -> list[_Assignment]:
    """Return the ways in which circles can be the points, from all choices for four points in general position."""
    base = _general_four(points)
    rest = [one for one in range(len(points)) if one not in base]
    chosen = np.array(list(itertools.permutations(range(len(circles)), 4)))
    matrices, is_good = _four_point_maps(points[list(base)], circles[chosen])
    chosen, matrices = chosen[is_good], matrices[is_good]
    mapped = np.einsum("kij,nj->kni", matrices, np.column_stack([points, np.ones(len(points))]))
    depths = mapped[:, :, 2]
    # From above, and all of them before the camera: the map keeps its sense everywhere.
    is_above = (np.linalg.det(matrices) < 0.0) & (depths > 1e-9).all(axis=1)
    chosen, places = chosen[is_above], mapped[is_above, :, :2] / depths[is_above, :, None]
    distances = np.linalg.norm(places[:, rest, None] - circles[None, None], axis=3)
    nearest, worst = distances.argmin(axis=2), distances.min(axis=2).max(axis=1)
    found = []
    for four, others, distance in zip(chosen, nearest, worst, strict=True):
        indices = np.zeros(len(points), int)
        indices[list(base)], indices[rest] = four, others
        if distance <= tolerance and len(set(indices.tolist())) == len(points):
            found.append(_Assignment(tuple(indices.tolist()), float(distance)))
    return found


def _general_four(points: Array) -> tuple[int, ...]:
    """Return four points of which no three are near a line: those whose smallest triangle is the largest."""

    def smallest(four: tuple[int, ...]) -> float:
        return min(
            abs(float(np.linalg.det(np.column_stack([points[list(three)], np.ones(3)]))))
            for three in itertools.combinations(four, 3)
        )

    best = max(itertools.combinations(range(len(points)), 4), key=smallest)
    if smallest(best) < 1e-9:
        raise DetectionError("the known points do not span the plane: no three of four points may be on one line")
    return best


def _four_point_maps(points: Array, pixels: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the maps ``(k, 3, 3)`` from four points to ``(k, 4, 2)`` pixels, and which of them exist.

    The last row of each is positive at the first point. Pixels on one line have none.
    """
    source, _ = _bases(points[None])
    targets, is_good = _bases(pixels)
    matrices = targets @ np.linalg.inv(source)
    sign = np.sign(matrices[:, 2] @ np.append(points[0], 1.0))
    return matrices * np.where(sign == 0.0, 1.0, sign)[:, None, None], is_good & (sign != 0.0)


def _bases(four: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the matrices ``(k, 3, 3)`` from the projective basis to four points each, and which of them exist."""
    columns = np.concatenate([four, np.ones((*four.shape[:2], 1))], axis=2).transpose(0, 2, 1)
    determinants = np.linalg.det(columns[:, :, :3])
    is_good = np.abs(determinants) > 1e-9
    safe = np.where(is_good[:, None, None], columns[:, :, :3], np.eye(3))
    shares = np.linalg.solve(safe, columns[:, :, 3:])[:, :, 0]
    is_good &= (np.abs(shares) > 1e-9).all(axis=1)
    matrices = safe * shares[:, None, :]
    return np.where(is_good[:, None, None], matrices, np.eye(3)), is_good


def find_light(dark: Array, lit: Array) -> tuple[float, float] | None:
    """Return column and row [pixels] of the spot in which a picture is brighter than another, None without one.

    Parameters
    ----------
    dark, lit : (height, width) arrays
        Brightness without and with the spot.
    """
    from scipy.ndimage import gaussian_filter, label

    difference = gaussian_filter(lit - dark, 1.0)
    noise = 1.4826 * float(np.median(np.abs(difference - np.median(difference))))
    peak = float(difference.max())
    if peak <= max(12.0 * noise, 1e-3 * max(float(np.ptp(lit)), 1.0)):
        return None
    blobs, _ = label(difference > 0.5 * peak)
    number = blobs[np.unravel_index(int(difference.argmax()), difference.shape)]
    rows, columns = np.nonzero(blobs == number)
    if rows.min() == 0 or columns.min() == 0 or rows.max() == dark.shape[0] - 1 or columns.max() == dark.shape[1] - 1:
        return None  # a part of it may be outside
    weights = difference[rows, columns]
    return float(np.average(columns, weights=weights)), float(np.average(rows, weights=weights))
