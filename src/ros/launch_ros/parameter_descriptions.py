"""Descriptions of parameters: a value with a type, a name with such a value, and a file."""

from __future__ import annotations

import contextlib
import os
import pathlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch.frontend.parse_substitution import parse_substitution
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import (
    AllowedTypesType,
    SomeValueType,
    normalize_typed_substitution,
    perform_typed_substitution,
)
from launch.utilities.typing_file_path import FilePath

from daidalos.common.documents import DocumentError, parse_yaml, read_text
from daidalos.common.temporary_files import write_temporary

if TYPE_CHECKING:
    from launch import LaunchContext

EvaluatedParameterValue = (
    str | int | float | bool | bytes | Sequence[str] | Sequence[int] | Sequence[float] | Sequence[bool]
)


class ParameterValue:
    """A parameter's value with its type.

    Parameters
    ----------
    value
        The value, or a text.
    value_type
        What the text is made into: `int`, `float`, `bool`, `str`, a list of these, or None for whatever it
        looks like by the rules of YAML.
    """

    def __init__(self, value: SomeValueType, *, value_type: AllowedTypesType | None = None) -> None:
        self.__value = normalize_typed_substitution(value, value_type)
        self.__value_type = value_type
        self.__evaluated: EvaluatedParameterValue | None = None

    @property
    def value(self) -> Any:
        """The value, or the substitutions for it as long as it was not worked out."""
        return self.__value if self.__evaluated is None else self.__evaluated

    @property
    def value_type(self) -> AllowedTypesType | None:
        """What a text is made into."""
        return self.__value_type

    def evaluate(self, context: LaunchContext) -> EvaluatedParameterValue:
        """Evaluate the value."""
        self.__evaluated = perform_typed_substitution(context, self.__value, self.value_type)
        return self.__evaluated


class Parameter:
    """A parameter.

    Parameters
    ----------
    name
        Its name.
    value, value_type
        Its value, as for `ParameterValue`.
    """

    def __init__(
        self, name: SomeSubstitutionsType, value: SomeValueType, *, value_type: AllowedTypesType | None = None
    ) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__value = ParameterValue(value, value_type=value_type)
        self.__evaluated_name: str | None = None

    @property
    def name(self) -> list[Substitution] | str:
        """The name, or the substitutions for it as long as it was not worked out."""
        return self.__name if self.__evaluated_name is None else self.__evaluated_name

    @property
    def value(self) -> Any:
        """The value, or the substitutions for it as long as it was not worked out."""
        return self.__value.value

    @property
    def value_type(self) -> AllowedTypesType | None:
        """What a text is made into."""
        return self.__value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, EvaluatedParameterValue]:
        """Evaluate name and value."""
        self.__evaluated_name = perform_substitutions(context, self.__name)
        return self.__evaluated_name, self.__value.evaluate(context)


class ParameterFile:
    """A file of parameters.

    Parameters
    ----------
    param_file
        The file.
    allow_substs
        Whether `$(...)` in it is replaced as in a launch file.
    """

    def __init__(self, param_file: FilePath | SomeSubstitutionsType, *, allow_substs: SomeValueType = False) -> None:
        path: Any = param_file
        if isinstance(path, bytes | os.PathLike):
            path = os.fsdecode(path)
        self.__param_file = normalize_to_list_of_substitutions(path)
        self.__allow_substs = normalize_typed_substitution(allow_substs, bool)
        self.__evaluated_allow_substs: bool | None = None
        self.__evaluated_param_file: pathlib.Path | None = None
        self.__created_files: list[pathlib.Path] = []

    @property
    def param_file(self) -> list[Substitution] | pathlib.Path:
        """The file, or the substitutions for it as long as it was not worked out."""
        return self.__param_file if self.__evaluated_param_file is None else self.__evaluated_param_file

    @property
    def allow_substs(self) -> Any:
        """Whether `$(...)` in the file is replaced."""
        return self.__allow_substs if self.__evaluated_allow_substs is None else self.__evaluated_allow_substs

    def __str__(self) -> str:
        file = (
            " + ".join(substitution.describe() for substitution in self.param_file)
            if isinstance(self.param_file, list)
            else str(self.param_file)
        )
        return f"launch_ros.description.ParameterFile(param_file={file}, allow_substs={self.allow_substs})"

    def evaluate(self, context: LaunchContext) -> pathlib.Path:
        """Return the file, or a temporary one in which `$(...)` has been replaced.

        Several nodes may share a description: each evaluation makes a file, and all of them last until `cleanup`.
        """
        path = pathlib.Path(perform_substitutions(context, self.__param_file))
        self.__evaluated_allow_substs = bool(perform_typed_substitution(context, self.__allow_substs, bool))
        if self.__evaluated_allow_substs:
            path = self.__replace_substitutions(context, path)
            self.__created_files.append(path)
        self.__evaluated_param_file = path
        return path

    def __replace_substitutions(self, context: LaunchContext, path: pathlib.Path) -> pathlib.Path:
        try:
            text = perform_substitutions(context, parse_substitution(read_text(path)))
            parse_yaml(text)
        except DocumentError as error:
            raise SubstitutionFailure(
                f"the parameter file {path} is not YAML after its substitutions were performed: {error.described}"
            ) from error
        return write_temporary(text, "launch_params_", ".yaml")

    def cleanup(self) -> None:
        """Delete the temporary files."""
        for file in self.__created_files:
            with contextlib.suppress(OSError):
                file.unlink()
            self.__evaluated_param_file = None
        self.__created_files.clear()

    def __del__(self) -> None:
        if hasattr(self, "_ParameterFile__created_files"):
            self.cleanup()
