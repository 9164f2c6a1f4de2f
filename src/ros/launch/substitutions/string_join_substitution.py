"""The substitution that joins texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("string-join")
class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them.

    Parameters
    ----------
    substitutions
        The texts, each of which may itself be made of several pieces.
    delimiter
        What stands between two of them.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self.__substitutions = [normalize_to_list_of_substitutions(text) for text in substitutions]
        self.__delimiter = normalize_to_list_of_substitutions(delimiter)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[StringJoinSubstitution], dict[str, Any]]:
        """Read `$(string-join delimiter text ...)`."""
        if len(data) < 2:
            raise TypeError(f"$(string-join ...) takes a delimiter and texts, but it was given {len(data)} arguments")
        return cls, {"delimiter": data[0], "substitutions": data[1:]}

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The texts."""
        return self.__substitutions

    @property
    def delimiter(self) -> list[Substitution]:
        """What stands between two of them."""
        return self.__delimiter

    def describe(self) -> str:
        """Return the substitution in words."""
        texts = ", ".join(describe_text(text) for text in self.substitutions)
        return f"StringJoin({texts}, delimiter={describe_text(self.delimiter)})"

    def perform(self, context: LaunchContext) -> str:
        """Join the texts."""
        delimiter = perform_substitutions(context, self.delimiter)
        return delimiter.join(perform_substitutions(context, text) for text in self.substitutions)
