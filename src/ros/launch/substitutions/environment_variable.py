"""The substitution that is the value of an environment variable."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_substitution
from ..utilities import perform_substitutions
from ._arguments import describe_text
from ._named import NamedSubstitution
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("env")
class EnvironmentVariable(NamedSubstitution):
    """The value of a variable of the launch's environment.

    Parameters
    ----------
    name
        The variable's name.
    default_value
        The value where it is not set. Without one, that is an error.
    """

    frontend_name = "env"

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"EnvVar({describe_text(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the variable's value."""
        name = perform_substitutions(context, self.name)
        value = context.environment.get(name)
        if value is not None:
            return value
        if self.default_value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return perform_substitutions(context, self.default_value)
