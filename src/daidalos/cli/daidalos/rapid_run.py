"""`daidalos rapid run`: a program on this terminal, at the pace of real time or as fast as it can."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.launching import INTERRUPTED
from daidalos.cli.daidalos.rapid_loading import load_task, load_tasks
from daidalos.cli.daidalos.rapid_target import announcement
from daidalos.common.errors import UserError
from daidalos.industry.rapid.runtime.pacing import Pace

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.announced_arm import Announcement
    from daidalos.industry.rapid.runtime.task import Outcome, Task

ENDLESS_S = 2.0
"""Seconds without motion, waiting or output after which a loop is named."""


TRACE_PERIOD_S = 0.004
"""Seconds between two samples of a report."""


def run_program(args: argparse.Namespace) -> int:
    """Load and run a program; return 0 at its end, 2 after an error, 130 after Ctrl-C."""
    with announcement(args) as announced:
        if args.sim or args.action:
            return _run_on_action(args, announced)
        pace = None if args.fast else Pace()
        tasks = load_tasks(args, pace, 0.0, announced)
        if tasks is None:
            return 2
        status = run_tasks(tasks, args, pace)
    if args.save:
        for task in tasks.values():
            _save(task)
    return status


def _run_on_action(args: argparse.Namespace, announced: Announcement | None) -> int:
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
        task = load_task(args, follower, PERIOD_S, announced)
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


def run_tasks(tasks: dict[str, Task], args: argparse.Namespace, pace: Callable[[float], None] | None) -> int:
    """Run tasks at the same time, and print how each ended; return the greatest exit status."""
    from daidalos.industry.rapid.runtime.cell import STOPPED, Cell
    from daidalos.industry.rapid.runtime.errors import FatalError

    if len(tasks) == 1:
        return run_task(next(iter(tasks.values())), args)
    try:
        cell = Cell(tasks, pace)
    except FatalError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    watch = Watch(list(tasks.values()), cell.running)
    outcomes = cell.run(args.proc)
    watch.end()
    causes = [one for one in outcomes.values() if one.reason in ("error", "interrupted")]
    statuses = [
        _report(tasks[name], outcome, f"{name} {args.proc}")
        for name, outcome in outcomes.items()
        if not causes or outcome.reason != STOPPED
    ]
    return max(statuses)


def run_task(task: Task, args: argparse.Namespace) -> int:
    """Run a task, and print how it ended; return the exit status."""
    main = threading.get_ident()
    watch = Watch([task], lambda: (task, main))
    outcome = task.run(args.proc)
    watch.end()
    return _report(task, outcome, args.proc)


def _warn(task: Task) -> None:
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    if isinstance(task.robot, ArmRobot):
        for warning in task.robot.planner.warnings:
            print(f"warning: {warning}", file=sys.stderr)


def _report(task: Task, outcome: Outcome, procedure: str) -> int:
    _warn(task)
    if outcome.reason == "error":
        where = f"{task.name}: " if task.cell is not None else ""
        print(f"error: {where}{outcome.message}", file=sys.stderr)
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


class Watch:
    """Thread that names a loop in which neither time passes nor anything is shown.

    Parameters
    ----------
    tasks
        The tasks that run.
    running
        Returns the task that is being carried out just now, and the identifier of its thread; None while none is.
    """

    def __init__(self, tasks: Sequence[Task], running: Callable[[], tuple[Task, int] | None]) -> None:
        self._tasks = tasks
        self._running = running
        self._ended = threading.Event()
        self._named: set[str] = set()
        threading.Thread(target=self._watch, daemon=True).start()

    def end(self) -> None:
        """End the thread."""
        self._ended.set()

    def _watch(self) -> None:
        before = -1
        while not self._ended.wait(ENDLESS_S):
            progress = sum(one.progress for one in self._tasks)
            running = self._running()
            if progress == before and running is not None:
                self._name_loop(*running)
            before = progress

    def _name_loop(self, task: Task, thread: int) -> None:
        place = task.place_of_frame(sys._current_frames().get(thread))
        if place and place not in self._named and not task.is_waiting:
            self._named.add(place)
            text = f"runs for {ENDLESS_S:g} s without motion, waiting or output; Ctrl-C stops it"
            print(f"{place}: warning: the program {text}", file=sys.stderr, flush=True)
