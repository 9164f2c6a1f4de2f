"""Numba kernels, cached on disk, and their compilation ahead of the first use.

A kernel is a function over arrays under `compiled`. A package of kernels has a module `warming`, whose generator
`steps` calls them with data of the types of real use, and yields the share done and the name of each next step.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from typing import Any, ParamSpec, TypeVar, overload

from daidalos.common.compiler_memory import release_compiler_memory

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
    _compile_in_one_process(kernel)
    KERNELS.append(kernel)
    return kernel


def _compile_in_one_process(kernel: Any) -> None:
    """Make processes that need the same machine code at the same time wait for the one that compiles it."""
    from numba.core.compiler_lock import global_compiler_lock

    from daidalos.common.kernel_cache import SharedCache

    cache, compile_here = SharedCache(kernel.py_func), kernel.compile

    def compile_once(signature: Any) -> Any:
        with global_compiler_lock:  # the lock on the cache belongs to the thread that compiles
            try:
                return compile_here(signature)
            finally:
                cache.unlock()

    kernel._cache, kernel.compile = cache, compile_once


def warm_up(package: str, progress: Progress = lambda share, step: None, users: Iterable[type] | None = None) -> None:
    """Compile the kernels of a package, so that their first use is as fast as their second.

    Takes a while at the first call on a machine, and a moment afterwards, when the machine code is on disk.

    Parameters
    ----------
    package : str
        As it is imported, such as "daidalos.mapping".
    progress : callable
        Called with the share done, from 0 to 1, and what comes next.
    users
        The classes whose kernels are needed, in packages whose kernels belong to plugins; all kernels where None.
    """
    steps = importlib.import_module(f"{package}.warming").steps
    for share, step in steps() if users is None else steps(tuple(users)):
        progress(share, step)
    release_compiler_memory()
    progress(1.0, "ready")
