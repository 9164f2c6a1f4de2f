"""Checking names: a topic or service name as a user writes it."""

from typing import Literal

from rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from rclpy.impl.names import topic_name_error

TOPIC_SEPARATOR_STRING = "/"


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Check a topic or service name as a user writes it.

    Raises
    ------
    InvalidTopicNameException, InvalidServiceNameException
        Saying what is wrong, and where.
    """
    fault = topic_name_error(name)
    if fault:
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *fault)
    return True
