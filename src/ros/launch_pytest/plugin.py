"""The pytest plugin that launches what launch fixtures describe, and runs tests marked with `launch` beside it."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Generator, Iterator
from typing import Any

import pytest

from ._marks import (
    fixture_name,
    fixture_scope,
    is_launch_test,
    is_launch_test_mark_valid,
    is_shutdown_test,
    is_valid_test_item,
    launch_of,
    need_shutdown_test_item,
)
from ._marks import get_launch_test_fixture as get_launch_test_fixture
from ._marks import get_launch_test_fixturename as get_launch_test_fixturename
from ._marks import has_shutdown_kwarg as has_shutdown_kwarg
from ._marks import is_same_launch_test_fixture as is_same_launch_test_fixture
from ._wrapping import run_until_complete as run_until_complete
from ._wrapping import (
    wrap_asyncgen,
    wrap_asyncgen_fscope,
    wrap_coroutine,
    wrap_func,
    wrap_generator,
    wrap_generator_fscope,
)
from .fixture import (
    OPTIONS_ATTRIBUTE,
    finalize_launch_service,
    get_event_loop_fixture,
    get_launch_context_fixture,
    get_launch_service_fixture,
)

event_loop = get_event_loop_fixture()
launch_service = get_launch_service_fixture()
launch_context = get_launch_context_fixture()

_SHUTDOWN_SUFFIX = "[shutdown_test]"


class LaunchTestWarning(pytest.PytestWarning):
    """A launch test is not marked as it should be."""


def pytest_configure(config: pytest.Config) -> None:
    """Add the mark of launch tests."""
    config.addinivalue_line(
        "markers",
        "launch(fixture, shutdown=False): run a test beside the processes that the fixture describes, or after them",
    )


# The launch of a fixture ----------------------------------------------------------------------------


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: Any, request: Any) -> Generator[None, Any, Any]:
    """Launch what a launch fixture describes, until it says that it is ready."""
    options = getattr(fixturedef.func, OPTIONS_ATTRIBUTE, None)
    if options is None:
        return (yield)
    loop = request.getfixturevalue("event_loop")
    service = request.getfixturevalue("launch_service")
    result = yield
    description = result[0] if isinstance(result, tuple | list) else result
    eprefix = f"When executing launch fixture {fixturedef.argname}"
    finalize = functools.partial(
        finalize_launch_service, service, eprefix=eprefix, auto_shutdown=options["auto_shutdown"]
    )
    _launch(loop, service, description, options["shutdown_when_idle"], eprefix)
    request.addfinalizer(finalize)
    return result


def _launch(loop: Any, service: Any, description: Any, shutdown_when_idle: bool, eprefix: str) -> None:
    import asyncio

    from launch import LaunchDescription

    if not isinstance(description, LaunchDescription):
        raise RuntimeError(
            f"{eprefix}: the returned value must be either a launch description or a sequence that begins with one, "
            f"but it is {description!r}"
        )
    if service.task is not None:
        raise RuntimeError(f"{eprefix}: its launch service already runs the launch of another fixture")
    ready = loop.create_future()

    def on_ready() -> None:
        if not ready.done():
            ready.set_result(None)

    get_ready_to_test_action(description)._add_callback(on_ready)
    service.include_launch_description(description)
    run = loop.create_task(service.run_async(shutdown_when_idle=shutdown_when_idle))
    loop.run_until_complete(asyncio.wait([run, ready], return_when=asyncio.FIRST_COMPLETED))
    if not ready.done():
        reason = service.error or f"return code '{run.result()}'"
        raise RuntimeError(f"{eprefix}: the launch ended before it was ready to be tested: {reason}")


def iterate_ready_to_test_actions(entities: Any) -> Iterator[Any]:
    """Yield the `ReadyToTest` actions among entities and inside of them."""
    from launch_testing.loader import _ready_to_test_actions

    yield from dict.fromkeys(_ready_to_test_actions(entities))


def get_ready_to_test_action(launch_description: Any) -> Any:
    """Return the `ReadyToTest` action of a launch description; one is appended where there is none.

    Raises
    ------
    RuntimeError
        If there are several.
    """
    from .actions import ReadyToTest

    actions = list(iterate_ready_to_test_actions(launch_description.entities))
    if len(actions) > 1:
        raise RuntimeError("There can be only one ReadyToTest action in the launch description")
    if actions:
        return actions[0]
    action = ReadyToTest()
    launch_description.add_entity(action)
    return action


# Collection -----------------------------------------------------------------------------------------


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: Any) -> Any:
    """Create the items of a launch test: a second one for what follows the end of a launch that others share."""
    if not (is_valid_test_item(obj) and collector.funcnamefilter(name)):
        return None
    marks = [mark for mark in getattr(obj, "pytestmark", []) if mark.name == "launch"]
    if not marks:
        return None
    fixture = marks[-1].kwargs.get("fixture")
    if fixture is None:
        return _invalid_items(collector, name, obj)
    return generate_test_items(
        collector,
        name,
        obj,
        fixture_name(fixture),
        is_shutdown=bool(marks[-1].kwargs.get("shutdown", False)),
        needs_renaming=False,
    )


def generate_test_items(
    collector: Any, name: str, obj: Any, fixturename: str, *, is_shutdown: bool, needs_renaming: bool
) -> list[Any]:
    """Return the items of a launch test.

    Parameters
    ----------
    collector
        Of the module or class.
    name, obj
        The test function's name and itself.
    fixturename
        The launch fixture.
    is_shutdown
        Whether the items run after the launch has ended.
    needs_renaming
        Whether their names say so.
    """
    marked = pytest.mark.usefixtures(fixturename, "event_loop", "launch_service")
    items: list[Any] = []
    for function in _functions(collector, name, obj, marked):
        item = _renamed(function) if needs_renaming else function
        item._launch_pytest_is_shutdown = is_shutdown
        items.append(item)
        if is_shutdown and need_shutdown_test_item(obj) and not needs_renaming:
            message = "generator or async generator based launch test items cannot be marked with shutdown=True"
            item.warn(LaunchTestWarning(message))
            item._launch_pytest_error = message
    splits = need_shutdown_test_item(obj) and not is_shutdown
    if splits and items and fixture_scope(items[0]) != "function":
        rest = generate_test_items(collector, name, obj, fixturename, is_shutdown=True, needs_renaming=True)
        for first, second in zip(list(items), rest, strict=True):
            # The second item goes on where the first one stopped.
            second._launch_pytest_first_part = first
            first._launch_pytest_is_first_part = True
        items += rest
    return items


def _functions(collector: Any, name: str, obj: Any, *marks: Any) -> list[Any]:
    function = getattr(obj, "__func__", obj)
    before = list(getattr(function, "pytestmark", []))
    for mark in marks:
        function = mark(function)
    try:
        return list(collector._genfunctions(name, obj))
    finally:
        function.pytestmark = before


def _renamed(item: Any) -> Any:
    function = item.originalname
    renamed = pytest.Function.from_parent(
        item.parent,
        name=f"{function}{_SHUTDOWN_SUFFIX}{item.name.removeprefix(function)}",
        callspec=getattr(item, "callspec", None),
        callobj=item.obj,
        fixtureinfo=item._fixtureinfo,
        originalname=f"{function}{_SHUTDOWN_SUFFIX}",
    )
    # The item's id is made of this name; the function is looked up by it, too.
    renamed.originalname = function
    return renamed


def _invalid_items(collector: Any, name: str, obj: Any) -> list[Any]:
    message = '"fixture" keyword argument is required in a pytest.mark.launch() decorator'
    items = _functions(collector, name, obj)
    for item in items:
        item.warn(LaunchTestWarning(message))
        item.add_marker(pytest.mark.skip(message))
    return items


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(session: Any, config: Any, items: list[Any]) -> None:
    """Sort the tests that run after a launch behind those that run beside it."""
    places: dict[Any, list[int]] = {}
    for place, item in enumerate(items):
        if isinstance(item, pytest.Function) and is_launch_test(item) and is_launch_test_mark_valid(item):
            places.setdefault(launch_of(item), []).append(place)
    for group in places.values():
        ordered = sorted((items[place] for place in group), key=is_shutdown_test)
        for place, item in zip(group, ordered, strict=True):
            items[place] = item


# Running --------------------------------------------------------------------------------------------


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: Any) -> bool | None:
    """Run a launch test beside its launch, or after it."""
    if not is_launch_test(pyfuncitem):
        return None
    error = getattr(pyfuncitem, "_launch_pytest_error", None)
    if error is not None:
        pytest.fail(error, pytrace=False)
    loop = pyfuncitem.funcargs["event_loop"]
    service = pyfuncitem.funcargs["launch_service"]
    shut_down = functools.partial(finalize_launch_service, service, eprefix=f"When running test {pyfuncitem.name}")
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    run = _runner(pyfuncitem, functools.partial(pyfuncitem.obj, **arguments), loop, shut_down)
    run()
    return True


def _runner(item: Any, func: Callable[[], Any], loop: Any, shut_down: Callable[[], None]) -> Callable[[], None]:
    first = getattr(item, "_launch_pytest_first_part", None)
    if first is not None:
        return functools.partial(_run_second_part, first, loop, shut_down)
    keep = item if getattr(item, "_launch_pytest_is_first_part", False) else None
    if inspect.isgeneratorfunction(item.obj):
        if keep is None:
            return wrap_generator_fscope(func, loop, shut_down)
        return wrap_generator(func, loop, functools.partial(setattr, keep, "_launch_pytest_rest"))
    if inspect.isasyncgenfunction(item.obj):
        if keep is None:
            return wrap_asyncgen_fscope(func, loop, shut_down)
        return wrap_asyncgen(func, loop, functools.partial(setattr, keep, "_launch_pytest_rest"))
    before = shut_down if is_shutdown_test(item) else lambda: None
    if inspect.iscoroutinefunction(item.obj):
        return wrap_coroutine(func, loop, before)
    return wrap_func(func, loop, before)


def _run_second_part(first: Any, loop: Any, shut_down: Callable[[], None]) -> None:
    shut_down()
    rest = getattr(first, "_launch_pytest_rest", None)
    if rest is None:
        pytest.skip("the first part of the test did not come to its yield")
    rest()
