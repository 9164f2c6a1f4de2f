"""Translators of interface files, which packages add as entry points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar, cast

from rosidl_cli.extensions import Extension, load_extensions

TRANSLATORS = "rosidl_cli.command.translate.extensions"


class TranslateCommandExtension(Extension):
    """Translator of interface files of `input_format` to `output_format`."""

    input_format: ClassVar[str]
    output_format: ClassVar[str]

    def translate(
        self, package_name: str, interface_files: list[str], include_paths: list[str], output_path: Path
    ) -> list[str]:
        """Write translated files, each to its own relative path, and return these as ``folder:path``.

        Parameters
        ----------
        package_name
            The package that the files belong to.
        interface_files
            The files; see `rosidl_cli.command.helpers.interface_path_as_tuple`.
        include_paths
            Folders with the interface files of other packages.
        output_path
            Folder to write to.
        """
        raise NotImplementedError


def load_translate_extensions(*, specs: Sequence[str] | None, strict: bool) -> list[TranslateCommandExtension]:
    """Return the translators; see `rosidl_cli.extensions.load_extensions`."""
    return cast("list[TranslateCommandExtension]", load_extensions(TRANSLATORS, specs=specs, strict=strict))
