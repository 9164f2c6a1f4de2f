"""Checks that a class is a message, service or action class."""

from __future__ import annotations

from typing import Any

from daidalos.interfaces.message import Action, Message, Service
from rclpy.exceptions import NoTypeSupportImportedException


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Check that a class can be sent.

    Raises
    ------
    AttributeError
        When it is not a generated class.
    NoTypeSupportImportedException
        When it lacks what sending needs.
    """
    try:
        support = msg_or_srv_type.__class__._TYPE_SUPPORT
    except AttributeError as error:
        name = getattr(msg_or_srv_type, "__name__", msg_or_srv_type)
        raise AttributeError(
            f"{error}. '{name}' is not a ROS 2 message, service or action class; "
            "import one such as 'from std_msgs.msg import String'"
        ) from None
    if support is None:
        raise NoTypeSupportImportedException()


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Check that a class is a message class; RuntimeError if it is not."""
    check_for_type_support(msg_type)
    if not (isinstance(msg_type, type) and issubclass(msg_type, Message)):
        raise RuntimeError(f"The provided message type is not valid: {msg_type}")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Check that a class is a service class; RuntimeError if it is not."""
    check_for_type_support(srv_type)
    if not (isinstance(srv_type, type) and issubclass(srv_type, Service)):
        raise RuntimeError(f"The provided service type is not valid: {srv_type}")


def check_is_valid_action_type(action_type: Any) -> None:
    """Check that a class is an action class; RuntimeError if it is not."""
    check_for_type_support(action_type)
    if not (isinstance(action_type, type) and issubclass(action_type, Action)):
        raise RuntimeError(f"The provided action type is not valid: {action_type}")
