"""From names to classes."""

from __future__ import annotations

import importlib
import warnings
from typing import Any

from daidalos.interfaces.message import Action, Message, Service

_KINDS = {"msg": Message, "srv": Service, "action": Action}


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class that a `rosidl_parser.definition.NamespacedType` means; of a sequence that of its items."""
    if hasattr(message_type, "value_type"):
        warnings.warn("a sequence is not a namespaced type: pass its value_type", DeprecationWarning, stacklevel=2)
        message_type = message_type.value_type
    return _class("/".join(message_type.namespaced_name()))


def get_namespaced_type(identifier: str) -> Any:
    """Return ``package/kind/Name`` as a `rosidl_parser.definition.NamespacedType`.

    Raises
    ------
    ValueError
        When the name has another form.
    """
    from rosidl_parser.definition import NamespacedType

    parts = identifier.split("/")
    if len(parts) < 2 or not all(parts):
        raise ValueError(f"The passed message type '{identifier}' is not a valid identifier")
    return NamespacedType(parts[:-1], parts[-1])


def get_interface(identifier: str) -> Any:
    """Return the class of an interface, named ``package/kind/Name``; see `get_message`."""
    parts = identifier.split("/")
    if len(parts) == 2:
        identifier = f"{parts[0]}/msg/{parts[1]}"
    elif len(parts) != 3 or parts[1] not in _KINDS:
        raise ValueError(f"Expected the full name of an interface, got '{identifier}'")
    return _class(identifier)


def _class(identifier: str) -> Any:
    package, kind, name = identifier.split("/")
    module = importlib.import_module(f"{package}.{kind}")
    return getattr(module, name)


def _of_kind(identifier: str, kind: str, what: str) -> Any:
    parts = identifier.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) == 3 and all(parts) and parts[1] in _KINDS:
        found = _class("/".join(parts))
        # Services and actions are made of messages, such as ``package/action/Name_FeedbackMessage``.
        if issubclass(found, _KINDS[kind]):
            return found
    article = "an" if what[0] in "aeiou" else "a"
    raise ValueError(f"Expected the full name of {article} {what}, got '{identifier}'")


def get_message(identifier: str) -> Any:
    """Return the class of a message, named ``package/msg/Name`` or ``package/Name``.

    Raises
    ------
    ValueError
        When the name has another form.
    ModuleNotFoundError, AttributeError
        When there is no such package or message.
    """
    return _of_kind(identifier, "msg", "message")


def get_service(identifier: str) -> Any:
    """Return the class of a service; see `get_message`."""
    return _of_kind(identifier, "srv", "service")


def get_action(identifier: str) -> Any:
    """Return the class of an action; see `get_message`."""
    return _of_kind(identifier, "action", "action")


def get_message_namespaced_type(identifier: str) -> Any:
    """Return a message's name as a `NamespacedType`."""
    return get_namespaced_type(_full(identifier, "msg"))


def get_service_namespaced_type(identifier: str) -> Any:
    """Return a service's name as a `NamespacedType`."""
    return get_namespaced_type(_full(identifier, "srv"))


def get_action_namespaced_type(identifier: str) -> Any:
    """Return an action's name as a `NamespacedType`."""
    return get_namespaced_type(_full(identifier, "action"))


def _full(identifier: str, kind: str) -> str:
    parts = identifier.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or parts[1] != kind:
        raise ValueError(f"Expected the full name of an interface of kind '{kind}', got '{identifier}'")
    return "/".join(parts)


def is_message(interface: Any) -> bool:
    """Return whether something is a message or a message class."""
    return isinstance(interface, Message) or (isinstance(interface, type) and issubclass(interface, Message))


def is_service(interface: Any) -> bool:
    """Return whether something is a service class."""
    return isinstance(interface, type) and issubclass(interface, Service)


def is_action(interface: Any) -> bool:
    """Return whether something is an action class."""
    return isinstance(interface, type) and issubclass(interface, Action)
