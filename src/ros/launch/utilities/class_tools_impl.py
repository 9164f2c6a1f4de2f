"""Questions about instances and classes."""

from __future__ import annotations

from typing import Any, TypeVar

T = TypeVar("T")


def isclassinstance(obj: Any) -> bool:
    """Return whether an object is an instance of a class, and not a class itself."""
    return not isinstance(obj, type)


def is_a(obj: Any, entity_type: type[T]) -> bool:
    """Return whether an object is an instance of a class."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type[T]) -> bool:
    """Return whether an object is an instance of a class, or itself a subclass of it."""
    if is_a(obj, entity_type):
        return True
    return isinstance(obj, type) and issubclass(obj, entity_type)
