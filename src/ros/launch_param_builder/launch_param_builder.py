"""Builder of parameters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from ament_index_python.packages import get_package_share_path

from launch_param_builder.utils import ParameterValueType, load_file, load_xacro, load_yaml


class ParameterBuilder:
    """Builder whose methods add parameters and return itself; `to_dict` returns them all.

    Paths of files are absolute or begin at the share folder of the package.

    Parameters
    ----------
    package_name
        The package.
    """

    def __init__(self, package_name: str) -> None:
        self._package_path = get_package_share_path(package_name)
        self._parameters: dict[str, Any] = {}

    def yaml(self, file_path: str | Path, parameter_namespace: str | None = None) -> Self:
        """Add the parameters of a YAML file, in a namespace if one is given."""
        content = load_yaml(self._package_path / file_path) or {}
        if parameter_namespace:
            self._parameters.setdefault(parameter_namespace, {}).update(content)
        else:
            self._parameters.update(content)
        return self

    def file_parameter(self, parameter_name: str, file_path: str | Path) -> Self:
        """Add the text of a file as a parameter."""
        self._parameters[parameter_name] = load_file(self._package_path / file_path)
        return self

    def xacro_parameter(
        self, parameter_name: str, file_path: str | Path, mappings: Mapping[str, str] | None = None
    ) -> Self:
        """Add what xacro makes of a file, with these arguments, as a parameter."""
        self._parameters[parameter_name] = load_xacro(self._package_path / file_path, mappings)
        return self

    def parameter(self, parameter_name: str, parameter_value: ParameterValueType) -> Self:
        """Add a parameter."""
        self._parameters[parameter_name] = parameter_value
        return self

    def path_parameter(self, parameter_name: str, file_path: str | Path) -> Self:
        """Add the full path of a file as a parameter."""
        self._parameters[parameter_name] = str(self._package_path / file_path)
        return self

    def to_dict(self) -> dict[str, Any]:
        """Return the parameters by name."""
        return self._parameters
