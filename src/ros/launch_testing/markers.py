"""Marks of test descriptions and of tests."""

from __future__ import annotations

import functools
import time
import unittest
from collections.abc import Callable
from typing import Any, TypeVar, cast

T = TypeVar("T", bound=Callable[..., Any])


def keep_alive(test_description: T) -> T:
    """Extend a launch until its tests are done, although its processes have all ended."""
    markers = getattr(test_description, "__markers__", {})
    markers["keep_alive"] = True
    test_description.__markers__ = markers  # type: ignore[attr-defined]  # marks the function
    return test_description


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[T], T]:
    """Return a decorator that runs a test again when it fails.

    Parameters
    ----------
    times
        How often it is run at most.
    delay
        Seconds to wait before it is run again.
    """
    if times < 1:
        raise ValueError("a test must be run at least once")

    def decorator(test: T) -> T:
        @functools.wraps(test)
        def wrapper(self: unittest.TestCase, *args: Any, **kwargs: Any) -> Any:
            for attempt in range(times):
                try:
                    return test(self, *args, **kwargs)
                except AssertionError:
                    if attempt + 1 == times:
                        raise
                    if delay is not None:
                        time.sleep(delay)
            return None

        return cast("T", wrapper)

    return decorator
