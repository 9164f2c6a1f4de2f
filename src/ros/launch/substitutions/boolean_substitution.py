"""The substitutions that combine truths; each yields 'true' or 'false'."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions
from ..utilities.type_utils import perform_typed_substitution
from ._arguments import describe_text, expect_arguments
from ._pair import PairSubstitution
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


def perform_bool(context: LaunchContext, value: list[Substitution]) -> bool:
    """Evaluate a text that means true or false.

    Raises
    ------
    SubstitutionFailure
        If it means neither.
    """
    try:
        return bool(perform_typed_substitution(context, value, bool))
    except (TypeError, ValueError) as error:
        raise SubstitutionFailure(f"{describe_text(value)} is neither true nor false: {error}") from error


def _as_text(value: bool) -> str:
    return str(value).lower()


@expose_substitution("not")
class NotSubstitution(Substitution):
    """The opposite of a truth.

    Parameters
    ----------
    value
        What is to be negated.
    """

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.__value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[NotSubstitution], dict[str, Any]]:
        """Read `$(not value)`."""
        expect_arguments("not", data, 1)
        return cls, {"value": data[0]}

    @property
    def value(self) -> list[Substitution]:
        """What is to be negated."""
        return self.__value

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"{type(self).__name__}({describe_text(self.value)})"

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return _as_text(not perform_bool(context, self.value))


class _BinaryBoolean(PairSubstitution):
    """Two truths."""

    def _perform_both(self, context: LaunchContext) -> tuple[bool, bool]:
        return perform_bool(context, self.left), perform_bool(context, self.right)


@expose_substitution("and")
class AndSubstitution(_BinaryBoolean):
    """True if two truths are."""

    frontend_name = "and"

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return _as_text(all(self._perform_both(context)))


@expose_substitution("or")
class OrSubstitution(_BinaryBoolean):
    """True if one of two truths is."""

    frontend_name = "or"

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return _as_text(any(self._perform_both(context)))


class _VariadicBoolean(Substitution):
    """Any number of truths.

    Parameters
    ----------
    *args
        The truths.
    """

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.__args = [normalize_to_list_of_substitutions(arg) for arg in args]

    @classmethod
    def parse(
        cls, data: Iterable[SomeSubstitutionsType]
    ) -> tuple[type[_VariadicBoolean], Iterable[SomeSubstitutionsType], dict[str, Any]]:
        """Read `$(name value ...)`."""
        return cls, data, {}

    @property
    def args(self) -> list[list[Substitution]]:
        """The truths."""
        return self.__args

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"{type(self).__name__}({' '.join(describe_text(arg) for arg in self.args)})"

    def _perform_all(self, context: LaunchContext) -> list[bool]:
        return [perform_bool(context, arg) for arg in self.args]


@expose_substitution("any")
class AnySubstitution(_VariadicBoolean):
    """True if at least one of some truths is."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return _as_text(any(self._perform_all(context)))


@expose_substitution("all")
class AllSubstitution(_VariadicBoolean):
    """True if all of some truths are."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return _as_text(all(self._perform_all(context)))
