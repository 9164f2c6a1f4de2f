"""Checking names: a parameter's name."""

from typing import Literal

from rclpy.exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> Literal[True]:
    """Check a parameter's name.

    Raises
    ------
    InvalidParameterException
        When it is empty.
    """
    if not name:
        raise InvalidParameterException(name)
    return True
