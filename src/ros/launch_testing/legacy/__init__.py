"""The older way to test a launch: test programs run beside the processes, and their exit codes count."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from launch import LaunchDescription, LaunchService
from launch.action import Action
from launch.actions import EmitEvent, ExecuteLocal, ExecuteProcess, OpaqueCoroutine, RegisterEventHandler
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO
from launch.events import Shutdown

from .output import create_output_lines_filter as create_output_lines_filter
from .output import create_output_lines_test as create_output_lines_test
from .output import create_output_regex_test as create_output_regex_test
from .output import create_output_test_from_file as create_output_test_from_file
from .output import get_default_filtered_patterns as get_default_filtered_patterns
from .output import get_default_filtered_prefixes as get_default_filtered_prefixes
from .output import get_rmw_output_filter as get_rmw_output_filter

__all__ = [
    "LaunchTestService",
    "create_output_lines_filter",
    "create_output_lines_test",
    "create_output_regex_test",
    "create_output_test_from_file",
    "get_default_filtered_patterns",
    "get_default_filtered_prefixes",
    "get_rmw_output_filter",
]


class LaunchTestService:
    """Service that adds actions to launch descriptions whose outcomes are tests, and runs these."""

    __test__ = False

    def __init__(self) -> None:
        self.__outcomes: dict[str, str] = {}
        self.__count = 0

    def add_fixture_action(
        self, launch_description: LaunchDescription, action: Action, exit_allowed: Any = (0,)
    ) -> Action:
        """Add an action that the tests need.

        Parameters
        ----------
        launch_description
            Gets the action.
        action
            If it runs a process, the launch ends with that.
        exit_allowed
            The exit codes with which the process may end before the tests are done; True for any.
        """
        launch_description.add_action(action)
        if isinstance(action, ExecuteLocal):
            test = self.__new_test("fixture")

            def on_exit(event: Any, context: Any) -> list[Action]:
                allowed = exit_allowed is True or event.returncode in (exit_allowed or ())
                if not context.is_shutdown:
                    outcome = "ok" if allowed else f"process {event.process_name} exited early with {event.returncode}"
                    self.__outcomes[test] = outcome
                return [] if context.is_shutdown else [EmitEvent(event=Shutdown(reason=f"{test} ended"))]

            self.__outcomes[test] = "ok"
            handler = OnProcessExit(target_action=action, on_exit=on_exit)
            launch_description.add_action(RegisterEventHandler(handler))
        return action

    def add_test_action(self, launch_description: LaunchDescription, action: Action) -> Action:
        """Add an action that is a test: its process must end with 0, or its coroutine without an exception.

        Parameters
        ----------
        launch_description
            Gets the action.
        action
            Runs a process or a coroutine.
        """
        if not isinstance(action, ExecuteLocal | OpaqueCoroutine):
            raise TypeError(f"only processes and coroutines can be tests, not {action!r}")
        test = self.__new_test("test")
        launch_description.add_action(action)

        def on_end(event: Any, context: Any) -> list[Action]:
            future = action.get_asyncio_future()
            if isinstance(action, ExecuteLocal):
                failed = action.return_code != 0
                reason = f"exit code {action.return_code}"
            elif future is not None and future.cancelled():
                failed, reason = True, "cancelled"
            else:
                error = None if future is None else future.exception()
                failed, reason = error is not None, repr(error)
            self.__outcomes[test] = reason if failed else "ok"
            return self.__shutdown_if_done(failed)

        handler = OnExecutionComplete(target_action=action, on_completion=on_end)
        launch_description.entities.insert(0, RegisterEventHandler(handler))
        return action

    def add_output_test(
        self,
        launch_description: LaunchDescription,
        action: ExecuteProcess,
        output_test: Any,
        test_suffix: str = "output",
        output_filter: Callable[[bytes], bytes] | None = None,
        side_effect: str | None = None,
    ) -> ExecuteProcess:
        """Add a test of what a process prints.

        Parameters
        ----------
        launch_description
            Has the action.
        action
            Runs the process.
        output_test
            Takes all output so far and tells whether it is enough; or that with a suffix for the test's name.
        test_suffix
            Ends the test's name.
        output_filter
            Applied to each piece of output first.
        side_effect
            'shutdown' to end the launch when the test passes.
        """
        if isinstance(output_test, tuple):
            output_test, test_suffix = output_test
        test = self.__new_test(test_suffix)
        received = bytearray()

        def on_output(event: Any) -> list[Action] | None:
            if self.__outcomes[test] == "ok":
                return None
            received.extend(event.text if output_filter is None else output_filter(event.text))
            if not output_test(bytes(received)):
                return None
            self.__outcomes[test] = "ok"
            if side_effect == "shutdown":
                return [EmitEvent(event=Shutdown(reason=f"{test} passed"))]
            return self.__shutdown_if_done(False)

        handler = OnProcessIO(target_action=action, on_stdout=on_output, on_stderr=on_output)
        launch_description.entities.insert(0, RegisterEventHandler(handler))
        return action

    def run(self, launch_service: LaunchService, *args: Any, **kwargs: Any) -> int:
        """Run a launch service and return 0 if all tests passed, else 1; what failed is logged.

        Parameters
        ----------
        launch_service
            The service.
        *args, **kwargs
            As for its `run`.
        """
        from launch.logging import get_logger

        result = launch_service.run(*args, **kwargs)
        failed = {test: outcome for test, outcome in self.__outcomes.items() if outcome != "ok"}
        for test, outcome in failed.items():
            get_logger("launch_testing").error(f"'{test}' failed: {outcome or 'did not end'}")
        return 1 if failed or result else 0

    def __new_test(self, suffix: str) -> str:
        self.__count += 1
        name = f"test_{self.__count}_{suffix}"
        self.__outcomes[name] = ""
        return name

    def __shutdown_if_done(self, failed: bool) -> list[Action]:
        pending: Iterable[str] = [test for test, outcome in self.__outcomes.items() if not outcome]
        if failed or not pending:
            reason = "a test failed" if failed else "all tests passed"
            return [EmitEvent(event=Shutdown(reason=reason))]
        return []
