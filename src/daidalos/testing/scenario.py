"""One scenario: the lock-step run that a test is part of, its clock, and what fails in it."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError
from daidalos.lockstep.commands import body_of
from daidalos.lockstep.programs import Program
from daidalos.lockstep.run import Run
from daidalos.testing.kept_world import keep_world

if TYPE_CHECKING:
    from rclpy.node import Node

    from daidalos.testing.signals import Signal

INTERRUPTION = 1000
"""Number that stands for the signal of a scenario's end, beside those of the system."""

PICTURES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/PointCloud2")
"""Types that the bag of a scenario leaves out unless it is asked for: nobody else may listen, and they are large."""

_END_S = 10.0


class ScenarioFailure(AssertionError):
    """What a scenario requires does not hold."""


class Scenario:
    """The run that a test is part of.

    Parameters
    ----------
    run : Run
    program : Program
        The test itself.
    timeout : float
        Simulated time [s] after which the test fails.
    folder : Path
        Where its bag and its pictures are written.
    parameters : mapping of str
        Values that a fleet of runs varies, by name.

    Attributes
    ----------
    signals : list of Signal
        Everything that the test observes, in the order of creation.
    has_ended_programs : bool
        Whether the test has killed or interrupted a program.
    """

    def __init__(
        self, run: Run, program: Program, timeout: float, folder: Path, parameters: dict[str, Any] | None = None
    ) -> None:
        self.run = run
        self.program = program
        self.timeout = timeout
        self.folder = folder
        self.parameters = dict(parameters or {})
        self.metrics: dict[str, float] = {}
        self.signals: list[Signal] = []
        self.on_end: list[Callable[[], None]] = []
        self.has_ended_programs = False
        self._changed = threading.Condition()
        self._failures: list[ScenarioFailure] = []
        self._recorder: Program | None = None
        self._ended = False
        program.handlers[INTERRUPTION] = self._interrupt

    @property
    def has_ended(self) -> bool:
        """Whether the test is over."""
        return self._ended

    # Time.

    @property
    def now(self) -> float:
        """Simulated time since the start [s]."""
        return self.run.scheduler.now_ns / 1e9

    @property
    def seed(self) -> int:
        """Seed of all random numbers of the run."""
        return self.run.seed

    def sleep(self, seconds: float) -> None:
        """Wait for some simulated time [s]; a requirement that is broken meanwhile is raised.

        Raises
        ------
        ScenarioFailure
        """
        __tracebackhide__ = True
        self.wait(lambda: False, seconds)

    def wait(self, done: Callable[[], bool], within: float) -> bool:
        """Wait until a function of no arguments returns True, asked whenever something was observed.

        Parameters
        ----------
        done : callable
        within : float
            Simulated time [s].

        Returns
        -------
        bool
            Whether it came in time.

        Raises
        ------
        ScenarioFailure
            When a requirement is broken meanwhile.
        """
        __tracebackhide__ = True
        limit = None if math.isinf(within) else within
        try:
            with self._changed:
                came = self._changed.wait_for(lambda: bool(self._failures) or done(), limit)
        except ScenarioFailure as failure:
            raise ScenarioFailure(str(failure)) from None  # without the way through the scheduler
        self.check()
        return came

    def start_timeout(self) -> None:
        """Start to watch over the time-out."""
        self.run.scheduler.spawn(self._end_in_time, self.program, "time-out")

    def _end_in_time(self) -> None:
        self.run.scheduler.sleep_until(round(1e9 * self.timeout))
        if not self._ended:
            self.program.send_signal(INTERRUPTION)

    def _interrupt(self, number: int, frame: Any) -> None:
        # Not for a test that has ended, whose fixtures are being torn down.
        if not self._ended:
            raise ScenarioFailure(f"the scenario has not ended within {self.timeout:g} simulated seconds")

    # Failures.

    def notify(self) -> None:
        """Wake whoever waits for something that was observed."""
        with self._changed:
            self._changed.notify_all()

    def fail(self, message: str) -> None:
        """Record a failure, which is raised in the test as soon as it waits, or at its end."""
        self._failures.append(ScenarioFailure(message))
        self.notify()

    def check(self) -> None:
        """Raise the first failure that was recorded.

        Raises
        ------
        ScenarioFailure
        """
        __tracebackhide__ = True
        if self._failures:
            failure = self._failures[0]
            self._failures.clear()
            raise failure

    # The graph.

    @cached_property
    def node(self) -> Node:
        """Node of the test, spun in a thread of its own."""
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        context = rclpy.Context()
        rclpy.init(args=[], context=context)
        node = rclpy.create_node("scenario", context=context, start_parameter_services=False)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        threading.Thread(target=executor.spin, name="scenario", daemon=True).start()
        node.handle.graph.listen(lambda added, what: self.notify())
        return node

    def wait_for_graph(self, done: Callable[[], bool], within: float) -> bool:
        """Wait as `wait` does, also for what comes and goes in the graph."""
        __tracebackhide__ = True
        return self.node is not None and self.wait(done, within)

    def start_program(self, command: Sequence[str], **options: Any) -> Program:
        """Start a command line as a program of the run.

        Raises
        ------
        UserError
            When it is not a program of this Python.
        """
        found = body_of(command, os.environ)
        if found is None:
            raise UserError(f"in lock-step only programs of this Python run, not '{command[0]}'")
        argv, body = found
        program = self.run.create(body, argv, **options)
        program.start()
        return program

    def record(self, *, pictures: bool = False) -> Path:
        """Start to record all topics; return the bag's folder.

        Parameters
        ----------
        pictures : bool
            Whether to record images and point clouds as well.
        """
        bag = self.folder / "bag"
        left_out = [] if pictures else ["--exclude-topic-types", *PICTURES]
        command = ["ros2", "bag", "record", "--all-topics", "--log-level", "warn", "--output", str(bag), *left_out]
        self._recorder = self.start_program(command, on_output=_error_filter())
        return bag

    def end(self) -> None:
        """Close the bag and keep what the world looks like; the programs of the run stop where they are."""
        if self._ended:
            return
        self._ended = True
        for callback in self.on_end:
            callback()
        recorder = self._recorder
        if recorder is not None:
            keep_world(self.folder)
        if recorder is not None and recorder.status is None:
            ended = threading.Event()
            recorder.on_exit.append(lambda status: ended.set())
            recorder.send_signal(signal.SIGINT)
            ended.wait(_END_S)


def _error_filter() -> Callable[[int, bytes], None]:
    """Return a function that passes on what a recorder complains of."""
    errors = sys.stderr  # that of the test; the recorder has one of its own

    def show(fd: int, data: bytes) -> None:
        for line in data.decode(errors="replace").splitlines():
            if line.startswith(("[ERROR]", "[FATAL]", "error")):
                errors.write(f"{line}\n")

    return show
