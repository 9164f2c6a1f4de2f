"""Contents of files for parameters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ament_index_python.packages import get_package_share_path

from daidalos.common.documents import read_yaml

ParameterValueType = str | int | float | bool | list[str] | list[int] | list[float] | list[bool] | bytes


class ParameterBuilderFileNotFoundError(KeyError):
    """Error of a file that does not exist."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def raise_if_file_not_found(file_path: Path) -> None:
    """Raise ParameterBuilderFileNotFoundError if a file does not exist."""
    if not Path(file_path).exists():
        raise ParameterBuilderFileNotFoundError(f"File {file_path} doesn't exist")


def load_file(file_path: Path) -> str:
    """Return the text of a file."""
    raise_if_file_not_found(file_path)
    return Path(file_path).read_text(encoding="utf-8")


def load_yaml(file_path: Path) -> Any:
    """Return the content of a YAML file.

    Raises
    ------
    ParameterBuilderFileNotFoundError
        When there is no such file.
    ValueError
        When it is not YAML; names the file and the line.
    """
    raise_if_file_not_found(file_path)
    return read_yaml(file_path)


def load_xacro(file_path: Path, mappings: Mapping[str, str] | None = None) -> str:
    """Return what xacro makes of a file, as XML.

    Parameters
    ----------
    file_path
        The file.
    mappings
        Values of its arguments.
    """
    import xacro

    raise_if_file_not_found(file_path)
    text: str = xacro.process_file(str(file_path), mappings=dict(mappings or {})).toxml()
    return text


def get_path(package_name: str, file_path: str) -> str:
    """Return the path of a file in the share folder of a package."""
    return str(get_package_share_path(package_name) / file_path)
