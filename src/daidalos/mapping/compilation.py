"""How the hot loops of this layer are compiled: by numba, cached on disk, for one thread, without the GIL."""

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

import numba

P = ParamSpec("P")
R = TypeVar("R")

KERNELS: list[Any] = []
"""Every compiled function that was imported so far, for those who want to know whether all are ready."""


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function over arrays at its first call and keep the machine code for the next process."""
    kernel = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    KERNELS.append(kernel)
    return cast("Callable[P, R]", kernel)
