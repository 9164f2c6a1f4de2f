"""Classes and instances of interfaces by name."""

from __future__ import annotations

import functools
import importlib
import re
from typing import Any

from rosidl_runtime_py.get_interfaces import interface_library


class InvalidTypeStringException(Exception):
    """Error of a name that is neither ``package/Name`` nor ``package/kind/Name``."""

    def __init__(self, typestring: str) -> None:
        super().__init__(f"{typestring} is not a valid type string")


class InvalidModuleException(Exception):
    """Error of a package without interfaces of a kind."""

    def __init__(self, modname: str, subname: str, original_exception: Exception) -> None:
        super().__init__(
            f"Unable to import {modname}.{subname} from package {modname}. Caused by: {original_exception}"
        )


class InvalidClassException(Exception):
    """Error of a package without an interface of a name."""

    def __init__(self, modname: str, subname: str, classname: str, original_exception: Exception) -> None:
        super().__init__(
            f"Unable to import {subname} class {classname} from package {modname}. Caused by {original_exception}"
        )


def get_message_class(typestring: str) -> Any:
    """Return the class of a message such as ``std_msgs/String``; raises one of the errors above."""
    return _interface_class(typestring, "msg")


def get_service_class(typestring: str) -> Any:
    """Return the class of a service; raises one of the errors above."""
    return _interface_class(typestring, "srv")


def get_action_class(typestring: str) -> Any:
    """Return the class of an action; raises one of the errors above."""
    return _interface_class(typestring, "action")


def get_message_instance(typestring: str) -> Any:
    """Return a message with default values."""
    return get_message_class(typestring)()


def get_service_request_instance(typestring: str) -> Any:
    """Return a request with default values."""
    return get_service_class(typestring).Request()


def get_service_response_instance(typestring: str) -> Any:
    """Return a response with default values."""
    return get_service_class(typestring).Response()


def get_action_goal_instance(typestring: str) -> Any:
    """Return a goal with default values."""
    return get_action_class(typestring).Goal()


def get_action_feedback_instance(typestring: str) -> Any:
    """Return feedback with default values."""
    return get_action_class(typestring).Feedback()


def get_action_result_instance(typestring: str) -> Any:
    """Return a result with default values."""
    return get_action_class(typestring).Result()


_loaded_msgs: dict[str, Any] = {}
_loaded_srvs: dict[str, Any] = {}
_loaded_actions: dict[str, Any] = {}
_LOADED = {"msg": _loaded_msgs, "srv": _loaded_srvs, "action": _loaded_actions}
_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
_REFUSED_NAMES = 4096


def _interface_class(typestring: str, kind: str) -> Any:
    loaded = _LOADED[kind]
    if typestring not in loaded:
        loaded[typestring] = _find(typestring, kind)
    return loaded[typestring]


def _find(typestring: str, kind: str) -> Any:
    parts = [part for part in typestring.split("/") if part]
    if len(parts) not in (2, 3):
        raise InvalidTypeStringException(typestring)
    package, name = parts[0], parts[-1]
    if len(parts) == 3 and parts[1] != kind:
        try:
            return _load(package, parts[1], name)
        except (InvalidModuleException, InvalidClassException):
            pass  # the kind that is asked for counts
    return _load(package, kind, name)


def _load(package: str, kind: str, name: str) -> Any:
    try:
        if not _defines(package, kind):  # the name may come from a stranger, and importing a module runs it
            raise ModuleNotFoundError(f"no package '{package}' with interfaces of kind '{kind}'")
        module = importlib.import_module(f"{package}.{kind}")
    except Exception as error:
        raise InvalidModuleException(package, kind, error) from error
    found = getattr(module, name, None) if _NAME.fullmatch(name) else None
    if not isinstance(found, type):
        raise InvalidClassException(package, kind, name, AttributeError(f"no {kind} '{name}'"))
    return found


@functools.lru_cache(_REFUSED_NAMES)
def _defines(package: str, kind: str) -> bool:
    """Return whether a package has interfaces of a kind."""
    if not _NAME.fullmatch(package) or kind not in _LOADED:
        return False
    return any(name.split("/")[1] == kind for name in interface_library().names(package))
