"""The substitution that is the value of an environment variable."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("env")
class EnvironmentVariable(Substitution):
    """The value of a variable of the launch's environment.

    Parameters
    ----------
    name
        The variable's name.
    default_value
        The value where it is not set. Without one, that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[EnvironmentVariable], dict[str, Any]]:
        """Read `$(env name default)`."""
        expect_arguments("env", data, 1, 2)
        kwargs = {"name": data[0]}
        if len(data) == 2:
            kwargs["default_value"] = data[1]
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The variable's name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The value where the variable is not set."""
        return self.__default_value

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
