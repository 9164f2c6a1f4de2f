"""Classes of messages by the names of their types."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node


def find_message_class(node: Node, type_name: str) -> Any:
    """Return a message class; None, and log an error once, where it is not known."""
    from rosidl_runtime_py.utilities import get_message

    try:
        return get_message(type_name)
    except (AttributeError, ImportError, ValueError) as error:
        node.get_logger().error(f"the type {type_name} is not known here: {error}", once=True)
        return None
