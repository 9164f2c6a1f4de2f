"""Waiting for processes: coroutines for asynchronous tests, and functions ending in `_sync` for others.

The output of a process can only be asked for if its action was made with `cached_output=True`.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable, Iterator
from typing import Any

from launch import LaunchContext
from launch.actions import ExecuteProcess
from launch.event_handler import BaseEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart

Validate = Callable[[str], Any]


@contextlib.contextmanager
def register_event_handler(context: LaunchContext, event_handler: BaseEventHandler) -> Iterator[None]:
    """Register an event handler for the length of a block."""
    context.register_event_handler(event_handler)
    try:
        yield
    finally:
        context.unregister_event_handler(event_handler)


async def wait_for_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> bool:
    """Wait for output of a process, and return whether it came.

    Parameters
    ----------
    launch_context
        The launch context.
    execute_process_action
        The action that runs the process.
    validate_output
        Takes all output so far; says no by returning False or by an AssertionError.
    timeout
        Seconds to wait at most.
    """
    return await _wait(
        launch_context, _on_output(execute_process_action), _stdout(execute_process_action, validate_output), timeout
    )


async def assert_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait for output of a process; parameters as for `wait_for_output`.

    Raises
    ------
    AssertionError
        If it does not come.
    """
    await wait_for_output(launch_context, execute_process_action, validate_output, timeout)
    _assert_valid(validate_output, execute_process_action.get_stdout())


def wait_for_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> bool:
    """Wait for output of a process, and return whether it came; parameters as for `wait_for_output`."""
    return _wait_sync(
        launch_context, _on_output(execute_process_action), _stdout(execute_process_action, validate_output), timeout
    )


def assert_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait for output of a process; parameters as for `wait_for_output`.

    Raises
    ------
    AssertionError
        If it does not come.
    """
    wait_for_output_sync(launch_context, execute_process_action, validate_output, timeout)
    _assert_valid(validate_output, execute_process_action.get_stdout())


async def wait_for_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> bool:
    """Wait for errors that a process prints, and return whether they came; as `wait_for_output`."""
    return await _wait(
        launch_context, _on_output(execute_process_action), _stderr(execute_process_action, validate_output), timeout
    )


async def assert_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait for errors that a process prints; as `assert_output`."""
    await wait_for_stderr(launch_context, execute_process_action, validate_output, timeout)
    _assert_valid(validate_output, execute_process_action.get_stderr())


def wait_for_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> bool:
    """Wait for errors that a process prints, and return whether they came; as `wait_for_output`."""
    return _wait_sync(
        launch_context, _on_output(execute_process_action), _stderr(execute_process_action, validate_output), timeout
    )


def assert_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteProcess,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait for errors that a process prints; as `assert_output`."""
    wait_for_stderr_sync(launch_context, execute_process_action, validate_output, timeout)
    _assert_valid(validate_output, execute_process_action.get_stderr())


async def wait_for_start(
    launch_context: LaunchContext, execute_process_action: ExecuteProcess, timeout: float | None = None
) -> bool:
    """Wait for the start of a process, and return whether it came.

    Parameters
    ----------
    launch_context
        The launch context.
    execute_process_action
        The action that runs the process.
    timeout
        Seconds to wait at most.
    """
    return await _wait(launch_context, _on_start(execute_process_action), _started(execute_process_action), timeout)


def wait_for_start_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteProcess, timeout: float | None = None
) -> bool:
    """Wait for the start of a process, and return whether it came; as `wait_for_start`."""
    return _wait_sync(launch_context, _on_start(execute_process_action), _started(execute_process_action), timeout)


async def wait_for_exit(
    launch_context: LaunchContext, execute_process_action: ExecuteProcess, timeout: float | None = None
) -> bool:
    """Wait for the end of a process, and return whether it came; as `wait_for_start`."""
    return await _wait(launch_context, _on_exit(execute_process_action), _exited(execute_process_action), timeout)


def wait_for_exit_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteProcess, timeout: float | None = None
) -> bool:
    """Wait for the end of a process, and return whether it came; as `wait_for_start`."""
    return _wait_sync(launch_context, _on_exit(execute_process_action), _exited(execute_process_action), timeout)


Listen = Callable[[Callable[[], None]], BaseEventHandler]


def _on_output(action: ExecuteProcess) -> Listen:
    def listen(notify: Callable[[], None]) -> BaseEventHandler:
        return OnProcessIO(target_action=action, on_stdout=lambda event: notify(), on_stderr=lambda event: notify())

    return listen


def _on_start(action: ExecuteProcess) -> Listen:
    return lambda notify: OnProcessStart(target_action=action, on_start=lambda event, context: notify())


def _on_exit(action: ExecuteProcess) -> Listen:
    return lambda notify: OnProcessExit(target_action=action, on_exit=lambda event, context: notify())


def _stdout(action: ExecuteProcess, validate: Validate) -> Callable[[], bool]:
    return lambda: _is_valid(validate, action.get_stdout())


def _stderr(action: ExecuteProcess, validate: Validate) -> Callable[[], bool]:
    return lambda: _is_valid(validate, action.get_stderr())


def _started(action: ExecuteProcess) -> Callable[[], bool]:
    return lambda: "pid" in (action.process_details or {})


def _exited(action: ExecuteProcess) -> Callable[[], bool]:
    return lambda: action.return_code is not None


def _is_valid(validate: Validate, output: str) -> bool:
    try:
        return validate(output) is not False
    except AssertionError:
        return False


def _assert_valid(validate: Validate, output: str) -> None:
    assert validate(output) is not False, f"the output is not as expected:\n{output}"


async def _wait(context: LaunchContext, listen: Listen, condition: Callable[[], bool], timeout: float | None) -> bool:
    changed = asyncio.Event()

    async def until_true() -> None:
        while not condition():
            changed.clear()
            await changed.wait()

    with register_event_handler(context, listen(changed.set)):
        try:
            await asyncio.wait_for(until_true(), timeout)
        except TimeoutError:
            return condition()
        return True


def _wait_sync(context: LaunchContext, listen: Listen, condition: Callable[[], bool], timeout: float | None) -> bool:
    changed = threading.Condition()

    def notify() -> None:
        with changed:
            changed.notify_all()

    with register_event_handler(context, listen(notify)), changed:
        return changed.wait_for(condition, timeout)
