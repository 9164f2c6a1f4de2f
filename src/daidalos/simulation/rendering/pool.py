"""Pool of large arrays, whose allocation would cost more than drawing into them."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

_KEPT = 16
"""Arrays of one shape that are kept: about as many as cameras fill at one instant."""
_UNUSED = 3
"""References to an array that nobody else holds: the list's, the loop's and that of the question itself."""


class Pool:
    """Pool of uninitialized arrays; an array returns to it with its last reference."""

    def __init__(self) -> None:
        self._arrays: dict[tuple[tuple[int, ...], np.dtype[Any]], list[NDArray[Any]]] = {}

    def take(self, shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
        """Return an unused array of a shape."""
        arrays = self._arrays.setdefault((shape, np.dtype(dtype)), [])
        for array in arrays:
            if sys.getrefcount(array) <= _UNUSED:
                return array
        fresh = np.empty(shape, dtype=dtype)
        if len(arrays) < _KEPT:
            arrays.append(fresh)
        return fresh
