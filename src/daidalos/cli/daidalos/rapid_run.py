"""`daidalos rapid run`: a program on this terminal, at the pace of real time or as fast as it can."""

from __future__ import annotations

import argparse
import sys
import threading
import time
from collections.abc import Callable
from datetime import datetime
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.launching import INTERRUPTED
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.board import Board
    from daidalos.industry.rapid.runtime.robot import Robot
    from daidalos.industry.rapid.runtime.task import Outcome, Task

ENDLESS_S = 2.0
"""Seconds without motion, waiting or output after which a loop is named."""


TRACE_PERIOD_S = 0.004
"""Seconds between two samples of a report."""


def run_program(args: argparse.Namespace) -> int:
    """Load and run a program; return 0 at its end, 2 after an error, 130 after Ctrl-C."""
    if args.sim or args.action:
        return _run_on_action(args)
    task = load_task(args, None if args.fast else Pace(), 0.0)
    if task is None:
        return 2
    status = run_task(task, args)
    if args.save:
        _save(task)
    return status


def _run_on_action(args: argparse.Namespace) -> int:
    """Run a program whose arm is moved by a controller of joint trajectories.

    Raises
    ------
    UserError
        Where no arm is named, there is no controller, or it stops.
    """
    from daidalos.cli.daidalos.rapid_action import ACTION, PERIOD_S, Follower
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    if args.robot is None or args.fast:
        raise UserError("--sim and --action need an arm, such as --robot irb120, and run at its pace, without --fast")
    with Follower(args.action or ACTION, use_sim_time=args.sim) as follower:
        task = load_task(args, follower, PERIOD_S)
        if task is None:
            return 2
        assert isinstance(task.robot, ArmRobot)
        follower.start(task.robot, follower.positions())
        status = run_task(task, args)
        follower.finish()
    if args.save:
        _save(task)
    return status


def trace_program(args: argparse.Namespace) -> int:
    """Run a program on an arm, and write what it did as a report, after an error too.

    Raises
    ------
    UserError
        Where there is a file already, or nothing to report.
    """
    from daidalos.industry.rapid.report import Trace, render
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    check_output(args)
    task = load_task(args, None, TRACE_PERIOD_S)
    if task is None:
        return 2
    status = run_task(task, args)
    robot = task.robot
    assert isinstance(robot, ArmRobot)
    try:
        trace = Trace.of(robot)
    except ValueError as error:
        raise UserError(f"{args.path}: {error}") from None
    write_output(args, render(trace, args.path.name))
    return status


def check_output(args: argparse.Namespace) -> None:
    """Raise a UserError where the output exists, and may not be replaced."""
    if args.output.exists() and not args.force:
        raise UserError(f"{args.output} exists; choose another name or add --force")


def write_output(args: argparse.Namespace, text: str) -> None:
    """Write the output.

    Raises
    ------
    UserError
        Where it cannot be written.
    """
    try:
        args.output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UserError(f"{args.output}: cannot be written: {error.strerror}") from None
    print(f"wrote {args.output}", file=sys.stderr)


def load_task(args: argparse.Namespace, pace: Callable[[float], None] | None, sampling: float) -> Task | None:
    """Return the task that the arguments describe; None, with the reasons printed, where it cannot run."""
    from daidalos.industry.rapid.inspection import read_signals
    from daidalos.industry.rapid.runtime.board import Board
    from daidalos.industry.rapid.runtime.errors import FatalError
    from daidalos.industry.rapid.runtime.loading import choose_program, load_modules
    from daidalos.industry.rapid.runtime.task import Task

    signals = [name for file in args.io for name in read_signals(file)]
    program = choose_program(args.path, args.task)
    modules, checker, blocking = load_modules(program, signals)
    for report in blocking:
        for problem in report.errors:
            print(problem.text(report.file), file=sys.stderr)
    if blocking:
        return None
    board = Board(signals, dict(_parse_signal(text) for text in args.signal))
    robot = make_robot(args.robot, args.sensor, board, sampling)
    try:
        home = args.home or (args.path if args.path.is_dir() else args.path.parent)
        task = Task(modules, checker, robot, board, None, pace, datetime.now(), home, args.max_time)
    except FatalError as error:
        print(f"error: {error}", file=sys.stderr)
        return None
    if args.task:
        task.settings["name"] = args.task
    return task


def run_task(task: Task, args: argparse.Namespace) -> int:
    """Run a task, and print how it ended; return the exit status."""
    watch = Watch(task)
    outcome = task.run(args.proc)
    watch.end()
    return _report(task, outcome, args.proc)


def make_robot(name: str | None, sensors: list[str], board: Board, sampling: float = 0.0) -> Robot | None:
    """Return the arm of a name, or None without one.

    Raises
    ------
    UserError
        Where no arm has this name, or a sensor is not one.
    """
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
    from daidalos.industry.rapid.runtime.sensors import parse_sensor
    from daidalos.industry.robots import arm_named

    if name is None:
        if sensors:
            raise UserError("--sensor needs an arm: add --robot, such as --robot irb120")
        return None
    try:
        arm = arm_named(name)
        conditions = dict(parse_sensor(text) for text in sensors)
    except ValueError as error:
        raise UserError(str(error)) from None
    return ArmRobot(arm, sensors=conditions, set_signal=board.set, sampling=sampling)


def _warn(task: Task) -> None:
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    if isinstance(task.robot, ArmRobot):
        for warning in task.robot.planner.warnings:
            print(f"warning: {warning}", file=sys.stderr)


def _parse_signal(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, float(value)
    except ValueError:
        raise UserError(f"'{text}' is no signal; write --signal NAME=VALUE") from None


def _report(task: Task, outcome: Outcome, procedure: str) -> int:
    _warn(task)
    if outcome.reason == "error":
        print(f"error: {outcome.message}", file=sys.stderr)
        for place in outcome.calls[1:]:
            print(f"  called in {place}", file=sys.stderr)
        return 2
    if outcome.reason == "interrupted":
        print(f"\n{outcome.message}", file=sys.stderr)
        return INTERRUPTED
    how = "ended" if outcome.reason == "end" else f"ended by {outcome.reason}"
    where = f" in {outcome.message}" if outcome.message else ""
    moves = task.robot.count
    count = f"{moves} movement{'' if moves == 1 else 's'}"
    print(f"{procedure} {how}{where} after {outcome.time:.3f} s, {count}", file=sys.stderr)
    return 0


def _save(task: Task) -> None:
    from daidalos.industry.rapid.runtime.persistence import save_persistents

    for path in save_persistents(task):
        print(f"saved {path}", file=sys.stderr)


class Pace:
    """Pace of real time: a call returns when as much of it has passed as the robot's time has."""

    def __init__(self) -> None:
        self._due = time.monotonic()

    def __call__(self, seconds: float) -> None:
        """Wait until real time has caught up."""
        self._due += seconds
        now = time.monotonic()
        if now < self._due:
            time.sleep(self._due - now)
        else:
            self._due = now


class Watch:
    """Thread that names a loop in which neither time passes nor anything is shown."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._main = threading.get_ident()
        self._ended = threading.Event()
        self._named: set[str] = set()
        threading.Thread(target=self._watch, daemon=True).start()

    def end(self) -> None:
        """End the thread."""
        self._ended.set()

    def _watch(self) -> None:
        before = -1
        while not self._ended.wait(ENDLESS_S):
            if self._task.progress == before:
                self._name_loop()
            before = self._task.progress

    def _name_loop(self) -> None:
        place = self._task.place_of_frame(sys._current_frames().get(self._main))
        if place and place not in self._named and not self._task.is_waiting:
            self._named.add(place)
            text = f"runs for {ENDLESS_S:g} s without motion, waiting or output; Ctrl-C stops it"
            print(f"{place}: warning: the program {text}", file=sys.stderr, flush=True)
