"""Checking names: a namespace, which must be absolute."""

from typing import Literal

from rclpy.exceptions import InvalidNamespaceException
from rclpy.impl.names import namespace_error


def validate_namespace(namespace: str) -> Literal[True]:
    """Check a namespace, which must be absolute.

    Raises
    ------
    InvalidNamespaceException
        Saying what is wrong, and where.
    """
    fault = namespace_error(namespace)
    if fault:
        raise InvalidNamespaceException(namespace, *fault)
    return True
