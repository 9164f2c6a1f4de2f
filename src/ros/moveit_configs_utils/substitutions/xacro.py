"""Substitution that runs xacro: ``$(xacro 'file')`` in XML and YAML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.frontend import expose_substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_param_builder import load_xacro


@expose_substitution("xacro")
class Xacro(Substitution):
    """What xacro makes of a file.

    Parameters
    ----------
    file_path
        The file.
    mappings
        Values of its arguments by name; both may consist of substitutions.
    """

    def __init__(self, file_path: SomeSubstitutionsType, *, mappings: Mapping[Any, Any] | None = None) -> None:
        super().__init__()
        self.__file_path = normalize_to_list_of_substitutions(file_path)
        self.__mappings = dict(mappings or {})

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Xacro], dict[str, Any]]:
        """Return the class and its arguments; raises TypeError unless there is one argument."""
        if len(data) != 1:
            raise TypeError("the substitution 'xacro' expects one argument, the file")
        return cls, {"file_path": data[0]}

    @property
    def file_path(self) -> list[Substitution]:
        """The file."""
        return self.__file_path

    @property
    def mappings(self) -> dict[Any, Any]:
        """Values of arguments by name."""
        return self.__mappings

    def describe(self) -> str:
        """Return a description."""
        path = " + ".join(part.describe() for part in self.file_path)
        mappings = ", ".join(f"{name}:={value}" for name, value in self.mappings.items())
        return f"Xacro(file_path = {path}, mappings = {mappings})"

    def perform(self, context: LaunchContext) -> str:
        """Run xacro."""

        def text(value: Any) -> str:
            return perform_substitutions(context, normalize_to_list_of_substitutions(value))

        mappings = {text(name): text(value) for name, value in self.mappings.items()}
        return load_xacro(Path(text(self.file_path)), mappings)
