"""The base of all conditions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Condition:
    """A question that an action asks before it is executed.

    Parameters
    ----------
    predicate
        Answers the question for a launch context. Without one the answer is no.
    """

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def describe(self) -> str:
        """Return a short text that distinguishes this condition from others."""
        return repr(self)

    def evaluate(self, context: LaunchContext) -> bool:
        """Evaluate the condition."""
        return self._predicate is not None and self._predicate(context)
