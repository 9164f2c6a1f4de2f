"""A substitution that replaces text in a file."""

from __future__ import annotations

from launch import Condition, LaunchContext, SomeSubstitutionsType, Substitution
from launch.utilities import normalize_to_list_of_substitutions

from daidalos.common.temporary_files import write_temporary

from ._files import normalize_rewrites, perform_rewrites, read_text


class ReplaceString(Substitution):
    """The path of a copy of a file in which pieces of text are replaced.

    Parameters
    ----------
    source_file
        The file.
    replacements
        What is replaced, by what.
    condition
        When; else the path is that of the file itself.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: dict[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        super().__init__()
        self.__source_file = normalize_to_list_of_substitutions(source_file)
        self.__replacements = normalize_rewrites(replacements)
        self.__condition = condition

    @property
    def name(self) -> list[Substitution]:
        """The file."""
        return self.__source_file

    @property
    def condition(self) -> Condition | None:
        """When text is replaced; always if None."""
        return self.__condition

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"ReplaceString({', '.join(map(repr, self.__replacements))})"

    def perform(self, context: LaunchContext) -> str:
        """Write the copy and return its path."""
        path, text = read_text(context, self.__source_file)
        if self.__condition is not None and not self.__condition.evaluate(context):
            return path
        for old, new in perform_rewrites(context, self.__replacements).items():
            text = text.replace(old, new)
        return str(write_temporary(text, "launch_params_", ".yaml"))
