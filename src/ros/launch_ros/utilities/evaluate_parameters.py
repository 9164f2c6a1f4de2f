"""Parameters, worked out: paths of files, and dictionaries of names and values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import ensure_argument_type, perform_substitutions

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue
from ..parameters_type import EvaluatedParameters, EvaluatedParameterValue, Parameters, ParametersDict

if TYPE_CHECKING:
    from launch import LaunchContext

_SCALARS = (bool, int, float, str, bytes)


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

    Texts become what they look like by the rules of YAML; in quotes they stay texts.

    Raises
    ------
    TypeError
        If a value is of no type that a parameter may have.
    SubstitutionFailure
        If a text is not YAML.
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
        return _from_text(name, perform_substitutions(context, value))
    if isinstance(value[0], Sequence) and not isinstance(value[0], str | bytes):
        texts = tuple(perform_substitutions(context, item) for item in value)
        typed = tuple(_load(name, text) for text in texts)
        return typed if _is_uniform(typed) else texts
    return value


def _from_text(name: str, text: str) -> EvaluatedParameterValue:
    value = _load(name, text)
    if isinstance(value, list):
        value = tuple(value)
        if not _is_uniform(value):
            raise TypeError(f"the items of the parameter {name} are not of one type: {text}")
        return value
    if not isinstance(value, _SCALARS):
        raise TypeError(
            "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
            f"Sequence[str]. Got {type(value).__name__} for the parameter {name}. If the parameter is meant to be a "
            "string, try wrapping it in launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
        )
    return value


def _load(name: str, text: str) -> Any:
    # Only nodes with parameters pay for YAML.
    import yaml

    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise SubstitutionFailure(
            f"Unable to parse the value of parameter {name} as yaml. If the parameter is meant to be a string, try "
            "wrapping it in launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
        ) from error
    if value is None and not text.strip():
        return ""
    # YAML folds lines and drops what looks like a comment; a text without quotes is to stay as it is.
    if isinstance(value, str) and not text.lstrip().startswith(("'", '"')):
        return text
    return value


def _is_uniform(values: Sequence[Any]) -> bool:
    types = {type(value) for value in values}
    return len(types) == 1 and types <= {bool, int, float, str}
