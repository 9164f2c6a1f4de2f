"""The substitution that chooses between two texts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .boolean_substitution import perform_bool

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("if")
class IfElseSubstitution(Substitution):
    """One text if a condition is true, another if not.

    Parameters
    ----------
    condition
        The condition.
    if_value, else_value
        The texts; at least one must be given.
    """

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == "" and else_value == "":
            raise RuntimeError("one of if_value and else_value must be given")
        self.__condition = normalize_to_list_of_substitutions(condition)
        self.__if_value = normalize_to_list_of_substitutions(if_value)
        self.__else_value = normalize_to_list_of_substitutions(else_value)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[IfElseSubstitution], dict[str, Any]]:
        """Read `$(if condition if_value else_value)`."""
        expect_arguments("if", data, 2, 3)
        kwargs = {"condition": data[0], "if_value": data[1]}
        if len(data) == 3:
            kwargs["else_value"] = data[2]
        return cls, kwargs

    @property
    def condition(self) -> list[Substitution]:
        """The condition."""
        return self.__condition

    @property
    def if_value(self) -> list[Substitution]:
        """The text if the condition is true."""
        return self.__if_value

    @property
    def else_value(self) -> list[Substitution]:
        """The text if it is not."""
        return self.__else_value

    def describe(self) -> str:
        """Return the substitution in words."""
        return (
            f"IfElseSubstitution({describe_text(self.condition)}, {describe_text(self.if_value)}, "
            f"{describe_text(self.else_value)})"
        )

    def perform(self, context: LaunchContext) -> str:
        """Choose."""
        chosen = self.if_value if perform_bool(context, self.condition) else self.else_value
        return perform_substitutions(context, chosen)
