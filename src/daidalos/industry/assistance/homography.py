"""Homography between the picture of a projector and a plane of the cell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.errors import UserError

Array = NDArray[np.float64]
MIN_PAIRS = 4
_MAX_CONDITION = 1e6


class HomographyError(UserError):
    """Error of point pairs that determine no homography; the message states the remedy."""


@dataclass(frozen=True)
class Homography:
    """Projective map from points of a plane [m] to pixels.

    Attributes
    ----------
    matrix : (3, 3) array
        From ``[x, y, 1]`` on the plane to pixels, up to a factor.
    residual : float
        Root mean square distance of the pairs [pixels]; 0 with four of them.
    """

    matrix: Array
    residual: float

    def pixels(self, points: object) -> Array:
        """Return the pixels of points ``(n, 2)`` on the plane."""
        return _apply(self.matrix, np.atleast_2d(np.asarray(points, dtype=float)))

    def points(self, pixels: object) -> Array:
        """Return the points on the plane of pixels ``(n, 2)``."""
        return _apply(
            np.asarray(np.linalg.inv(self.matrix), dtype=np.float64), np.atleast_2d(np.asarray(pixels, dtype=float))
        )


def fit(points: Sequence[Sequence[float]], pixels: Sequence[Sequence[float]]) -> Homography:
    """Compute a homography by the normalized direct linear transform (Hartley and Zisserman, algorithm 4.2).

    Parameters
    ----------
    points, pixels : sequences of (x, y)
        At least four pairs, no three points of four on one line.

    Raises
    ------
    HomographyError
        When the pairs do not determine it.
    """
    plane, image = np.asarray(points, dtype=float), np.asarray(pixels, dtype=float)
    if len(plane) < MIN_PAIRS or plane.shape != image.shape:
        raise HomographyError(f"a homography needs at least {MIN_PAIRS} pairs of points, there are {len(plane)}")
    if not (np.isfinite(plane).all() and np.isfinite(image).all()):
        raise HomographyError("the pairs must be finite numbers")
    to_plane, to_image = _normalization(plane), _normalization(image)
    rows = []
    for (x, y), (u, v) in zip(_apply(to_plane, plane), _apply(to_image, image), strict=True):
        rows.append([-x, -y, -1.0, 0.0, 0.0, 0.0, u * x, u * y, u])
        rows.append([0.0, 0.0, 0.0, -x, -y, -1.0, v * x, v * y, v])
    _, values, vectors = np.linalg.svd(np.array(rows))
    # The eighth singular value is zero where three of four points are on one line.
    if values[7] * _MAX_CONDITION < values[0]:
        raise HomographyError("the pairs do not determine the plane: no three of four points may be on one line")
    normalized = vectors[-1].reshape(3, 3)
    matrix = np.linalg.inv(to_image) @ normalized @ to_plane
    matrix /= np.linalg.norm(matrix)
    if abs(np.linalg.det(normalized / np.linalg.norm(normalized))) < 1.0 / _MAX_CONDITION:
        raise HomographyError("the pairs map the plane to a line: check their order")
    distances = np.linalg.norm(_apply(matrix, plane) - image, axis=1)
    return Homography(matrix, float(np.sqrt(np.mean(distances**2))))


def read_homography(path: Path) -> Homography:
    """Return the homography of a YAML file with the list ``pairs`` of ``{point: [x, y], pixel: [u, v]}``.

    Raises
    ------
    DocumentError, HomographyError
        When it is none, or its pairs determine none.
    OSError
        When it cannot be opened.
    """
    content = read_yaml(path)
    pairs = content.get("pairs") if isinstance(content, dict) else None
    if not isinstance(pairs, list):
        raise DocumentError("must be a mapping with the list 'pairs'", str(path))
    found: dict[str, list[list[float]]] = {"point": [], "pixel": []}
    for index, pair in enumerate(pairs):
        for key, values in found.items():
            value = pair.get(key) if isinstance(pair, dict) else None
            if not (isinstance(value, list) and len(value) == 2 and all(type(one) in (int, float) for one in value)):
                raise DocumentError(f"pairs[{index}]: '{key}' must be a list of two numbers", str(path))
            values.append([float(one) for one in value])
    try:
        return fit(found["point"], found["pixel"])
    except HomographyError as error:
        raise HomographyError(f"{path}: {error}") from None


def write_pairs(path: Path, points: Sequence[Sequence[float]], pixels: Sequence[Sequence[float]]) -> None:
    """Write pairs of points [m] and pixels as YAML, whole or not at all."""
    import yaml

    pairs = [
        {"point": [float(one) for one in point], "pixel": [float(one) for one in pixel]}
        for point, pixel in zip(points, pixels, strict=True)
    ]
    part = path.with_name(f"{path.name}.part")
    part.write_text(yaml.safe_dump({"pairs": pairs}, default_flow_style=None), encoding="utf-8")
    part.replace(path)


def _normalization(points: Array) -> Array:
    """Return the similarity that centres points and gives them a mean distance of sqrt(2)."""
    middle = points.mean(axis=0)
    distance = float(np.linalg.norm(points - middle, axis=1).mean())
    if distance == 0.0:
        raise HomographyError("the pairs do not determine the plane: all points are the same")
    scale = np.sqrt(2.0) / distance
    return np.array([[scale, 0.0, -scale * middle[0]], [0.0, scale, -scale * middle[1]], [0.0, 0.0, 1.0]])


def _apply(matrix: Array, points: Array) -> Array:
    mapped = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(mapped[:, :2] / mapped[:, 2:])
