"""The default context, and questions about the process."""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from daidalos.transport.environment import read_environment
from daidalos.transport.shared import installed_middlewares
from rclpy.constants import S_TO_NS

if TYPE_CHECKING:
    from rclpy.context import Context

g_default_context: Context | None = None
g_context_lock = threading.Lock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the context that is used where none is given; with `shutting_down` it is forgotten.

    Raises
    ------
    RuntimeError
        When it is to be forgotten and there is none.
    """
    from rclpy.context import Context

    global g_default_context
    with g_context_lock:
        if g_default_context is None:
            if shutting_down:
                raise RuntimeError("Shutting down the default context, but no default context was created yet")
            g_default_context = Context()
        elif shutting_down:
            old, g_default_context = g_default_context, None
            return old
        return g_default_context


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return the arguments (of the process where None) without those between ``--ros-args`` and ``--``.

    Raises
    ------
    RuntimeError
        When there is none at all, not even the program's name.
    """
    from rclpy.impl.arguments import split_ros_args

    given = sys.argv if args is None else args
    if not given:
        raise RuntimeError("there are no arguments, not even the program's name")
    return split_ros_args(given)[1]


def ok(*, context: Context | None = None) -> bool:
    """Return whether a context (the default one where None) is between `init` and `shutdown`."""
    return (context or get_default_context()).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut down a context, by default the default one.

    Raises
    ------
    RuntimeError
        When there is nothing to end.
    """
    (context or get_default_context(shutting_down=True)).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut down a context, by default the default one, unless that was done before."""
    (context or get_default_context()).try_shutdown()


def get_rmw_implementation_identifier() -> str:
    """Return the name of the middleware in use."""
    return read_environment().middleware


def get_available_rmw_implementations() -> set[str]:
    """Return the names of the middlewares that are installed and reach other processes."""
    return set(installed_middlewares())


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Return a timeout in nanoseconds; -1, for ever, where it is None or negative."""
    if timeout_sec is None or timeout_sec < 0:
        return -1
    return int(float(timeout_sec) * S_TO_NS)
