"""The substitution that is the value of a parameter set for all nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch.frontend.expose import expose_substitution
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from launch import LaunchContext


@expose_substitution("param")
class Parameter(Substitution):
    """The value that `SetParameter` gave a parameter in the present scope.

    Parameters
    ----------
    name
        The parameter's name.
    default
        The text where it was not set. Without one, that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default = None if default is None else normalize_to_list_of_substitutions(default)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Parameter], dict[str, Any]]:
        """Read `$(param name default)`."""
        if not 1 <= len(data) <= 2:
            raise TypeError(f"$(param ...) takes 1 to 2 arguments, but it was given {len(data)}")
        kwargs = {"name": data[0]}
        if len(data) == 2:
            kwargs["default"] = data[1]
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The parameter's name."""
        return self.__name

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"Parameter({' + '.join(sub.describe() for sub in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        name = perform_substitutions(context, self.name)
        values = {
            entry[0]: entry[1]
            for entry in context.launch_configurations.get("global_params", [])
            if isinstance(entry, tuple)
        }
        if name in values:
            return str(values[name])
        if self.__default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self.__default)
