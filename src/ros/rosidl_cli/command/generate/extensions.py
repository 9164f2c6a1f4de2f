"""Generators of source code, which packages add as entry points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import cast

from rosidl_cli.extensions import Extension, load_extensions

TYPES = "rosidl_cli.command.generate.type_extensions"
TYPESUPPORTS = "rosidl_cli.command.generate.typesupport_extensions"


class GenerateCommandExtension(Extension):
    """Generator of source code from interface files."""

    def generate(
        self, package_name: str, interface_files: list[str], include_paths: list[str], output_path: Path
    ) -> list[str]:
        """Write source code and return the paths of its files.

        Parameters
        ----------
        package_name
            The package that the code is for.
        interface_files
            Its interface files; see `rosidl_cli.command.helpers.interface_path_as_tuple`.
        include_paths
            Folders with the interface files of other packages.
        output_path
            Where the code goes.
        """
        raise NotImplementedError


def load_type_extensions(*, specs: Sequence[str] | None, strict: bool) -> list[GenerateCommandExtension]:
    """Return the generators of classes; see `rosidl_cli.extensions.load_extensions`."""
    return cast("list[GenerateCommandExtension]", load_extensions(TYPES, specs=specs, strict=strict))


def load_typesupport_extensions(*, specs: Sequence[str] | None, strict: bool) -> list[GenerateCommandExtension]:
    """Return the generators of support code; see `rosidl_cli.extensions.load_extensions`."""
    return cast("list[GenerateCommandExtension]", load_extensions(TYPESUPPORTS, specs=specs, strict=strict))
