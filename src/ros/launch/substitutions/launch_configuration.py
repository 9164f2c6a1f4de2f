"""The substitution that is the value of a launch configuration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("var")
class LaunchConfiguration(Substitution):
    """The value of a launch configuration: an argument of the launch, or a variable set in it.

    Parameters
    ----------
    variable_name
        The configuration's name.
    default
        The value where it is not set; may be anything that has a text. Without one, that is an error.
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any | Iterable[Any] | None = None) -> None:
        self.__variable_name = normalize_to_list_of_substitutions(variable_name)
        self.__default = None if default is None else _as_substitutions(default)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[LaunchConfiguration], dict[str, Any]]:
        """Read `$(var name default)`."""
        expect_arguments("var", data, 1, 2)
        kwargs: dict[str, Any] = {"variable_name": data[0]}
        if len(data) == 2:
            kwargs["default"] = data[1]
        return cls, kwargs

    @property
    def variable_name(self) -> list[Substitution]:
        """The configuration's name."""
        return self.__variable_name

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"LaunchConfig({describe_text(self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the configuration's value."""
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.__default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist")
        return perform_substitutions(context, self.__default)


def _as_substitutions(default: Any) -> list[Substitution]:
    several = isinstance(default, Iterable) and not isinstance(default, str)
    items = list(default) if several else [default]
    return normalize_to_list_of_substitutions(
        item if isinstance(item, str | Path | Substitution) else str(item) for item in items
    )
