"""The substitution that is what a file holds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("file-content")
class FileContent(Substitution):
    """The text in a file.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.__path = normalize_to_list_of_substitutions(path)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[FileContent], dict[str, Any]]:
        """Read `$(file-content path)`."""
        expect_arguments("file-content", data, 1)
        return cls, {"path": data[0]}

    @property
    def path(self) -> list[Substitution]:
        """The file."""
        return self.__path

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"FileContent({describe_text(self.path)})"

    def perform(self, context: LaunchContext) -> str:
        """Read the file."""
        path = perform_substitutions(context, self.path)
        try:
            with open(path, encoding="utf-8") as file:
                return file.read()
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"File not found: {path}") from error
        except (OSError, UnicodeDecodeError) as error:
            raise SubstitutionFailure(f"the file '{path}' cannot be read: {error}") from error
