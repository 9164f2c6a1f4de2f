"""The substitutions that are paths."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions
from ._arguments import describe_text

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("path-join")
class PathJoinSubstitution(Substitution):
    """Parts joined to a path; the operator `/` appends another part.

    Parameters
    ----------
    substitutions
        The parts, each a text that may itself be made of several pieces.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.__substitutions = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[PathJoinSubstitution], dict[str, Any]]:
        """Read `$(path-join part ...)`."""
        return cls, {"substitutions": data}

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts."""
        return self.__substitutions

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Append a part."""
        return PathJoinSubstitution([*self.substitutions, additional_path])

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"PathJoin({', '.join(describe_text(part) for part in self.substitutions)})"

    def perform(self, context: LaunchContext) -> str:
        """Join the parts."""
        return os.path.join(*("".join(piece.perform(context) for piece in part) for part in self.substitutions))


class PathSubstitution(PathJoinSubstitution):
    """A path to which `/` appends further parts.

    Parameters
    ----------
    path
        The path to begin with.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])
