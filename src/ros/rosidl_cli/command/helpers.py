"""Paths of interface files as generators and translators take them: ``folder:msg/Name.msg``."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


def package_name_from_interface_file_path(path: Path) -> str:
    """Return the package of an installed interface file, ``package/msg/Name.idl``."""
    return Path(os.path.abspath(path)).parents[1].name


def dependencies_from_include_paths(include_paths: Iterable[str | Path]) -> list[str]:
    """Return the .idl files below folders as ``package:path`` with absolute paths."""
    files = {path for folder in include_paths for path in Path(os.path.abspath(folder)).glob("**/*.idl")}
    return [f"{package_name_from_interface_file_path(path)}:{path}" for path in sorted(files)]


def interface_path_as_tuple(path: str) -> tuple[Path, Path]:
    """Return the absolute folder and the relative path of ``folder:path``; without a folder it is the current one.

    Raises
    ------
    ValueError
        When the path after the colon is absolute.
    """
    prefix, colon, relative = str(path).rpartition(":")
    if os.path.isabs(relative):
        raise ValueError(f"Interface definition file path '{relative}' cannot be absolute")
    return Path(os.path.abspath(prefix)) if colon else Path.cwd(), Path(relative)


def idl_tuples_from_interface_files(interface_files: Iterable[str]) -> list[str]:
    """Return interface files as ``absolute folder:path``."""
    pairs = map(interface_path_as_tuple, interface_files)
    return [f"{prefix}:{path.as_posix()}" for prefix, path in pairs]


@contextmanager
def legacy_generator_arguments_file(
    *,
    package_name: str,
    interface_files: Iterable[str],
    include_paths: Iterable[str | Path],
    templates_path: str | Path,
    output_path: str | Path,
) -> Iterator[str]:
    """Write the arguments of a generator that takes a JSON file, yield its path and remove it.

    Parameters
    ----------
    package_name
        The package that the code is for.
    interface_files
        Its interface files.
    include_paths
        Folders with the interface files of other packages.
    templates_path
        Folder with the generator's templates.
    output_path
        Where the code goes.
    """
    content = {
        "package_name": package_name,
        "output_dir": os.path.abspath(output_path),
        "template_dir": os.path.abspath(templates_path),
        "idl_tuples": idl_tuples_from_interface_files(interface_files),
        "ros_interface_dependencies": dependencies_from_include_paths(include_paths),
        "target_dependencies": [],
    }
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arguments.json"
        file.write_text(json.dumps(content), encoding="utf-8")
        yield str(file)


def generate_visibility_control_file(*, package_name: str, template_path: str | Path, output_path: str | Path) -> None:
    """Write a template with ``@PROJECT_NAME@`` and ``@PROJECT_NAME_UPPER@`` replaced by the package's name."""
    content = Path(template_path).read_text(encoding="utf-8")
    content = content.replace("@PROJECT_NAME@", package_name).replace("@PROJECT_NAME_UPPER@", package_name.upper())
    Path(output_path).parent.mkdir(parents=True, exist_ok=True)
    Path(output_path).write_text(content, encoding="utf-8")
