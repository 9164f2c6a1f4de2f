"""The base of the parsers of launch files in markup, and the search for the right one."""

from __future__ import annotations

import importlib
import importlib.metadata as importlib_metadata
import os
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar, TextIO

from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_file_error import add_location
from ..substitution import Substitution
from ..utilities.type_utils import NormalizedValueType, SomeValueType
from ..utilities.typing_file_path import FilePath
from .entity import Entity
from .expose import instantiate_action
from .parse_substitution import parse_if_substitutions, parse_substitution, replace_escaped_characters

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_description import LaunchDescription

# What is part of the house works without being installed; others come by entry points.
_BUILT_IN_PARSERS = {"xml": "launch_xml", "yaml": "launch_yaml"}
_BUILT_IN_EXTENSIONS = {"launch_ros": "launch_ros.frontend_extension"}


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file in markup could not be read."""


class Parser:
    """Parser of launch files; each language has a subclass with its own `load` and `get_file_extensions`."""

    extensions_loaded: ClassVar[bool] = False
    frontend_parsers: ClassVar[dict[str, type[Parser]] | None] = None

    # Extensions -----------------------------------------------------------------------------------

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Import the packages that add actions and substitutions, so that these are exposed."""
        if Parser.extensions_loaded:
            return
        _load_all("launch.frontend.launch_extension", "launch extension", _BUILT_IN_EXTENSIONS)
        Parser.extensions_loaded = True

    @classmethod
    def load_parser_implementations(cls) -> None:
        """Find the parsers of all markup languages."""
        if Parser.frontend_parsers is None:
            found = _load_all("launch.frontend.parser", "parser", _BUILT_IN_PARSERS)
            Parser.frontend_parsers = {name: getattr(parser, "Parser", parser) for name, parser in found.items()}

    # From elements to actions ---------------------------------------------------------------------

    def parse_action(self, entity: Entity) -> Action:
        """Create the action that an element stands for."""
        location = getattr(entity, "location", (None, None))
        try:
            action = instantiate_action(entity, self)
            entity.assert_entity_completely_parsed()
        except Exception as error:
            add_location(error, *location)
            raise
        if location != (None, None):
            action.origin = location
        return action

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Return the substitutions in a text."""
        return parse_substitution(value)

    def parse_if_substitutions(self, value: SomeValueType) -> NormalizedValueType:
        """Return a value whose texts are replaced by the substitutions in them."""
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """Return a text in which every escaped character stands for itself."""
        return replace_escaped_characters(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """Create the launch description of a whole file, given its root element.

        Raises
        ------
        RuntimeError
            If the root element is not `launch`.
        """
        from ..launch_description import LaunchDescription

        if entity.type_name != "launch":
            error = RuntimeError(f"Expected 'launch' as root element, got '{entity.type_name[:100]}'")
            add_location(error, *getattr(entity, "location", (None, None)))
            raise error
        deprecated = entity.get_attr("deprecated", optional=True)
        actions = [self.parse_action(child) for child in entity.children]
        return LaunchDescription(actions, deprecated_reason=deprecated)

    # From files to elements -----------------------------------------------------------------------

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the file extensions of all parsers."""
        return sorted(cls.get_file_extensions_from_parsers())

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        """Return whether some parser is for this file extension."""
        return extension in cls.get_file_extensions_from_parsers()

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser] | None:
        """Return the parser for a file extension.

        Raises
        ------
        RuntimeError
            If there is none.
        """
        for parser in cls._parsers():
            if extension in parser.get_file_extensions():
                return parser
        raise RuntimeError(f"no parser is for launch files with the extension '{extension}'")

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return by a file's name whether this parser may be for it."""
        return filename.endswith(tuple(f".{extension}" for extension in cls.get_file_extensions()))

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        """Return whether some parser may be for a file of this name."""
        return any(parser.may_parse(filename) for parser in cls._parsers())

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type[Parser]]:
        """Return the parsers that may be for a file of this name."""
        return [parser for parser in cls._parsers() if parser.may_parse(filename)]

    @classmethod
    def get_file_extensions_from_parsers(cls) -> set[str]:
        """Return the file extensions of all parsers."""
        return {extension for parser in cls._parsers() for extension in parser.get_file_extensions()}

    @classmethod
    def _parsers(cls) -> Iterable[type[Parser]]:
        cls.load_parser_implementations()
        return (Parser.frontend_parsers or {}).values()

    @classmethod
    def load(cls, file: FilePath | TextIO) -> tuple[Entity, Parser]:
        """Read a launch file in any markup language.

        Parameters
        ----------
        file
            Its path, or an open text file.

        Returns
        -------
            The root element and the parser for it.

        Raises
        ------
        InvalidFrontendLaunchFileError
            If no parser can read it.
        """
        if isinstance(file, str | bytes | os.PathLike):
            with open(file, encoding="utf-8") as opened:
                return cls.load(opened)
        cls.load_launch_extensions()
        cls.load_parser_implementations()

        filename = getattr(file, "name", "")
        filename = filename if isinstance(filename, str) else ""
        named = cls.get_parsers_from_filename(filename)
        errors: list[Exception] = []
        for parser in named or cls._parsers():
            try:
                return parser.load(file)
            # Any parser may fail in its own way on a file that is not for it.
            except Exception as error:
                errors.append(error)
                file.seek(0)
        raise InvalidFrontendLaunchFileError(_extension(filename), likely_errors=errors)

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the extensions, without a leading dot, of the files that this parser is for."""
        return set()


def _extension(filename: str) -> str:
    return os.path.splitext(filename)[1].lstrip(".")


def _load_all(group: str, kind: str, built_in: dict[str, str]) -> dict[str, Any]:
    """Import what is built in, and then what the entry points of a group name beyond that."""
    found: dict[str, Any] = {}
    for name, module in built_in.items():
        try:
            found[name] = importlib.import_module(module)
        except ImportError as error:
            warnings.warn(f"Failed to load the {kind} '{name}': {error}", stacklevel=3)
    for entry_point in _entry_points(group):
        if entry_point.name in found:
            continue
        try:
            found[entry_point.name] = entry_point.load()
        # Somebody else's package must not keep launch files from being read.
        except Exception as error:
            warnings.warn(f"Failed to load the {kind} '{entry_point.name}': {error}", stacklevel=3)
    return found


def _entry_points(group: str) -> Iterable[Any]:
    entry_points = importlib_metadata.entry_points()
    if hasattr(entry_points, "select"):
        return entry_points.select(group=group)
    return entry_points.get(group, ())
