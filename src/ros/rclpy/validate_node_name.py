"""Checking names: a node's name."""

from typing import Literal

from rclpy.exceptions import InvalidNodeNameException
from rclpy.impl.names import node_name_error


def validate_node_name(node_name: str) -> Literal[True]:
    """Check a node's name.

    Raises
    ------
    InvalidNodeNameException
        Saying what is wrong, and where.
    """
    fault = node_name_error(node_name)
    if fault:
        raise InvalidNodeNameException(node_name, *fault)
    return True
