"""The parser of launch files in YAML."""

from __future__ import annotations

import os
from typing import TextIO

from launch.frontend.parser import Parser as BaseParser
from launch.launch_file_error import LaunchFileError
from launch.utilities.typing_file_path import FilePath

from ._reader import read_yaml
from .entity import Entity


class Parser(BaseParser):
    """Parser of launch files in YAML."""

    @classmethod
    def load(cls, file: FilePath | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of a launch file and the parser for it.

        Parameters
        ----------
        file
            Its path, or an open text file.

        Raises
        ------
        LaunchFileError
            If it is malformed, or if it does not consist of one root element.
        """
        if isinstance(file, str | bytes | os.PathLike):
            with open(file, encoding="utf-8") as opened:
                return cls.load(opened)
        cls.load_launch_extensions()
        filename = getattr(file, "name", None)
        filename = os.fspath(filename) if isinstance(filename, str) else None
        tree = read_yaml(file.read(), filename)
        if not isinstance(tree, dict) or len(tree) != 1 or not isinstance(next(iter(tree)), str):
            raise LaunchFileError(filename, None, "Expected one root element: `launch:` with a list below it")
        type_name, element = next(iter(tree.items()))
        if not isinstance(element, list | dict):
            raise LaunchFileError(filename, None, f"Expected a list below `{type_name}:`, got {type(element).__name__}")
        return Entity(element, type_name), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the extensions of launch files in YAML."""
        return {"yaml", "yml", "launch.yaml", "launch.yml"}
