"""`daidalos rapid write` and `daidalos rapid draw`: letters as a program, and what the pen of a program has drawn."""

from __future__ import annotations

import argparse
import math
import sys
from typing import TYPE_CHECKING, Any

from daidalos.cli.daidalos.rapid_loading import load_task
from daidalos.cli.daidalos.rapid_run import check_output, run_task, write_output
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.motion.orientations import Array
    from daidalos.industry.rapid.lettering.strokes import Stroke
    from daidalos.industry.rapid.runtime.task import Task

SAMPLING_S = 0.002
_MIDDLE_MM, _HEIGHT_MM = 400.0, 150.0


def write_letters(args: argparse.Namespace) -> int:
    """Write the program that draws a text.

    Raises
    ------
    UserError
        Where an argument or the font does not do, or the output exists.
    """
    from daidalos.industry.rapid.lettering.program import write_program
    from daidalos.industry.rapid.lettering.strokes import strokes_of_text

    check_output(args)
    for name, least in (("pen", 0.0), ("speed", 1.0)):
        value = getattr(args, name)
        if not (math.isfinite(value) and least <= value <= 5000.0):
            raise UserError(f"--{name} takes {least:g} to 5000, not {value:g}")
    strokes = strokes_of_text(args.text, args.height, args.font)
    if not strokes:
        raise UserError(f"'{args.text}' has no lines to draw")
    width = max(x for one in strokes for x, _ in one.points)
    sheet = tuple(args.at or (round(_MIDDLE_MM - args.height / 2, 1), round(width / 2, 1), _HEIGHT_MM))
    if not all(map(math.isfinite, sheet)):
        raise UserError("--at takes finite millimetres")
    module = "".join(one if one.isascii() and one.isalnum() else "_" for one in args.output.stem)[:20]
    name = f"w_{module}" if not module[:1].isalpha() else module
    write_output(args, write_program(strokes, name, sheet, args.pen, args.speed))
    return 0


def draw_program(args: argparse.Namespace) -> int:
    """Run a program on an arm, write what its pen has drawn, and print how far that is from letters.

    Raises
    ------
    UserError
        Where the output exists, there is no such work object, or nothing is drawn.
    """
    from daidalos.industry.rapid.lettering.drawing import compare, picture
    from daidalos.industry.rapid.lettering.strokes import strokes_of_text

    check_output(args)
    wanted = strokes_of_text(args.text, args.height, args.font) if args.text else None
    found = _draw_in_simulator(args) if args.sim else _draw(args)
    if found is None:
        return 2
    status, drawn = found
    if not drawn:
        raise UserError(
            f"{args.path}: the pen has drawn nothing on the sheet; --sheet NAME says which work object it is"
        )
    write_output(args, picture(drawn))
    if wanted is not None:
        both = compare(drawn, wanted)
        print(f"overlap {100.0 * both.overlap:.1f} %, worst deviation {both.deviation:.3f} mm", file=sys.stderr)
    return status


def _draw(args: argparse.Namespace) -> tuple[int, list[Stroke]] | None:
    """Run a program on the model of an arm; return the exit status and what its pen draws, None without a program."""
    import numpy as np

    from daidalos.industry.rapid.lettering.drawing import drawn_strokes
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    task = load_task(args, None, SAMPLING_S)
    if task is None:
        return None
    frame = _sheet_frame(task, args.sheet)
    status = run_task(task, args)
    assert isinstance(task.robot, ArmRobot)
    positions = [1e3 * one.positions for one in task.robot.samples]
    return status, drawn_strokes(np.concatenate(positions), frame) if positions else []


def _draw_in_simulator(args: argparse.Namespace) -> tuple[int, list[Stroke]] | None:
    """Run a program on the simulated arm, with a sheet on which its pen draws; return as `_draw` does."""
    from daidalos.cli.daidalos.rapid_action import ACTION, PERIOD_S, Follower
    from daidalos.cli.daidalos.rapid_sheet import SimulatedSheet
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

    with Follower(ACTION, use_sim_time=True) as follower:
        task = load_task(args, follower, PERIOD_S)
        if task is None:
            return None
        assert isinstance(task.robot, ArmRobot)
        present = follower.positions()
        sheet = SimulatedSheet(follower.node, task.robot, _sheet_frame(task, args.sheet))
        follower.start(task.robot, present)
        follower.listeners.append(sheet.record)
        status = run_task(task, args)
        follower.finish()
        return status, sheet.strokes()


def _sheet_frame(task: Task, name: str | None) -> Array:
    """Return the pose of the sheet in the base (4, 4) [mm]."""
    from daidalos.industry.rapid.runtime.arm_robot import matrix_of
    from daidalos.industry.rapid.runtime.robot import wobj_pose

    frame = matrix_of(wobj_pose(_sheet(task, name)))
    frame[:3, 3] *= 1e3
    return frame


def _sheet(task: Task, name: str | None) -> list[Any]:
    """Return a work object of the program."""
    from daidalos.common.suggestions import hint
    from daidalos.industry.rapid.runtime.positions import WOBJ0

    found = {one.symbol.name: value for one, node, value in task.persistents() if node.type.key == "wobjdata"}
    if name is None:
        return next(iter(found.values()), WOBJ0)
    for known, value in found.items():
        if known.lower() == name.lower():
            return list(value)
    raise UserError(f"the program has no work object '{name}'{hint(name, found)}")
