"""Common base of substitutions of two values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions
from ._arguments import describe_text, expect_arguments


class PairSubstitution(Substitution):
    """Substitution that is computed from two values.

    Parameters
    ----------
    left, right
        The values.
    """

    frontend_name: str

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        self.__left = normalize_to_list_of_substitutions(left)
        self.__right = normalize_to_list_of_substitutions(right)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Self], dict[str, Any]]:
        """Read `$(name left right)`."""
        expect_arguments(cls.frontend_name, data, 2)
        return cls, {"left": data[0], "right": data[1]}

    @property
    def left(self) -> list[Substitution]:
        """The first."""
        return self.__left

    @property
    def right(self) -> list[Substitution]:
        """The second."""
        return self.__right

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"{type(self).__name__}({describe_text(self.left)} {describe_text(self.right)})"
