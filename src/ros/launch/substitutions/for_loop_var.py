"""The substitutions that are the values of a loop's present round."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Self

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import perform_substitutions
from ._arguments import describe_text, expect_arguments
from ._named import NamedSubstitution
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("for-var")
class ForEachVar(NamedSubstitution):
    """A value of the present round of a `ForEach` action.

    Parameters
    ----------
    name
        The value's name.
    default_value
        The value in rounds that do not have it. Without one, that is an error.
    """

    frontend_name = "for-var"

    @classmethod
    def get_local_arg_name(cls, name: str) -> str:
        """Return the name under which the loop keeps the value in the context's locals."""
        return f"{cls.__name__}__{name}"

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"{type(self).__name__}({describe_text(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        name = perform_substitutions(context, self.name)
        variables = context.get_locals_as_dict()
        key = self.get_local_arg_name(name)
        if key in variables:
            return str(variables[key])
        if self.default_value is None:
            raise SubstitutionFailure(f"the loop has no value '{name}' in this round, and there is no default")
        return perform_substitutions(context, self.default_value)


@expose_substitution("index")
class ForLoopIndex(ForEachVar):
    """The index of the present round of a `ForLoop` action.

    Parameters
    ----------
    name
        The index's name.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        super().__init__(name)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Self], dict[str, Any]]:
        """Read `$(index name)`."""
        expect_arguments("index", data, 1)
        return cls, {"name": data[0]}
