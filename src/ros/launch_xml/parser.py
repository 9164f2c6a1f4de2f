"""The parser of launch files in XML; it also takes those of ROS 1."""

from __future__ import annotations

import os
from typing import TextIO

from launch.frontend.parser import Parser as BaseParser
from launch.utilities.typing_file_path import FilePath

from ._reader import read_xml
from .entity import Entity


class Parser(BaseParser):
    """Parser of launch files in XML."""

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
            If it is not well formed.
        """
        if isinstance(file, str | bytes | os.PathLike):
            with open(file, encoding="utf-8") as opened:
                return cls.load(opened)
        cls.load_launch_extensions()
        filename = getattr(file, "name", None)
        root = read_xml(file.read(), os.fspath(filename) if isinstance(filename, str) else None)
        from . import ros1

        if ros1.is_ros1(root):
            from .ros1 import actions as actions  # exposes what translated files are made of

            root = ros1.translate(root)
        return Entity(root), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the extensions of launch files in XML."""
        return {"xml", "launch", "launch.xml"}
