"""Numba kernels, cached on disk, and their compilation ahead of the first use.

A kernel is a function over arrays under `compiled`. A package of kernels has a module `warming`, whose generator
`steps` calls each of them with data of the types of real use, and yields the share done and the name of each next step.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, overload

P = ParamSpec("P")
R = TypeVar("R")

KERNELS: list[Any] = []
"""Every kernel of the modules imported so far."""

Progress = Callable[[float, str], None]
"""Takes the share done, from 0 to 1, and the name of the next step."""


@overload
def compiled(function: Callable[P, R]) -> Callable[P, R]: ...
@overload
def compiled(*, fastmath: bool = False, inline: bool = False) -> Callable[[Callable[P, R]], Callable[P, R]]: ...
def compiled(function: Callable[..., Any] | None = None, *, fastmath: bool = False, inline: bool = False) -> Any:
    """Compile a function over arrays at its first call and keep the machine code for the next process.

    The kernel uses one thread, releases the GIL, and divides by zero as numpy does.

    Parameters
    ----------
    function : callable
        Omitted where the decorator is used with options.
    fastmath : bool
        Whether sums may be taken in any order and NaN ignored.
    inline : bool
        Whether the code is put into that of each calling kernel.
    """
    if function is None:
        return lambda function: _compile(function, fastmath, inline)
    return _compile(function, fastmath, inline)


def _compile(function: Callable[..., Any], fastmath: bool, inline: bool) -> Any:
    import numba

    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
    kernel = numba.njit(fastmath=fastmath, inline="always" if inline else "never", **options)(function)
    KERNELS.append(kernel)
    return kernel


def warm_up(package: str, progress: Progress = lambda share, step: None) -> None:
    """Compile every kernel of a package, so that its first use is as fast as its second.

    Takes a while at the first call on a machine, and a moment afterwards, when the machine code is on disk.

    Parameters
    ----------
    package : str
        As it is imported, such as "daidalos.mapping".
    progress : callable
        Called with the share done, from 0 to 1, and what comes next.
    """
    for share, step in importlib.import_module(f"{package}.warming").steps():
        progress(share, step)
    progress(1.0, "ready")
