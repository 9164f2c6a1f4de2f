"""Parameters in ROS 1's form: YAML without the names of nodes."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Any

from launch.frontend.parse_substitution import parse_substitution
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.parameter_descriptions import ParameterFile

from daidalos.common.documents import DocumentError, parse_yaml
from daidalos.common.temporary_files import write_temporary

if TYPE_CHECKING:
    from launch import LaunchContext


class Ros1Parameters(ParameterFile):
    """Parameters from a file or from the launch file itself.

    Parameters
    ----------
    file
        The file.
    text
        The YAML, where there is no file.
    namespace
        What comes before the parameters' names.
    substitutes
        Whether `$(...)` in it is replaced.
    """

    def __init__(
        self,
        *,
        file: SomeSubstitutionsType | None,
        text: SomeSubstitutionsType | None,
        namespace: SomeSubstitutionsType,
        substitutes: bool,
    ) -> None:
        super().__init__("" if file is None else file)
        self.__file = None if file is None else normalize_to_list_of_substitutions(file)
        self.__text = normalize_to_list_of_substitutions("" if text is None else text)
        self.__namespace = normalize_to_list_of_substitutions(namespace)
        self.__substitutes = substitutes

    def evaluate(self, context: LaunchContext) -> pathlib.Path:
        """Return a file with these parameters in ROS 2's form, for any node."""
        import yaml

        content = {"/**": {"ros__parameters": self.read(context)}}
        return write_temporary(yaml.safe_dump(content), "launch_params_", ".yaml")

    def read(self, context: LaunchContext) -> dict[str, Any]:
        """Return the parameters' names and values.

        Raises
        ------
        SubstitutionFailure
            If the file cannot be read, or is not YAML.
        """
        source = "the element 'rosparam'"
        text = perform_substitutions(context, self.__text)
        if self.__file is not None:
            source = perform_substitutions(context, self.__file)
            try:
                text = pathlib.Path(source).read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                reason = error.strerror if isinstance(error, OSError) else "is not valid UTF-8"
                raise SubstitutionFailure(f"the parameter file {source} cannot be read: {reason}") from error
            if self.__substitutes:
                from .translation import translate_text

                text = perform_substitutions(context, parse_substitution(translate_text(text)))
        try:
            content = parse_yaml(text)
        except DocumentError as error:
            raise SubstitutionFailure(f"{source} is not YAML: {error.described}") from error
        namespace = perform_substitutions(context, self.__namespace).replace("/", ".")
        return _flatten(content, namespace, source)


def _flatten(value: Any, prefix: str, source: str) -> dict[str, Any]:
    if value is None:
        return {}
    if isinstance(value, dict):
        flat: dict[str, Any] = {}
        for name, inner in value.items():
            full_name = f"{prefix}.{name}" if prefix else str(name)
            flat.update(_flatten(inner, full_name.replace("/", "."), source))
        return flat
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        # What ROS 2 has no type for is kept as text, as Nav2 does with footprints.
        return {prefix: str(value)}
    if not prefix:
        raise SubstitutionFailure(f"{source} has no names of parameters in it, but {value!r}")
    return {prefix: value}
