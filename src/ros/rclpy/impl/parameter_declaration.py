"""Declaration of parameters: first value and type."""

from __future__ import annotations

import copy
import warnings
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import InvalidParameterTypeException
from rclpy.parameter import Parameter, ParameterType, parameter_value_to_python

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterDescriptor


def unpacked(index: int, entry: Any) -> tuple[str, Any, Any]:
    """Return (name, value, descriptor) of a declaration."""
    from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

    if not isinstance(entry, tuple) or not 1 <= len(entry) <= 3:
        raise TypeError(
            f"Invalid parameter tuple length at index {index} in parameters list: {entry}; expecting 1 to 3"
        )
    name = entry[0]
    if not isinstance(name, str):
        raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
    value = entry[1] if len(entry) > 1 else None
    is_message = isinstance(value, ParameterValue)
    if isinstance(value, ParameterValue):
        value = parameter_value_to_python(value)
    descriptor = copy.deepcopy(entry[2]) if len(entry) > 2 else None
    if descriptor is None:
        descriptor = ParameterDescriptor(dynamic_typing=value is None)
    if not isinstance(descriptor, ParameterDescriptor):
        raise TypeError(f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor.")
    if is_message and value is None and not descriptor.dynamic_typing:
        raise ValueError(f"Cannot declare the statically typed parameter '{name}' with a value that is not set")
    if len(entry) == 1:
        warnings.warn(
            f"Parameter '{name}' is declared by its name alone, which is deprecated: give it a default value, a type, "
            "or a descriptor with dynamic_typing=True",
            stacklevel=4,
        )
    return name, value, descriptor


def initial(name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
    """Return a declared parameter with its initial value; notes its type in the descriptor."""
    if isinstance(value, ParameterType):
        if value == ParameterType.NOT_SET:
            raise ValueError(f"Cannot declare parameter '{name}' as statically typed of type NOT_SET")
        if descriptor.dynamic_typing:
            raise ValueError("When declaring a parameter with a type, it cannot be of dynamic typing")
        descriptor.type = int(value)
        return Parameter(name, ParameterType.NOT_SET)
    if value is None and not descriptor.dynamic_typing:
        raise ValueError(
            f"Parameter '{name}' is declared without a value: give one, a `Parameter.Type` in its place, or set "
            "dynamic_typing in its descriptor"
        )
    parameter: Parameter[Any] = Parameter(name, value=value)
    if value is not None:
        if isinstance(value, (list, tuple)) and not value and descriptor.type >= ParameterType.BYTE_ARRAY:
            return Parameter(name, ParameterType(descriptor.type), value)
        descriptor.type = int(parameter.type_)
    return parameter


def overridden(override: Parameter[Any], value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
    """Return a declared parameter with a value from outside; notes its type in the descriptor."""
    if descriptor.dynamic_typing:
        return override
    expected = value if isinstance(value, ParameterType) else ParameterType.from_parameter_value(value)
    if expected == ParameterType.NOT_SET:
        expected = ParameterType(descriptor.type)
    override = _fitting(override, expected)
    descriptor.type = int(expected if expected != ParameterType.NOT_SET else override.type_)
    return override


def _fitting(parameter: Parameter[Any], expected: ParameterType) -> Parameter[Any]:
    """Return an override as the type that was declared.

    Raises
    ------
    InvalidParameterTypeException
        When it is of another type.
    """
    if expected in (ParameterType.NOT_SET, parameter.type_):
        return parameter
    if isinstance(parameter.value, (list, tuple)) and not parameter.value and expected >= ParameterType.BYTE_ARRAY:
        return Parameter(parameter.name, expected, parameter.value)
    raise InvalidParameterTypeException(parameter, expected)
