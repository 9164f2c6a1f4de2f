"""The action that begins a scope of the launch configurations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..action import Action

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class PushLaunchConfigurations(Action):
    """Action that saves the launch configurations for `PopLaunchConfigurations`; parameters as for `Action`."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    def execute(self, context: LaunchContext) -> None:
        """Save the launch configurations."""
        context._push_launch_configurations()
