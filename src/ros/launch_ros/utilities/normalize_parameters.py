"""Parameters, prepared: files, and flat dictionaries whose texts are tuples of substitutions."""

from __future__ import annotations

import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from launch.substitution import Substitution
from launch.substitutions import TextSubstitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue
from ..parameters_type import ParameterName, Parameters, ParametersDict, SomeParameters

_SCALARS = (bool, int, float, bytes)


class StringSubstitution(TextSubstitution):
    """A parameter's text that is a string whatever it looks like."""


def normalize_parameters(parameters: SomeParameters) -> Parameters:
    """Return a node's parameters, prepared.

    Parameters
    ----------
    parameters
        Files (as texts, paths or `ParameterFile`), dictionaries and `Parameter` descriptions.

    Raises
    ------
    TypeError
        If there is something else among them.
    """
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        raise TypeError(f"Expecting list of parameters, got {parameters}")
    normalized: list[Any] = []
    for parameter in parameters:
        if isinstance(parameter, Mapping):
            normalized.append(normalize_parameter_dict(parameter))
        elif isinstance(parameter, Parameter | ParameterFile):
            normalized.append(parameter)
        else:
            ensure_argument_type(parameter, (str, pathlib.Path, Substitution, Iterable), "parameter in parameters")
            normalized.append(ParameterFile(parameter))
    return tuple(normalized)


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] | None = None
) -> ParametersDict:
    """Return a dictionary of parameters, prepared.

    Dictionaries inside it become names with dots. Substitutions become a tuple of substitutions, whose text
    `evaluate_parameters` reads as YAML; a string becomes a `StringSubstitution`, which stays a string. A list
    of these becomes a tuple of such tuples. Numbers in a list become floats if one of them is.

    Parameters
    ----------
    parameters
        Names and values.

    Raises
    ------
    TypeError
        If a name is not text, or if a value is of no type that a parameter may have; a list without items is
        of none.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError(f"expected a dictionary of parameters, got {parameters!r}")
    normalized: ParametersDict = {}
    for name, value in parameters.items():
        full_name = _normalize_name(name, _prefix)
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=full_name))
        else:
            normalized[full_name] = _normalize_value(value)
    return normalized


def _normalize_name(name: Any, prefix: Sequence[Substitution] | None) -> ParameterName:
    parts = normalize_to_list_of_substitutions(name)
    if prefix:
        parts = [*prefix, TextSubstitution(text="."), *parts]
    return tuple(parts)


def _normalize_value(value: Any) -> Any:
    if isinstance(value, ParameterValue) or type(value) in _SCALARS:
        return value
    if isinstance(value, str | pathlib.Path):
        return (StringSubstitution(text=str(value)),)
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, Sequence):
        return _normalize_array(value)
    # Numbers of other libraries behave like Python's.
    ensure_argument_type(value, (int, float), "value")
    return value


def _normalize_array(values: Sequence[Any]) -> Any:
    for item in values:
        ensure_argument_type(item, (bool, int, float, str, Substitution, Sequence), "item of a parameter's list")
    if any(isinstance(item, Substitution) for item in values) and all(
        isinstance(item, str | Substitution) for item in values
    ):
        # Strings and substitutions in a row are one text.
        return tuple(normalize_to_list_of_substitutions(values))
    types = {type(item) for item in values}
    if not types:
        raise TypeError("Expected a non-empty sequence as the value of a parameter, but got []")
    if types <= {int, float} and float in types:
        return tuple(float(item) for item in values)
    if len(types) == 1 and types <= {bool, int}:
        return tuple(values)
    return tuple(_normalize_item(item) for item in values)


def _normalize_item(item: Any) -> tuple[Substitution, ...]:
    if isinstance(item, str):
        return (StringSubstitution(text=item),)
    return tuple(normalize_to_list_of_substitutions(str(item) if type(item) in _SCALARS else item))
