"""The substitution that is the path of a program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .._programs import which
from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("find-exec")
class FindExecutable(Substitution):
    """The path of a program on the PATH.

    Parameters
    ----------
    name
        The program's name.
    """

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[FindExecutable], dict[str, Any]]:
        """Read `$(find-exec name)`."""
        expect_arguments("find-exec", data, 1)
        return cls, {"name": data[0]}

    @property
    def name(self) -> list[Substitution]:
        """The program's name."""
        return self.__name

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"FindExec({describe_text(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Find the program."""
        name = perform_substitutions(context, self.name)
        path = which(name, context.environment)
        if path is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return path
