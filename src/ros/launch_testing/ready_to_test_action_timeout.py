"""Timeout of a test's wait for its processes to be ready."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T", bound=Callable[..., Any])

TIMEOUT_ATTRIBUTE = "__ready_to_test_action_timeout__"


def ready_to_test_action_timeout(timeout: float) -> Callable[[T], T]:
    """Return a decorator that sets the seconds to wait for the `ReadyToTest` action of a test description."""

    def decorator(function: T) -> T:
        setattr(function, TIMEOUT_ATTRIBUTE, timeout)
        return function

    return decorator
