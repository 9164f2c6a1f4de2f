"""How the loops over pixels are compiled: by numba, cached on disk, for one thread, without the GIL."""

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

import numba

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function over arrays at its first call and keep the machine code for the next process."""
    return cast("Callable[P, R]", numba.njit(cache=True, nogil=True, error_model="numpy")(function))


def compiled_loosely(function: Callable[P, R]) -> Callable[P, R]:
    """As `compiled`; sums may be taken in any order, which colours do not mind."""
    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": True}
    return cast("Callable[P, R]", numba.njit(**options)(function))


def compiled_in_place(function: Callable[P, R]) -> Callable[P, R]:
    """As `compiled_loosely`, put into the code of the caller: for what every pixel calls."""
    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": True}
    return cast("Callable[P, R]", numba.njit(inline="always", **options)(function))
