"""Checks of parameter values: type, range and whether the value may change."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rclpy.parameter import Parameter, ParameterType

if TYPE_CHECKING:
    from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult

REL_TOL = 1e-6
"""By which a number may miss an end or a step of its range."""


def check_change(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> SetParametersResult:
    """Return whether a parameter that is declared may become this one."""
    from rcl_interfaces.msg import SetParametersResult

    if descriptor.read_only:
        return SetParametersResult(successful=False, reason=f"Trying to set a read-only parameter: {parameter.name}.")
    if parameter.type_ == ParameterType.NOT_SET and not descriptor.dynamic_typing:
        return SetParametersResult(successful=False, reason="Static parameter cannot be undeclared")
    return check_value(parameter, descriptor)


def check_value(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> SetParametersResult:
    """Return whether a value is of the declared type and in its range."""
    from rcl_interfaces.msg import SetParametersResult

    expected = ParameterType(descriptor.type)
    if parameter.type_ == ParameterType.NOT_SET:
        return SetParametersResult(successful=True)
    if not descriptor.dynamic_typing and expected not in (ParameterType.NOT_SET, parameter.type_):
        reason = f"Wrong parameter type, expected 'Type.{expected.name}' got 'Type.{parameter.type_.name}'"
        return SetParametersResult(successful=False, reason=reason)
    reason = ""
    if parameter.type_ == ParameterType.INTEGER and descriptor.integer_range:
        reason = _integer_error(parameter, descriptor.integer_range[0])
    elif parameter.type_ == ParameterType.DOUBLE and descriptor.floating_point_range:
        reason = _float_error(parameter, descriptor.floating_point_range[0])
    return SetParametersResult(successful=not reason, reason=reason)


def _integer_error(parameter: Parameter[Any], allowed: IntegerRange) -> str:
    low, high = sorted((allowed.from_value, allowed.to_value))
    value = parameter.value
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if allowed.step and (value - low) % allowed.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. Min: {low}, max: {high}, "
            f"value: {value}, step: {allowed.step}"
        )
    return ""


def _float_error(parameter: Parameter[Any], allowed: FloatingPointRange) -> str:
    low, high = sorted((allowed.from_value, allowed.to_value))
    value = parameter.value
    if any(math.isclose(value, edge, rel_tol=REL_TOL) for edge in (low, high)):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    if allowed.step:
        nearest = low + round((value - low) / allowed.step) * allowed.step
        if not math.isclose(value, nearest, rel_tol=REL_TOL):
            return (
                f"The parameter value for {parameter.name} is not close enough to a valid step. Min: {low}, "
                f"max: {high}, value: {value}, step: {allowed.step}"
            )
    return ""
