"""The action that sets an environment variable."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_action
from ..utilities import perform_substitutions
from ._named import NamedValueAction

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_action("set_env")
class SetEnvironmentVariable(NamedValueAction):
    """Action that sets an environment variable for the processes started later.

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
        """Set the environment variable."""
        name = perform_substitutions(context, self.name)
        context.environment[name] = perform_substitutions(context, self.value)
