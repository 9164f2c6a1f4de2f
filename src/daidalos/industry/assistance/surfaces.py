"""Where rays meet the boxes, cylinders and spheres of a cell."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.geometry import Box, Cylinder, Geometry, Sphere

Array = NDArray[np.float64]


def hits(origins: Array, directions: Array, shapes: Iterable[tuple[Pose, Geometry]], floor: float | None) -> Array:
    """Return the nearest points ``(n, 3)`` at which rays meet shapes; not numbers where they meet none.

    Parameters
    ----------
    origins, directions : (n, 3) arrays
        Of the rays in the world; directions of length 1.
    shapes : iterable of (Pose, Geometry)
        In the world. Shapes that are no boxes, cylinders or spheres are passed through.
    floor : float or None
        Height of a horizontal plane below all of them [m].
    """
    nearest = np.full(len(origins), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        if floor is not None:
            nearest = _ahead((floor - origins[:, 2]) / directions[:, 2])
        for pose, shape in shapes:
            rotation = rotation_matrix(pose.orientation)
            start, way = (origins - pose.position) @ rotation, directions @ rotation
            nearest = np.minimum(nearest, _distance(start, way, shape))
    nearest[np.isinf(nearest)] = np.nan
    return np.asarray(origins + nearest[:, None] * directions)


def _distance(start: Array, way: Array, shape: Geometry) -> Array:
    """Return the distances to a shape in its own frame, infinite where a ray misses it."""
    if isinstance(shape, Box):
        return _between(*_slabs(start, way, 0.5 * np.array(shape.size)))
    if isinstance(shape, Cylinder):
        near, far = _slabs(start[:, 2:], way[:, 2:], np.array([0.5 * shape.length]))
        round_near, round_far = _round(start[:, :2], way[:, :2], shape.radius)
        return _between(np.maximum(near, round_near), np.minimum(far, round_far))
    if isinstance(shape, Sphere):
        return _between(*_round(start, way, shape.radius))
    return np.full(len(start), np.inf)


def _slabs(start: Array, way: Array, half: Array) -> tuple[Array, Array]:
    """Return where rays enter and leave the space between pairs of planes at +-half."""
    one, other = (-half - start) / way, (half - start) / way
    near, far = np.minimum(one, other), np.maximum(one, other)
    # A ray that is parallel to the planes is between them all the way, or never.
    is_inside, is_parallel = np.abs(start) <= half, way == 0.0
    near = np.where(is_parallel, np.where(is_inside, -np.inf, np.inf), near)
    far = np.where(is_parallel, np.where(is_inside, np.inf, -np.inf), far)
    return near.max(axis=1), far.min(axis=1)


def _round(start: Array, way: Array, radius: float) -> tuple[Array, Array]:
    """Return where rays enter and leave a circle or a sphere around the origin."""
    a, b = np.sum(way * way, axis=1), np.sum(start * way, axis=1)
    c = np.sum(start * start, axis=1) - radius**2
    root = np.sqrt(b * b - a * c)
    near, far = (-b - root) / a, (-b + root) / a
    is_still = a == 0.0
    near = np.where(is_still, np.where(c <= 0.0, -np.inf, np.inf), near)
    far = np.where(is_still, np.where(c <= 0.0, np.inf, -np.inf), far)
    return near, far


def _between(near: Array, far: Array) -> Array:
    """Return where rays enter, infinite where they miss or the shape is behind or around their origins."""
    return np.where(near <= far, _ahead(near), np.inf)


def _ahead(distance: Array) -> Array:
    return np.where(distance > 0.0, distance, np.inf)
