"""Checking names: a full topic or service name."""

from typing import Literal

from rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from rclpy.impl.names import full_name_error


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Check a full topic or service name.

    Raises
    ------
    InvalidTopicNameException, InvalidServiceNameException
        Saying what is wrong, and where.
    """
    fault = full_name_error(name)
    if fault:
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *fault)
    return True
