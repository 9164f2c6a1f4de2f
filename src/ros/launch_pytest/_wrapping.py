"""Functions that run launch tests of each kind beside an event loop: plain ones, coroutines and generators."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest


def run_until_complete(loop: Any, future_like: Any) -> Any:
    """Run an event loop until a future is done, and return its result."""
    return loop.run_until_complete(future_like)


def wrap_coroutine(func: Callable[[], Any], event_loop: Any, before_test: Callable[[], None]) -> Callable[[], None]:
    """Return a function that runs a coroutine in the event loop."""

    def run() -> None:
        before_test()
        run_until_complete(event_loop, func())

    return run


def wrap_func(func: Callable[[], Any], event_loop: Any, before_test: Callable[[], None]) -> Callable[[], None]:
    """Return a function that runs another in a thread, while the event loop runs in this one."""

    def run() -> None:
        before_test()
        run_until_complete(event_loop, event_loop.run_in_executor(None, func))

    return run


def wrap_generator(
    func: Callable[[], Any], event_loop: Any, on_shutdown: Callable[[Callable[[], None]], None]
) -> Callable[[], None]:
    """Return a function that runs a generator to its yield, and hands a function on that runs the rest.

    Parameters
    ----------
    func
        Returns the generator.
    event_loop
        Runs meanwhile.
    on_shutdown
        Gets the function for the rest.
    """

    def run() -> None:
        generator = func()
        _advance_in_thread(event_loop, generator)
        on_shutdown(lambda: _finish_in_thread(event_loop, generator))

    return run


def wrap_generator_fscope(
    func: Callable[[], Any], event_loop: Any, on_shutdown: Callable[[], None]
) -> Callable[[], None]:
    """Return a function that runs a generator to its yield, ends the launch, and runs the rest."""

    def run() -> None:
        generator = func()
        _advance_in_thread(event_loop, generator)
        on_shutdown()
        _finish_in_thread(event_loop, generator)

    return run


def wrap_asyncgen(
    func: Callable[[], Any], event_loop: Any, on_shutdown: Callable[[Callable[[], None]], None]
) -> Callable[[], None]:
    """Return a function that runs an asynchronous generator to its yield; as `wrap_generator`."""

    def run() -> None:
        generator = func()
        run_until_complete(event_loop, _advance(generator))
        on_shutdown(lambda: run_until_complete(event_loop, _finish(generator)))

    return run


def wrap_asyncgen_fscope(
    func: Callable[[], Any], event_loop: Any, on_shutdown: Callable[[], None]
) -> Callable[[], None]:
    """Return a function that runs an asynchronous generator to its yield, ends the launch, and runs the rest."""

    def run() -> None:
        generator = func()
        run_until_complete(event_loop, _advance(generator))
        on_shutdown()
        run_until_complete(event_loop, _finish(generator))

    return run


_ENDED = object()


def _advance_in_thread(loop: Any, generator: Any) -> None:
    # A StopIteration cannot leave a future.
    if run_until_complete(loop, loop.run_in_executor(None, next, generator, _ENDED)) is _ENDED:
        pytest.fail("launch tests using a generator function must yield once", pytrace=False)


def _finish_in_thread(loop: Any, generator: Any) -> None:
    if run_until_complete(loop, loop.run_in_executor(None, next, generator, _ENDED)) is not _ENDED:
        pytest.fail("launch tests using a generator function must stop iteration after yielding once", pytrace=False)


async def _advance(generator: Any) -> None:
    if await anext(generator, _ENDED) is _ENDED:
        pytest.fail("launch tests using an async gen function must yield once", pytrace=False)


async def _finish(generator: Any) -> None:
    if await anext(generator, _ENDED) is not _ENDED:
        pytest.fail("launch tests using an async gen function must stop iteration after yielding once", pytrace=False)
