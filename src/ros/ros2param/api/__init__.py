"""Parameters of other nodes."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import DirectNode
from ros2cli.services import call

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter, ParameterValue


TYPE_NAMES = (
    "not set", "boolean", "integer", "double", "string",
    "byte array", "boolean array", "integer array", "double array", "string array",
)  # fmt: skip
"""Names of the types by their number in `rcl_interfaces/msg/ParameterType`."""


def get_value(*, parameter_value: ParameterValue) -> Any:
    """Return what a parameter's message holds, as a Python value; None where it is not set."""
    from rclpy.parameter import parameter_value_to_python

    return parameter_value_to_python(parameter_value)


def get_parameter_type_string(parameter_type: int) -> str:
    """Return the name of a type of `rcl_interfaces/msg/ParameterType`, such as ``double array``."""
    return TYPE_NAMES[parameter_type]


def call_list_parameters(*, node: Any, node_name: str, prefixes: Sequence[str] | None = None) -> Any:
    """Request the names of a node's parameters, and return the response of its service.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `DirectNode`.
    node_name
        The full name of the node that is asked.
    prefixes
        Only names below these; all if None.

    Raises
    ------
    RuntimeError
        When it does not answer.
    """
    from rcl_interfaces.srv import ListParameters

    request = ListParameters.Request(prefixes=list(prefixes or []))
    return _call(node, ListParameters, node_name, "list_parameters", request)


def call_get_parameters(*, node: Any, node_name: str, parameter_names: Sequence[str]) -> Any:
    """Request the values of a node's parameters; see `call_list_parameters`."""
    from rcl_interfaces.srv import GetParameters

    request = GetParameters.Request(names=list(parameter_names))
    return _call(node, GetParameters, node_name, "get_parameters", request)


def values_of(node: Any, node_name: str, parameter_names: Sequence[str]) -> list[Any]:
    """Return the values of a node's parameters, of type NOT_SET for those without one; see `call_list_parameters`."""
    from rcl_interfaces.msg import ParameterValue

    values = list(call_get_parameters(node=node, node_name=node_name, parameter_names=parameter_names).values)
    if len(values) == len(parameter_names):
        return values
    # A node answers with no value at all when one of the parameters has none.
    answers = [call_get_parameters(node=node, node_name=node_name, parameter_names=[name]) for name in parameter_names]
    return [answer.values[0] if answer.values else ParameterValue() for answer in answers]


def call_describe_parameters(*, node: Any, node_name: str, parameter_names: Sequence[str] | None = None) -> Any:
    """Request the descriptions of a node's parameters; see `call_list_parameters`."""
    from rcl_interfaces.srv import DescribeParameters

    request = DescribeParameters.Request(names=list(parameter_names or []))
    return _call(node, DescribeParameters, node_name, "describe_parameters", request)


def call_set_parameters(*, node: Any, node_name: str, parameters: Sequence[Parameter]) -> Any:
    """Set parameters of a node; see `call_list_parameters`."""
    from rcl_interfaces.srv import SetParameters

    request = SetParameters.Request(parameters=list(parameters))
    return _call(node, SetParameters, node_name, "set_parameters", request)


def load_parameter_file(*, node: Any, node_name: str, parameter_file: str, use_wildcard: bool) -> None:
    """Set the parameters of a node that a file holds, and print what became of each.

    Parameters
    ----------
    node
        Who asks.
    node_name
        The full name of the node.
    parameter_file
        The file.
    use_wildcard
        Whether what the file says of all nodes (``/**``) counts.

    Raises
    ------
    RuntimeError
        When the node does not answer, or the file cannot be read or does not name the node.
    """
    from rclpy.parameter import parameter_dict_from_yaml_file

    try:
        parameters = parameter_dict_from_yaml_file(parameter_file, use_wildcard, target_nodes=[node_name])
    except OSError as error:
        raise RuntimeError(f"{parameter_file}: {error.strerror}") from None
    response = call_set_parameters(node=node, node_name=node_name, parameters=list(parameters.values()))
    failed = [
        parameters[name] for name, result in zip(parameters, response.results, strict=True) if not result.successful
    ]
    unchanged = _unchanged(node, node_name, failed)
    for name, result in zip(parameters, response.results, strict=True):
        if name in unchanged:
            sys.stdout.write(f"Parameter {name} is read-only and has this value already\n")
        else:
            report(result, f"Set parameter {name} successful", f"Set parameter {name} failed")
    sys.stdout.flush()


def _unchanged(node: Any, node_name: str, parameters: Sequence[Parameter]) -> set[str]:
    """Return the names of those read-only parameters that have the values which they were to get."""
    names = [one.name for one in parameters]
    if not names:
        return set()
    descriptors = call_describe_parameters(node=node, node_name=node_name, parameter_names=names).descriptors
    values = values_of(node, node_name, names)
    return {
        one.name
        for one, descriptor, value in zip(parameters, descriptors, values, strict=False)
        if descriptor.read_only and value == one.value
    }


def report(result: Any, good: str, bad: str) -> bool:
    """Print what became of a change, and return whether it was made.

    Parameters
    ----------
    result
        The node's answer: `rcl_interfaces/msg/SetParametersResult`; its reason is printed, too.
    good, bad
        What is printed of a change that was made, and of one that was not.
    """
    reason = f": {result.reason}" if result.reason else ""
    done = bool(result.successful)
    print((good if done else bad) + reason, file=sys.stdout if done else sys.stderr)
    return done


class ParameterNameCompleter:
    """Completer of the names of the parameters of the node that the argument ``node_name`` names."""

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        from ros2node.api import get_absolute_node_name

        name = get_absolute_node_name(parsed_args.node_name)
        if name is None:
            return []
        with DirectNode(parsed_args) as node:
            return sorted(call_list_parameters(node=node, node_name=name).result.names)


def _call(node: Any, service_type: Any, node_name: str, service: str, request: Any) -> Any:
    return call(node, service_type, f"{node_name}/{service}", request)
