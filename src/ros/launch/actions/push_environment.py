"""The action that begins a scope of the environment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..action import Action

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class PushEnvironment(Action):
    """Action that saves the environment for `PopEnvironment`; parameters as for `Action`."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    def execute(self, context: LaunchContext) -> None:
        """Save the environment."""
        context._push_environment()
