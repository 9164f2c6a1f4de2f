"""The action that removes a launch configuration."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_action
from ..utilities import perform_substitutions
from ._named import NamedAction

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_action("unlet")
class UnsetLaunchConfiguration(NamedAction):
    """Action that removes a launch configuration; one that is not set may be removed.

    Parameters
    ----------
    name
        Its name.
    **kwargs
        As for `Action`.
    """

    def execute(self, context: LaunchContext) -> None:
        """Remove the launch configuration."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)
