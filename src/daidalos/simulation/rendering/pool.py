"""Large arrays that are used again once nobody holds them: fresh memory costs more than what is drawn into it."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

_KEPT = 4
_UNUSED = 3
"""References to an array that nobody else holds: the list's, the loop's and that of the question itself."""


class Pool:
    """Hands out arrays with anything in them; one comes back by itself when the last reference to it goes."""

    def __init__(self) -> None:
        self._arrays: dict[tuple[tuple[int, ...], np.dtype[Any]], list[NDArray[Any]]] = {}

    def take(self, shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
        """Return an array (shape) that is nobody's."""
        arrays = self._arrays.setdefault((shape, np.dtype(dtype)), [])
        for array in arrays:
            if sys.getrefcount(array) <= _UNUSED:
                return array
        fresh = np.empty(shape, dtype=dtype)
        if len(arrays) < _KEPT:
            arrays.append(fresh)
        return fresh
