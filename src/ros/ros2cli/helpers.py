"""Small functions that commands and verbs share."""

from __future__ import annotations

import argparse
import functools
import inspect
import os
import sys
import time
from collections.abc import Callable
from typing import Any


def get_ros_domain_id() -> int:
    """Return the domain of the environment variable ``ROS_DOMAIN_ID``; 0 where it is not set."""
    return int(os.environ.get("ROS_DOMAIN_ID") or 0)


def wait_for(predicate: Callable[[], Any], timeout: float, period: float = 0.1) -> Any:
    """Evaluate a predicate again and again until it is true or time is up; return its last result.

    Parameters
    ----------
    predicate
        The condition.
    timeout
        How long to wait [s of wall time]; negative: without limit.
    period
        Time between evaluations [s of wall time].
    """
    deadline = time.monotonic() + timeout if timeout >= 0 else float("inf")
    while not (result := predicate()):
        if time.monotonic() > deadline:
            return result
        time.sleep(period)
    return True


def bind(func: Callable[..., Any], *args: Any, **kwargs: Any) -> Callable[..., Any]:
    """Return a function that calls another with these arguments before its own, under its name and signature."""
    return _with_signature_of(func, functools.partial(func, *args, **kwargs))


def before_invocation(func: Callable[..., Any], hook: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that calls `hook` before each call of another.

    Parameters
    ----------
    func
        The other function.
    hook
        Called without arguments, or, if it has parameters, as ``hook(func, *args, **kwargs)``.
    """
    takes_call = bool(inspect.signature(hook).parameters)

    def call(*args: Any, **kwargs: Any) -> Any:
        if takes_call:
            hook(func, *args, **kwargs)
        else:
            hook()
        return func(*args, **kwargs)

    return _with_signature_of(func, call)


def _with_signature_of(func: Callable[..., Any], call: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(func)
    def wrapper(*args: Any, **kwargs: Any) -> Any:
        return call(*args, **kwargs)

    wrapper.__signature__ = inspect.signature(func)  # type: ignore[attr-defined]
    return wrapper


def pretty_print_call(func: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
    """Print a function's name and the arguments of a call; a hook for `before_invocation`."""
    arguments = [*map(repr, args), *(f"{name}={value!r}" for name, value in kwargs.items())]
    print(f"{func.__name__}({', '.join(arguments)})")  # noqa: T201


def unsigned_int(string: str) -> int:
    """Return a whole number that is not negative; for argparse."""
    if not (string.strip().isascii() and string.strip().isdigit()):
        raise argparse.ArgumentTypeError("value must be non-negative integer")
    return int(string)


def collect_stdin() -> bytes:
    """Return the whole of standard input."""
    return sys.stdin.buffer.read()
