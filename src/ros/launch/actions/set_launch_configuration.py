"""The action that sets a launch configuration."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_action
from ..utilities import perform_substitutions
from ._named import NamedValueAction

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_action("let")
class SetLaunchConfiguration(NamedValueAction):
    """Action that sets a launch configuration.

    Parameters
    ----------
    name
        Its name.
    value
        Its value.
    **kwargs
        As for `Action`.
    """

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration."""
        name = perform_substitutions(context, self.name)
        context.launch_configurations[name] = perform_substitutions(context, self.value)
