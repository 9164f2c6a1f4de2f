"""The fixtures of a launch: its description, and the service, context and event loop that come with it."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Iterator
from typing import Any, Literal

import pytest
from launch import LaunchContext, LaunchService

Scope = Literal["function", "class", "module", "package", "session"]
SCOPES = ("function", "class", "module", "package", "session")

#: Where a fixture function keeps how its launch is to be run.
OPTIONS_ATTRIBUTE = "_launch_pytest_fixture_options"
_OVERRIDABLE_SCOPE = "_launch_pytest_overridable_scope"


def fixture(
    decorated: Callable[..., Any] | None = None,
    *args: Any,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Decorate a function that returns a launch description, so that it is launched for the tests that name it.

    The module of the function gets the fixtures `event_loop`, `launch_service` and `launch_context` with the
    same scope, unless it has its own or some with a wider one.

    Parameters
    ----------
    decorated
        The function.
    shutdown_when_idle
        Whether the launch may end when nothing is left to do.
    auto_shutdown
        Whether the launch is stopped with the fixture; otherwise it must end by itself.
    *args, **kwargs
        As for `pytest.fixture`.
    """
    scope: Any = kwargs.get("scope", "function")
    if scope in SCOPES and scope != "function":
        _provide_fixtures(sys._getframe(1).f_globals, scope)

    def decorator(function: Callable[..., Any]) -> Any:
        options = {"shutdown_when_idle": shutdown_when_idle, "auto_shutdown": auto_shutdown}
        setattr(function, OPTIONS_ATTRIBUTE, options)
        return pytest.fixture(*args, **kwargs)(function)

    return decorator if decorated is None else decorator(decorated)


def get_launch_service_fixture(*, scope: Scope = "function", overridable: bool = True) -> Any:
    """Return a fixture that is a launch service.

    Parameters
    ----------
    scope
        Its scope.
    overridable
        Whether `fixture` may replace it by one with a wider scope.
    """

    def launch_service(event_loop: asyncio.AbstractEventLoop) -> Iterator[LaunchService]:
        service = LaunchService()
        yield service
        finalize_launch_service(service, eprefix="When tearing down launch_service fixture")

    return _as_fixture(launch_service, scope, overridable)


def get_launch_context_fixture(*, scope: Scope = "function", overridable: bool = True) -> Any:
    """Return a fixture that is the context of the launch service; as `get_launch_service_fixture`."""

    def launch_context(launch_service: LaunchService) -> LaunchContext:
        return launch_service.context

    return _as_fixture(launch_context, scope, overridable)


def get_event_loop_fixture(*, scope: Scope = "function", overridable: bool = True) -> Any:
    """Return a fixture that is the event loop of the launch service; as `get_launch_service_fixture`."""

    def event_loop() -> Iterator[asyncio.AbstractEventLoop]:
        loop = asyncio.new_event_loop()
        yield loop
        loop.run_until_complete(loop.shutdown_asyncgens())
        loop.close()

    return _as_fixture(event_loop, scope, overridable)


def finalize_launch_service(launch_service: LaunchService, eprefix: str = "", auto_shutdown: bool = True) -> None:
    """Wait for the end of a launch.

    Parameters
    ----------
    launch_service
        The service.
    eprefix
        Begins the message of an error.
    auto_shutdown
        Whether the launch is stopped first.

    Raises
    ------
    AssertionError
        If the launch ends with an error.
    """
    loop, task = launch_service.event_loop, launch_service.task
    if loop is None or task is None or loop.is_closed():
        return
    if auto_shutdown:
        launch_service.shutdown(force_sync=True)
    code = loop.run_until_complete(task)
    assert code == 0, f"{eprefix} launch service failed when finishing, return code '{code}'"


def _as_fixture(function: Callable[..., Any], scope: Scope, overridable: bool) -> Any:
    made = pytest.fixture(scope=scope)(function)
    if overridable:
        setattr(made, _OVERRIDABLE_SCOPE, scope)
    return made


def _provide_fixtures(namespace: dict[str, Any], scope: Scope) -> None:
    makers = {
        "launch_service": get_launch_service_fixture,
        "launch_context": get_launch_context_fixture,
        "event_loop": get_event_loop_fixture,
    }
    for name, make in makers.items():
        present = namespace.get(name)
        present_scope = getattr(present, _OVERRIDABLE_SCOPE, None)
        if present is None or (present_scope and SCOPES.index(present_scope) < SCOPES.index(scope)):
            namespace[name] = make(scope=scope)
