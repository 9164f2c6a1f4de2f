"""Check for shutdown, and interfaces of callbacks that extend states."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

_shutdown_check: Callable[[], bool] = bool


def is_shutdown() -> bool:
    """Return whether containers are to end."""
    return _shutdown_check()


def set_shutdown_check(cb: Callable[[], bool]) -> None:
    """Set the function that `is_shutdown` calls."""
    global _shutdown_check
    _shutdown_check = cb


def has_smach_interface(obj: object) -> bool:
    """Return whether an object declares outcomes, input keys and output keys."""
    return all(hasattr(obj, f"get_registered_{what}") for what in ("input_keys", "output_keys", "outcomes"))


class CBInterface:
    """Callback with the outcomes and keys that it adds to the state that calls it.

    Parameters
    ----------
    cb
        The callback.
    outcomes, input_keys, output_keys
        What it adds.
    io_keys
        Keys that are both input and output.
    """

    def __init__(
        self,
        cb: Callable[..., Any],
        outcomes: Iterable[str] | None = None,
        input_keys: Iterable[str] | None = None,
        output_keys: Iterable[str] | None = None,
        io_keys: Iterable[str] | None = None,
    ) -> None:
        both = set(io_keys or ())
        self._outcomes = tuple(outcomes or ())
        self._input_keys = set(input_keys or ()) | both
        self._output_keys = set(output_keys or ()) | both
        self._cb = cb

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Call the callback."""
        return self._cb(*args, **kwargs)

    def get_registered_input_keys(self) -> tuple[str, ...]:
        """Return the input keys."""
        return tuple(self._input_keys)

    def get_registered_output_keys(self) -> tuple[str, ...]:
        """Return the output keys."""
        return tuple(self._output_keys)

    def get_registered_outcomes(self) -> tuple[str, ...]:
        """Return the outcomes."""
        return self._outcomes


class cb_interface:
    """Decorator that makes a `CBInterface` of a callback.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        What the callback adds to the state that calls it.
    """

    def __init__(
        self,
        outcomes: Iterable[str] | None = None,
        input_keys: Iterable[str] | None = None,
        output_keys: Iterable[str] | None = None,
    ) -> None:
        self._interface = (outcomes, input_keys, output_keys)

    def __call__(self, cb: Callable[..., Any]) -> CBInterface:
        """Return the callback with its interface."""
        return CBInterface(cb, *self._interface)
