"""Common base of substitutions by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions
from ._arguments import expect_arguments


class NamedSubstitution(Substitution):
    """The value of what has a name.

    Parameters
    ----------
    name
        Its name.
    default_value
        Its value where there is none. Without one, that is an error.
    """

    frontend_name: str

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Self], dict[str, Any]]:
        """Read `$(env name default)` or its like."""
        expect_arguments(cls.frontend_name, data, 1, 2)
        kwargs = {"name": data[0]}
        if len(data) == 2:
            kwargs["default_value"] = data[1]
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """Its name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """Its value where there is none."""
        return self.__default_value
