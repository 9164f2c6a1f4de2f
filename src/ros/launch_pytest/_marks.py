"""Marks of launch tests: their launch, and whether they run after its shutdown."""

from __future__ import annotations

import inspect
from typing import Any

import pytest


def is_launch_test(item: Any) -> bool:
    """Return whether an item is marked as a launch test."""
    return item.get_closest_marker("launch") is not None


def is_launch_test_mark_valid(item: Any) -> bool:
    """Return whether the mark of a launch test names a fixture."""
    return "fixture" in item.get_closest_marker("launch").kwargs


def has_shutdown_kwarg(item: Any) -> bool:
    """Return whether a launch test is to run after the launch has ended."""
    return bool(item.get_closest_marker("launch").kwargs.get("shutdown", False))


def get_launch_test_fixture(item: Any) -> Any:
    """Return the fixture of a launch test, None where its mark names none."""
    return item.get_closest_marker("launch").kwargs.get("fixture")


def get_launch_test_fixturename(item: Any) -> str | None:
    """Return the name of the fixture of a launch test."""
    fixture = get_launch_test_fixture(item)
    return None if fixture is None else fixture_name(fixture)


def fixture_name(fixture: Any) -> str:
    """Return the name that a launch fixture goes by."""
    return str(getattr(fixture, "name", None) or fixture.__name__)


def is_valid_test_item(obj: Any) -> bool:
    """Return whether something can be a launch test: a function, coroutine, generator or asynchronous generator."""
    return inspect.isfunction(obj) or inspect.ismethod(obj)


def need_shutdown_test_item(obj: Any) -> bool:
    """Return whether a launch test has a second part that runs after the launch has ended."""
    return inspect.isgeneratorfunction(obj) or inspect.isasyncgenfunction(obj)


def is_shutdown_test(item: Any) -> bool:
    """Return whether an item runs after the launch has ended."""
    return bool(getattr(item, "_launch_pytest_is_shutdown", False))


def is_same_launch_test_fixture(left_item: Any, right_item: Any) -> bool:
    """Return whether two items run beside the same launch."""
    return bool(launch_of(left_item) == launch_of(right_item))


def launch_of(item: Any) -> Any:
    """Return what identifies the launch of an item."""
    name = get_launch_test_fixturename(item)
    scope = fixture_scope(item)
    parameters = getattr(getattr(item, "callspec", None), "indices", {})
    node: Any = item
    if scope != "function":
        kinds = {"class": pytest.Class, "module": pytest.Module, "package": pytest.Package}
        node = item.getparent(kinds[scope]) if scope in kinds else None
        node = item.session if node is None else node
    return name, scope, node, parameters.get(name)


def fixture_scope(item: Any) -> str:
    """Return how long the launch of an item lasts: the scope of its fixture."""
    definitions = item._fixtureinfo.name2fixturedefs.get(get_launch_test_fixturename(item) or "")
    return definitions[-1].scope if definitions else "function"
