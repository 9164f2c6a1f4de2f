"""The mark of tests that run after the processes have ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T", bound=type)


def post_shutdown_test() -> Callable[[T], T]:
    """Return a decorator for test classes that are to run after the processes have ended."""

    def decorator(test_class: T) -> T:
        test_class.__post_shutdown_test__ = True  # type: ignore[attr-defined]  # marks the class
        return test_class

    return decorator
