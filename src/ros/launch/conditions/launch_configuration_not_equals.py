"""The condition that a launch configuration has any other value than a given one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .launch_configuration_equals import LaunchConfigurationEquals

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Condition that holds if a launch configuration does not have some value; parameters as for its base."""

    def _predicate_func(self, context: LaunchContext) -> bool:
        return not super()._predicate_func(context)
