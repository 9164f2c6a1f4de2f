"""Programs, signals and robots of `daidalos rapid run`, `trace`, `draw` and `debug`, from their arguments."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.announced_arm import Announcement
    from daidalos.industry.rapid.runtime.board import Board
    from daidalos.industry.rapid.runtime.robot import Robot
    from daidalos.industry.rapid.runtime.task import Task


def load_task(
    args: argparse.Namespace,
    pace: Callable[[float], None] | None,
    sampling: float,
    announcement: Announcement | None = None,
) -> Task | None:
    """Return the task that the arguments describe; None, with the reasons printed, where it cannot run.

    Raises
    ------
    UserError
        Where several tasks are named.
    """
    if len(args.task) > 1:
        raise UserError("this runs one task; name one with --task")
    tasks = load_tasks(args, pace, sampling, announcement)
    return next(iter(tasks.values())) if tasks else None


def load_tasks(
    args: argparse.Namespace,
    pace: Callable[[float], None] | None,
    sampling: float,
    announcement: Announcement | None = None,
    is_debugged: bool = False,
) -> dict[str, Task] | None:
    """Return the tasks that the arguments describe; None, with the reasons printed, where one cannot run."""
    from daidalos.industry.rapid.inspection import read_signals
    from daidalos.industry.rapid.runtime.board import Board
    from daidalos.industry.rapid.runtime.errors import FatalError
    from daidalos.industry.rapid.runtime.loading import choose_programs, load_modules
    from daidalos.industry.rapid.runtime.movements import set_manual
    from daidalos.industry.rapid.runtime.task import Task

    signals = [name for file in args.io for name in read_signals(file)]
    programs = choose_programs(args.path, args.task)
    board = Board(signals, dict(_parse_signal(text) for text in args.signal))
    home = args.home or (args.path if args.path.is_dir() else args.path.parent)
    tasks: dict[str, Task] = {}
    for name, program in programs.items():
        modules, checker, blocking = load_modules(program, signals)
        for report in blocking:
            for problem in report.errors:
                print(problem.text(report.file), file=sys.stderr)
        if blocking:
            return None
        robot = make_robot(arm_of(args.robot, name), args.sensor, board, sampling, announcement, args.external)
        try:
            task = Task(modules, checker, robot, board, None, pace, datetime.now(), home, args.max_time, is_debugged)
        except FatalError as error:
            print(f"error: {error}", file=sys.stderr)
            return None
        task.name = name
        if args.manual:
            set_manual(task)
        tasks[name] = task
    return tasks


def arm_of(arms: str | Sequence[str] | None, task: str) -> str | None:
    """Return the arm of a task: each of the texts is an arm of all tasks, or TASK=ARM."""
    given = [arms] if isinstance(arms, str) else list(arms or ())
    pairs = [one.rpartition("=")[::2] for one in given]
    own = [arm for name, arm in pairs if name.upper() == task.upper()]
    common = [arm for name, arm in pairs if not name]
    return next(iter([*own, *common]), None)


def make_robot(
    name: str | None,
    sensors: list[str],
    board: Board,
    sampling: float = 0.0,
    announcement: Announcement | None = None,
    external: Sequence[str] = (),
) -> Robot | None:
    """Return the arm of a name, or None without one; it shows its targets where it is said how.

    Raises
    ------
    UserError
        Where no arm has this name, or a sensor or an external axis is not one.
    """
    from daidalos.industry.rapid.runtime.announced_arm import AnnouncedArm
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
    from daidalos.industry.rapid.runtime.external_axes import parse_axis
    from daidalos.industry.rapid.runtime.sensors import parse_sensor
    from daidalos.industry.robots import arm_named

    if name is None:
        if sensors or external:
            option = "--sensor" if sensors else "--external"
            raise UserError(f"{option} needs an arm: add --robot, such as --robot irb120")
        return None
    try:
        arm = arm_named(name)
        conditions = dict(parse_sensor(text) for text in sensors)
        axes = dict(parse_axis(text) for text in external)
    except ValueError as error:
        raise UserError(str(error)) from None
    settings: dict[str, Any] = {"sensors": conditions, "set_signal": board.set, "sampling": sampling, "external": axes}
    return ArmRobot(arm, **settings) if announcement is None else AnnouncedArm(arm, announcement, **settings)


def _parse_signal(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, float(value)
    except ValueError:
        raise UserError(f"'{text}' is no signal; write --signal NAME=VALUE") from None
