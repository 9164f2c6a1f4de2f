"""Lengths and directions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

EPSILON = 4.0 * float(np.finfo(float).eps)
Array = NDArray[np.float64]


def vector_norm(data: ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return the length of a vector, or the lengths of those along an axis.

    Parameters
    ----------
    data
        One vector, or several in an array of any shape.
    axis
        Along which the components lie; all numbers are taken as one vector where None.
    out
        Where to put the result; nothing is returned then.
    """
    values = np.asarray(data, dtype=np.float64)
    if out is not None:
        out[...] = np.sqrt(np.sum(values * values, axis=axis))
        return None
    if values.ndim == 1:
        return float(np.sqrt(values @ values))
    return np.atleast_1d(np.sqrt(np.sum(values * values, axis=axis)))


def unit_vector(data: ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return a vector, or vectors along an axis, with length one.

    Parameters
    ----------
    data, axis
        As in `vector_norm`.
    out
        Where to put the result; nothing is returned then.
    """
    values = np.array(data, dtype=np.float64)
    if values.size:
        values /= np.sqrt(np.sum(values * values, axis=axis, keepdims=axis is not None))
    if out is None:
        return values
    out[...] = values
    return None


def random_vector(size: int | tuple[int, ...]) -> Array:
    """Return random numbers from 0 up to 1."""
    return np.random.default_rng().random(size)


def direction_of(vector: ArrayLike) -> Array:
    """Return the direction of the first three components."""
    result: Array = unit_vector(np.asarray(vector, dtype=np.float64)[:3])
    return result


def homogeneous(point: Array) -> Array:
    """Return a point with a fourth coordinate, one."""
    return np.append(point, 1.0)
