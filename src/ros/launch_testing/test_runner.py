"""Runs of launched systems with their tests."""

from __future__ import annotations

import inspect
import sys
import threading
import unittest
from typing import Any, cast

from launch import Action, LaunchDescription, LaunchDescriptionSource, LaunchService
from launch.actions import IncludeLaunchDescription, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.events.process import ProcessExited, ProcessStarted

from .io_handler import ActiveIoHandler
from .loader import TestRun
from .parse_arguments import parse_launch_arguments
from .proc_info_handler import ActiveProcInfoHandler
from .ready_to_test_action_timeout import TIMEOUT_ATTRIBUTE
from .test_result import FailResult, SkipResult, TestResult
from .util import KeepAliveProc

DEFAULT_TIMEOUT = 15.0


class _LaunchDiedException(Exception):
    """The launch ended before its tests did."""


class LaunchTestRunner:
    """Runner that executes some runs one after another.

    Parameters
    ----------
    test_runs
        The runs.
    launch_file_arguments
        Arguments of the launches, like `name:=value`.
    debug
        Whether everything that happens in the launches is logged.
    """

    def __init__(
        self, test_runs: list[TestRun], launch_file_arguments: list[str] | None = None, debug: bool = False
    ) -> None:
        self._test_runs = test_runs
        self._launch_file_arguments = launch_file_arguments or []
        self._debug = debug

    def generate_preamble(self) -> list[Action]:
        """Return the actions that come before those of a launch under test; a subclass may add some."""
        return []

    def run(self) -> dict[TestRun, unittest.TestResult]:
        """Execute the runs and return the results of each."""
        results: dict[TestRun, unittest.TestResult] = {}
        for number, run in enumerate(self._test_runs, 1):
            sys.stdout.write(f"Starting test run {number} of {len(self._test_runs)}: {run}\n")
            worker = _RunnerWorker(run, self.generate_preamble(), self._launch_file_arguments, self._debug)
            try:
                results[run] = worker.run()
            except unittest.case.SkipTest as skip:
                results[run] = SkipResult(run, skip_reason=str(skip))
            except _LaunchDiedException:
                # Whether somebody interrupted it or the processes died, what follows is not worth to be tried.
                results[run] = FailResult(run, "the launch ended before its tests did")
        return results

    def validate(self) -> None:
        """Check that the runs can be made at all.

        Raises
        ------
        RuntimeError
            If a test description takes arguments that it does not get, or does not take those that it gets.
        """
        for run in self._test_runs:
            function = run.test_description_function
            wanted = set(inspect.signature(function).parameters)
            for name in sorted(set(run.param_args) - wanted):
                raise RuntimeError(
                    f"Could not find an argument in generate_test_description matching the parameter '{name}'"
                )
            for name in sorted(wanted - {"ready_fn"} - set(run.param_args)):
                raise RuntimeError(f"generate_test_description has unexpected extra argument '{name}'")


class _RunnerWorker:
    """Worker that executes one run."""

    def __init__(
        self, test_run: TestRun, preamble: list[Action], launch_file_arguments: list[str], debug: bool
    ) -> None:
        self._test_run = test_run
        self._preamble = preamble
        self._arguments = parse_launch_arguments(launch_file_arguments)
        self._launch_service = LaunchService(debug=debug)
        self._processes_launched = threading.Event()
        self._tests_completed = threading.Event()
        self._results = TestResult(stream=unittest.runner._WritelnDecorator(sys.stderr), verbosity=2)
        self._timeout = getattr(test_run.test_description_function, TIMEOUT_ATTRIBUTE, DEFAULT_TIMEOUT)

    def run(self) -> TestResult:
        """Execute the run and return its results."""
        description, context = self._test_run.normalized_test_description(ready_fn=self._processes_launched.set)
        self.proc_info = ActiveProcInfoHandler()
        self.proc_output = ActiveIoHandler()
        self._bind(context)
        self._launch_service.include_launch_description(self._wrap(description))

        test_thread = threading.Thread(target=self._run_test)
        test_thread.start()
        try:
            self._launch_service.run()
        finally:
            # A launch that died before it was ready never will be.
            self._launch_ended = True
            self._processes_launched.set()
            test_thread.join()
        if not self._tests_completed.is_set():
            sys.stdout.write("Processes under test stopped before tests completed\n")
            self._print_process_output_summary()
            raise _LaunchDiedException
        self._results.append(_run_tests(self._test_run.post_shutdown_tests))
        return self._results

    def _bind(self, context: dict[str, Any]) -> None:
        test_args = dict(self._arguments)
        active = {"proc_info": self.proc_info, "proc_output": self.proc_output, "test_args": test_args}
        self._test_run.bind(
            self._test_run.pre_shutdown_tests,
            injected_attributes=active,
            injected_args={
                **context,
                **self._test_run.param_args,
                **active,
                "launch_service": self._launch_service,
            },
        )
        # Nothing happens any more, so there is nothing to wait for.
        passive = {
            "proc_info": self.proc_info._proc_info_handler,
            "proc_output": self.proc_output._io_handler,
            "test_args": test_args,
        }
        self._test_run.bind(
            self._test_run.post_shutdown_tests,
            injected_attributes=passive,
            injected_args={**context, **self._test_run.param_args, **passive},
        )

    def _wrap(self, description: LaunchDescription) -> LaunchDescription:
        # What keeps the launch alive is not under test.
        keep_alive = [KeepAliveProc()] if self._test_run.markers.get("keep_alive") else []

        def on_start(event: ProcessStarted, context: Any) -> None:
            if event.action not in keep_alive:
                self.proc_info.append(event)
                self.proc_output.track(event.process_name)

        def on_exit(event: ProcessExited, context: Any) -> None:
            if event.action not in keep_alive:
                self.proc_info.append(event)

        handlers = [
            OnProcessIO(on_stdout=self.proc_output.append, on_stderr=self.proc_output.append),
            OnProcessStart(on_start=on_start),
            OnProcessExit(on_exit=on_exit),
        ]
        return LaunchDescription(
            [
                *keep_alive,
                *(RegisterEventHandler(handler) for handler in handlers),
                *self._preamble,
                IncludeLaunchDescription(
                    LaunchDescriptionSource(launch_description=description), launch_arguments=self._arguments
                ),
            ]
        )

    _launch_ended = False

    def _run_test(self) -> None:
        try:
            ready = self._processes_launched.wait(self._timeout)
            if self._launch_ended:
                return
            if not ready:
                sys.stdout.write(
                    f"Timed out after {self._timeout:g} s waiting for processes to start up: the launch "
                    "description's ReadyToTest action was not executed\n"
                )
                return
            results = _run_tests(self._test_run.pre_shutdown_tests)
            if not self._launch_ended:
                self._results.append(results)
                self._tests_completed.set()
        finally:
            self._launch_service.shutdown()

    def _print_process_output_summary(self) -> None:
        failed = [info for info in self.proc_info if isinstance(info, ProcessExited) and info.returncode]
        for info in failed:
            sys.stdout.write(f"Process '{info.process_name}' exited with {info.returncode}\n")
            if info.process_name in self.proc_output.process_names():
                text = "".join(piece.text.decode(errors="replace") for piece in self.proc_output[info.process_name])
                sys.stdout.write(f"##### '{info.process_name}' output #####\n{text}\n{'#' * 42}\n")


def _run_tests(tests: unittest.TestSuite) -> TestResult:
    runner = unittest.TextTestRunner(verbosity=2, resultclass=TestResult)
    return cast("TestResult", runner.run(tests))
