"""The action that removes an environment variable."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_action
from ..utilities import perform_substitutions
from ._named import NamedAction

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_action("unset_env")
class UnsetEnvironmentVariable(NamedAction):
    """Action that removes an environment variable for the processes started later; one that is not set may be removed.

    Parameters
    ----------
    name
        Its name.
    **kwargs
        As for `Action`.
    """

    def execute(self, context: LaunchContext) -> None:
        """Remove the environment variable."""
        context.environment.pop(perform_substitutions(context, self.name), None)
