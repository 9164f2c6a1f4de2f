"""Parameters, worked out: paths of files, and dictionaries of names and values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from launch.substitution import Substitution
from launch.utilities import ensure_argument_type, perform_substitutions

from daidalos.common.documents import DocumentError, parse_yaml

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue
from ..parameters_type import EvaluatedParameters, EvaluatedParameterValue, Parameters, ParametersDict
from .normalize_parameters import StringSubstitution

if TYPE_CHECKING:
    from launch import LaunchContext

_SCALARS = (bool, int, float, str, bytes)
_STRING_HINT = (
    "If the parameter is meant to be a string, try wrapping it in "
    "launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
)


def evaluate_parameters(context: LaunchContext, parameters: Parameters) -> EvaluatedParameters:
    """Evaluate parameters that `normalize_parameters` prepared.

    Returns
    -------
        For each a path, a dictionary, or the `Parameter` description itself.
    """
    evaluated: list[Any] = []
    for parameter in parameters:
        if isinstance(parameter, ParameterFile):
            evaluated.append(parameter.evaluate(context))
        elif isinstance(parameter, Mapping):
            evaluated.append(evaluate_parameter_dict(context, parameter))
        elif isinstance(parameter, Parameter):
            evaluated.append(parameter)
        else:
            raise TypeError(f"expected prepared parameters, got {parameter!r}")
    return tuple(evaluated)


def evaluate_parameter_dict(context: LaunchContext, parameters: ParametersDict) -> dict[str, EvaluatedParameterValue]:
    """Evaluate a dictionary that `normalize_parameter_dict` prepared.

    The text of substitutions becomes what it looks like by the rules of YAML; in quotes it stays a string.

    Raises
    ------
    TypeError
        If a text is not YAML, or if a value is of no type that a parameter may have.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError(f"expected a prepared dictionary of parameters, got {parameters!r}")
    evaluated: dict[str, EvaluatedParameterValue] = {}
    for name, value in parameters.items():
        if not isinstance(name, tuple):
            raise TypeError(f"expected a tuple of substitutions as a parameter's name, got {name!r}")
        full_name = perform_substitutions(context, name)
        evaluated[full_name] = _evaluate(context, full_name, value)
    return evaluated


def _evaluate(context: LaunchContext, name: str, value: Any) -> EvaluatedParameterValue:
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if not (isinstance(value, tuple) and value):
        ensure_argument_type(value, (bool, int, float, str, bytes, tuple), "value", f"the parameter {name}")
        plain: EvaluatedParameterValue = value
        return plain
    if isinstance(value[0], Substitution):
        return _from_substitutions(context, name, value)
    if isinstance(value[0], Sequence) and not isinstance(value[0], str | bytes):
        return _uniform(name, [_from_substitutions(context, name, item) for item in value])
    return value


def _from_substitutions(context: LaunchContext, name: str, value: Sequence[Substitution]) -> EvaluatedParameterValue:
    text = perform_substitutions(context, value)
    if isinstance(value[0], StringSubstitution):
        return text
    loaded = _load(name, text)
    if isinstance(loaded, list):
        return _uniform(name, loaded)
    if not isinstance(loaded, _SCALARS):
        raise TypeError(
            "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
            f"Sequence[str]. Got {type(loaded).__name__} for the parameter {name}. {_STRING_HINT}"
        )
    return loaded


def _load(name: str, text: str) -> Any:
    try:
        value = parse_yaml(text)
    except DocumentError as error:
        raise TypeError(f"Unable to parse the value of parameter {name} as yaml. {_STRING_HINT}") from error
    if value is None and not text.strip():
        return ""
    # YAML folds lines and drops what looks like a comment; a text without quotes is to stay as it is.
    if isinstance(value, str) and not text.lstrip().startswith(("'", '"')):
        return text
    return value


def _uniform(name: str, values: Sequence[Any]) -> EvaluatedParameterValue:
    types = {type(value) for value in values}
    if len(types) != 1 or not types <= {bool, int, float, str}:
        raise TypeError(
            "Expected a non-empty sequence, with items that are all bool, int, float or str, "
            f"for the parameter {name}, but got {list(values)!r}"
        )
    return tuple(values)
