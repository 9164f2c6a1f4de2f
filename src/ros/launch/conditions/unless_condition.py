"""The condition that a text is false."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .if_condition import IfCondition

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class UnlessCondition(IfCondition):
    """Condition that holds if a text means false; parameters as for `IfCondition`."""

    def _predicate_func(self, context: LaunchContext) -> bool:
        return not super()._predicate_func(context)
