"""`daidalos light calibrate`: guided calibration of a moving head at the terminal."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.common.pose3 import Vector
    from daidalos.industry.lighting.configuration import Configuration
    from daidalos.industry.lighting.engine import Engine
    from daidalos.industry.lighting.guided_calibration import GuidedCalibration
    from daidalos.nodes.keyboard import Keyboard

_HELP = "arrow keys turn, + and - change the step, Enter confirms, u takes the last one back, q ends (resumable)"
_HELP_AT_THE_END = "Enter writes the result, p proposes one more point, u takes the last one back, q ends (resumable)"


def calibrate(args: argparse.Namespace, chosen: Configuration, report: Callable[[str], None]) -> int:
    """Guide through a calibration; return 0 when the result is written, 1 when it was left."""
    from daidalos.industry.lighting.calibration import CalibrationError
    from daidalos.industry.lighting.calibration_file import read_points, read_session
    from daidalos.industry.lighting.engine import Engine
    from daidalos.industry.lighting.guided_calibration import GuidedCalibration, corners, session_file, table_targets
    from daidalos.industry.lighting.show import Show
    from daidalos.nodes.keyboard import Keyboard

    show = Show(chosen.make_heads())
    name = args.head or chosen.heads[0].name
    head = show.head(name)
    try:
        points = read_points(args.points) if args.points else corners(args.table)
    except CalibrationError as error:
        raise UserError(str(error)) from None
    session = session_file(args.output)
    confirmed = read_session(session, name) if session.exists() else []
    guided = GuidedCalibration(points, head.geometry, head.limits, confirmed)
    if confirmed:
        print(f"resumed from {session}: {len(confirmed)} directions are confirmed")
    with Keyboard() as keyboard, Engine(show, chosen.make_outputs(), report) as engine:
        return _guide(guided, keyboard, engine, name, args.output, table_targets(points))


def _guide(
    guided: GuidedCalibration, keyboard: Keyboard, engine: Engine, name: str, output: Path, targets: Sequence[Vector]
) -> int:
    from daidalos.industry.lighting.calibration_file import write_session
    from daidalos.industry.lighting.guided_calibration import session_file

    print(_HELP)
    is_told = None
    while True:
        engine.command(name, lambda head: head.turn(guided.angles))
        state = (guided.progress, guided.task)
        if state != is_told:
            is_told = state
            _tell(guided, targets)
        _show_angles(guided)
        key = keyboard.read()
        if key in (None, "q"):
            print(f"\nleft; the same command resumes it from {session_file(output)}")
            return 1
        if key in ("\r", "\n") and guided.task is None:
            if guided.result is not None:
                _write(guided, name, output, targets)
                return 0
        elif key == "p" and guided.task is None and guided.result is not None:
            guided.add_proposal(targets)
        elif guided.press(key or ""):
            write_session(session_file(output), name, guided.observations)


def _tell(guided: GuidedCalibration, targets: Sequence[Vector]) -> None:
    """Print what is to be done next."""
    done, every = guided.progress
    task = guided.task
    if task is not None:
        place = ", ".join(f"{value:g}" for value in task.point)
        flip = "flipped" if task.is_flipped else "straight"
        print(f"\n{done + 1} of {every}: put the spot on [{place}], {flip}")
    elif guided.result is None:
        print(f"\nno result: {guided.problem}; take directions back with u")
    else:
        print()
        _print_result(guided, targets)
        print(_HELP_AT_THE_END)


def _show_angles(guided: GuidedCalibration) -> None:
    pan, tilt, step = (math.degrees(one) for one in (guided.angles.pan, guided.angles.tilt, guided.step))
    print(f"\r  pan {pan:9.3f}  tilt {tilt:9.3f}  step {step:g} deg   ", end="", flush=True)


def _print_result(guided: GuidedCalibration, targets: Sequence[Vector]) -> None:
    """Print pose, angles, and the expected error over the table."""
    from daidalos.industry.lighting.calibration import expected_errors
    from daidalos.industry.lighting.guided_calibration import COLUMNS

    found = guided.result
    assert found is not None
    deviations = [math.sqrt(one) for one in found.covariance.diagonal()]
    position = zip(found.geometry.pose.position, deviations[:3], strict=True)
    print("position " + "  ".join(f"{value:.4f} +- {deviation:.4f}" for value, deviation in position) + " m")
    geometry = found.geometry
    angles = (("tilt zero", geometry.tilt_zero), ("axis skew", geometry.axis_skew), ("beam skew", geometry.beam_skew))
    for (word, value), deviation in zip(angles, deviations[6:], strict=True):
        print(f"{word} {math.degrees(value):.3f} +- {math.degrees(deviation):.3f} deg")
    print(f"residual {math.degrees(found.residual):.4f} deg, condition {found.condition:.0f}")
    errors = 1e3 * expected_errors(found, targets)
    _print_sines(guided, found.noise)
    print("expected pointing error over the table [mm], the greatest y at the top:")
    for start in range(len(errors) - COLUMNS, -1, -COLUMNS):
        print("".join(f"{value:7.1f}" for value in errors[start : start + COLUMNS]))


def _print_sines(guided: GuidedCalibration, noise: float) -> None:
    """Print what the workshop's method finds, where three of the points are on a line, with one in the middle."""
    from daidalos.industry.lighting.calibration import CalibrationError
    from daidalos.industry.lighting.law_of_sines import calibrate_by_sines, choose_line

    chosen = choose_line(guided.observations)
    if chosen is None:
        return
    try:
        geometry, line = calibrate_by_sines(chosen)
    except CalibrationError as error:
        print(f"law of sines: {error}")
        return
    place = "  ".join(f"{value:.4f}" for value in geometry.pose.position)
    print(
        f"law of sines: position {place} m; distance to the line's end {line.distance:.4f} +- "
        f"{line.amplification * noise:.4f} m ({line.amplification:.1f} m/rad)"
    )


def _write(guided: GuidedCalibration, name: str, output: Path, targets: Sequence[Vector]) -> None:
    from daidalos.industry.lighting.calibration import expected_errors
    from daidalos.industry.lighting.calibration_file import write_calibration
    from daidalos.industry.lighting.guided_calibration import session_file

    assert guided.result is not None
    worst = float(expected_errors(guided.result, targets).max())
    write_calibration(output, name, guided.result, guided.observations, worst)
    session_file(output).unlink(missing_ok=True)
    print(f"\nwritten to {output}; put `calibration: {output.name}` into the head's configuration")
