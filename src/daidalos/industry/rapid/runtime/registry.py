"""Registry of the predefined routines that run: each is a function of Python with the name of the routine.

A routine gets the task, and an argument per parameter, named as the parameter in lower case with an underscore behind
it. Optional parameters that are not given are None. What a routine may change is a reference, for data with one value,
or the record or array itself.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any, TypeVar

Implementation = TypeVar("Implementation", bound=Callable[..., Any])

_routines: dict[str, Callable[..., Any]] = {}
_MODULES = (
    "mathematics", "strings", "positions", "signals", "dialogs", "timing", "movements", "interrupts", "bytes", "files",
    "sockets", "triggers", "searches", "synchronising", "controller",
    "arm_functions", "welding", "world_zones",
)  # fmt: skip
_TIMED = ("signals", "dialogs", "timing", "interrupts", "files", "sockets")
_TIMED_ROUTINES = (
    "crobt",
    "cjointt",
    "cpos",
    "pdispon",
    "stopmove",
    "startmove",
    "stopmovereset",
    "clearpath",
    "waitsynctask",
)


def routine(*names: str) -> Callable[[Implementation], Implementation]:
    """Register a function as a predefined routine under its names in RAPID."""

    def register(function: Implementation) -> Implementation:
        for name in names:
            _routines[name.lower()] = function
        return function

    return register


@functools.cache
def _load() -> None:
    for name in _MODULES:
        importlib.import_module(f"daidalos.industry.rapid.runtime.{name}")


def find_routine(key: str) -> Callable[..., Any] | None:
    """Return the function of a predefined routine, by its name in lower case; None where it does not run."""
    _load()
    return _routines.get(key)


def routines() -> dict[str, Callable[..., Any]]:
    """Return all predefined routines that run."""
    _load()
    return dict(_routines)


def is_timed(key: str) -> bool:
    """Return whether the effect or the result of a routine depends on when it runs."""
    function = _routines.get(key)
    module = function.__module__.rpartition(".")[2] if function is not None else ""
    return module in _TIMED or key in _TIMED_ROUTINES
