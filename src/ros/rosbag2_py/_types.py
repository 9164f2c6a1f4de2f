"""Classes for the messages of topics, also of types that are not installed here: those are passed on as they are."""

from __future__ import annotations

from functools import cache
from typing import Any

from daidalos.interfaces.message import Message, MessageType


def message_class(type_name: str) -> Any:
    """Return the class of a type, None where it is not installed."""
    from rosidl_runtime_py.utilities import get_message

    try:
        return get_message(type_name)
    except (ImportError, AttributeError, ValueError):
        return None


def service_class(type_name: str) -> Any:
    """Return the class of a service's type, None where it is not installed."""
    from rosidl_runtime_py.utilities import get_service

    try:
        return get_service(type_name)
    except (ImportError, AttributeError, ValueError):
        return None


@cache
def opaque_class(type_name: str, type_hash: str) -> Any:
    """Return a class by which serialized messages of a type can be sent and received, though not looked into."""
    name = type_name.rpartition("/")[2]
    return MessageType(name, (Message,), {"__slots__": (), "_TYPE_NAME": type_name, "_TYPE_HASH": type_hash})
