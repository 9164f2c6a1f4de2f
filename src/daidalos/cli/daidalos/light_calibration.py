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
_COLUMNS = 9
_ROWS = 7


def calibrate(args: argparse.Namespace, chosen: Configuration, report: Callable[[str], None]) -> int:
    """Guide through a calibration; return 0 when the result is written, 1 when it was left."""
    from daidalos.industry.lighting.calibration_file import read_points, read_session
    from daidalos.industry.lighting.engine import Engine
    from daidalos.industry.lighting.guided_calibration import GuidedCalibration
    from daidalos.industry.lighting.show import Show
    from daidalos.nodes.keyboard import Keyboard

    show = Show(chosen.make_heads())
    name = args.head or chosen.heads[0].name
    head = show.head(name)
    points = read_points(args.points) if args.points else _corners(args.table)
    session = _session_file(args.output)
    confirmed = read_session(session, name) if session.exists() else []
    guided = GuidedCalibration(points, head.geometry, head.limits, confirmed)
    if confirmed:
        print(f"resumed from {session}: {len(confirmed)} directions are confirmed")
    with Keyboard() as keyboard, Engine(show, chosen.make_outputs(), report) as engine:
        return _guide(guided, keyboard, engine, name, args.output, _targets(points))


def _guide(
    guided: GuidedCalibration, keyboard: Keyboard, engine: Engine, name: str, output: Path, targets: Sequence[Vector]
) -> int:
    from daidalos.industry.lighting.calibration_file import write_session

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
            print(f"\nleft; the same command resumes it from {_session_file(output)}")
            return 1
        if key in ("\r", "\n") and guided.task is None:
            if guided.result is not None:
                _write(guided, name, output, targets)
                return 0
        elif key == "p" and guided.task is None and guided.result is not None:
            guided.add_proposal(targets)
        elif guided.press(key or ""):
            write_session(_session_file(output), name, guided.observations)


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
    print("expected pointing error over the table [mm], the greatest y at the top:")
    columns = _COLUMNS if len(targets) == _COLUMNS * _ROWS else len(targets)
    for start in range(len(errors) - columns, -1, -columns):
        print("".join(f"{value:7.1f}" for value in errors[start : start + columns]))


def _write(guided: GuidedCalibration, name: str, output: Path, targets: Sequence[Vector]) -> None:
    from daidalos.industry.lighting.calibration import expected_errors
    from daidalos.industry.lighting.calibration_file import write_calibration

    assert guided.result is not None
    worst = float(expected_errors(guided.result, targets).max())
    write_calibration(output, name, guided.result, guided.observations, worst)
    _session_file(output).unlink(missing_ok=True)
    print(f"\nwritten to {output}; put `calibration: {output.name}` into the head's configuration")


def _session_file(output: Path) -> Path:
    return output.with_name(f"{output.name}.session")


def _corners(table: Sequence[float]) -> list[Vector]:
    x0, y0, x1, y1, z = table
    if not all(math.isfinite(one) for one in table) or x0 == x1 or y0 == y1:
        raise UserError("--table needs two different corners and a height")
    return [(x0, y0, z), (x0, y1, z), (x1, y0, z), (x1, y1, z)]


def _targets(points: Sequence[Vector]) -> list[Vector]:
    """Return points of the rectangle that encloses the known ones, at their mean height."""
    import numpy as np

    xs, ys, zs = zip(*points, strict=True)
    height = sum(zs) / len(zs)
    return [
        (float(x), float(y), height)
        for y in np.linspace(min(ys), max(ys), _ROWS)
        for x in np.linspace(min(xs), max(xs), _COLUMNS)
    ]
