"""The types of parameters: as they are given, prepared, and worked out."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, Union

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.some_substitutions_type import SomeSubstitutionsType_types_tuple as SomeSubstitutionsType_types_tuple
from launch.substitution import Substitution

from .parameter_descriptions import EvaluatedParameterValue as EvaluatedParameterValue
from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

SomeParameterName = SomeSubstitutionsType
SomeParametersDict = Mapping[SomeParameterName, Any]
SomeParameters = Sequence[Union[SomeSubstitutionsType, pathlib.Path, "ParameterFile", "Parameter", SomeParametersDict]]

ParameterName = tuple[Substitution, ...]
ParametersDict = dict[ParameterName, Union[Any, "ParameterValue"]]
Parameters = Sequence[Union["ParameterFile", "Parameter", ParametersDict]]

EvaluatedParameters = Sequence[Union[pathlib.Path, "Parameter", dict[str, EvaluatedParameterValue]]]
