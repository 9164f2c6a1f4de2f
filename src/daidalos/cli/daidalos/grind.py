"""`daidalos grind`: grinding with an arm, a pneumatic actuator and an angle grinder, in a simulated cell."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.daidalos.grind_arguments import (
    add_cell,
    add_job,
    cell_parameters,
    controller_maker,
    faults,
    workpiece,
)
from daidalos.cli.daidalos.weld_arguments import finite
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.grinding.tasks import Job, JobRun, Pass

CONTROLLERS = ("pi", "integral", "impedance", "admittance", "position")


class GrindVerb:
    """Control the force of a grinder, finish plates and remove excess material."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos grind`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
        force = commands.add_parser("force", help="compare force controllers on a path with errors")
        force.add_argument(
            "--controller", action="append", metavar="NAME", help="force controller; more than one (default: all)"
        )
        add_cell(force, 1.0)
        force.set_defaults(_command=_force)
        plate = commands.add_parser("plate", help="remove an even layer from a plate")
        plate.add_argument("--depth", type=finite, default=50.0, metavar="UM", help="of the layer (default: 50)")
        plate.add_argument(
            "--spacing", type=finite, default=12.0, metavar="MM", help="distance of the lines (default: 12)"
        )
        add_job(plate)
        plate.set_defaults(_command=_plate)
        clamp = commands.add_parser("clamp", help="remove excess material down to the target, pass by pass")
        clamp.add_argument(
            "--tolerance", type=finite, default=100.0, metavar="UM", help="about the target (default: 100)"
        )
        clamp.add_argument(
            "--excess", type=finite, default=1.0, metavar="MM", help="mean height of the bead (default: 1)"
        )
        clamp.add_argument("--max-passes", type=int, default=15, metavar="N", help="at most (default: 15)")
        add_job(clamp)
        clamp.set_defaults(_command=_clamp)
        live = commands.add_parser("live", help="grind in real time, in the studio")
        live.add_argument("task", choices=("clamp", "plate"), nargs="?", default="clamp", help="(default: clamp)")
        live.add_argument("--controller", default="pi", metavar="NAME", help="force controller (default: pi)")
        live.add_argument("--speed", type=finite, default=1.0, help="of the process (default: 1, real time)")
        live.add_argument("--seed", type=int, default=0, help="of noise and errors (default: 0)")
        live.add_argument("--port", type=int, default=8765, metavar="N", help="of the studio (default: 8765)")
        live.add_argument("--no-browser", action="store_true", help="print the studio's address, open nothing")
        live.set_defaults(_command=_live)
        compare = commands.add_parser("compare", help="compare the figures of two results")
        compare.add_argument("first", type=Path, metavar="FOLDER", help="written by -o")
        compare.add_argument("second", type=Path, metavar="FOLDER", help="written by -o")
        compare.add_argument("--json", action="store_true", help="print the figures as JSON")
        compare.set_defaults(_command=_compare)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        status: int = args._command(args)
        return status


def _force(args: argparse.Namespace) -> int:
    from daidalos.industry.grinding.records import force_figures
    from daidalos.industry.grinding.results import force_json, write_force_test
    from daidalos.industry.grinding.tasks import force_test

    parameters, broken = cell_parameters(args), faults(args)
    names = args.controller or list(CONTROLLERS)
    if args.settings and len(names) != 1:
        raise UserError("--set needs one --controller, whose parameter it is")
    makers = {name: controller_maker(name, args, parameters) for name in names}
    records, figures, problems = {}, {}, {}
    for name, make in makers.items():
        # Without force control the force leaves every limit, which is what the comparison is to show.
        records[name], run = force_test(
            parameters, make(), args.seed, broken, name != "position", 1e-3 * args.resolution
        )
        figures[name], problems[name] = force_figures(records[name]), run.problem
    files = write_force_test(records, figures, problems, args.output) if args.output is not None else []
    content = force_json(figures, problems)
    if args.json:
        print(json.dumps(content | {"files": [str(file) for file in files]}, indent=1))
    else:
        print(f"{'':12}{'steady error':>14}{'moving rms':>12}{'overshoot':>11}{'greatest':>10}{'vibration':>11}")
        print(f"{'goal':12}{'1 N':>14}{'3 N':>12}{'10 %':>11}")
        for name, one in content["controllers"].items():
            print(
                f"{name:12}{_value(one['steady_error_n'], 'N'):>14}{_value(one['moving_rms_n'], 'N'):>12}"
                f"{_value(one['overshoot_percent'], '%'):>11}{_value(one['greatest_n'], 'N'):>10}"
                f"{_value(one['vibration_rms_n'], 'N'):>11}"
            )
        _say_written(args.output, files)
    return _report_problems({name: problem for name, problem in problems.items() if problem}, args)


def _plate(args: argparse.Namespace) -> int:
    from daidalos.industry.grinding.passes import even_passes
    from daidalos.industry.grinding.tasks import plate_job
    from daidalos.industry.grinding.workpieces import plate

    parameters = cell_parameters(args)
    if not 1.0 <= args.depth <= 1000.0:
        raise UserError(f"--depth is {args.depth:g}, but must be 1 to 1000 um")
    if not 1.0 <= args.spacing <= 1e3 * parameters.disc.radius:
        raise UserError(f"--spacing is {args.spacing:g}, but must be 1 to {1e3 * parameters.disc.radius:g} mm")
    depth, spacing = 1e-6 * args.depth, 1e-3 * args.spacing
    piece = workpiece(args, lambda resolution: plate(depth=depth, seed=args.seed, resolution=resolution))
    make = controller_maker(args.controller, args, parameters)
    even_passes(piece, parameters, depth, args.force, spacing, parameters.disc.preston)
    job = plate_job(piece, parameters, make, args.force, depth, spacing, args.seed, faults(args))
    return _run(job, args)


def _clamp(args: argparse.Namespace) -> int:
    from daidalos.industry.grinding.tasks import clamp_job
    from daidalos.industry.grinding.workpieces import clamp

    parameters = cell_parameters(args)
    if not 20.0 <= args.tolerance <= 2000.0:
        raise UserError(f"--tolerance is {args.tolerance:g}, but must be 20 to 2000 um")
    if not 0.1 <= args.excess <= 10.0:
        raise UserError(f"--excess is {args.excess:g}, but must be 0.1 to 10 mm")
    if not 1 <= args.max_passes <= 100:
        raise UserError(f"--max-passes is {args.max_passes}, but must be 1 to 100")
    piece = workpiece(args, lambda resolution: clamp(1e-3 * args.excess, args.seed, resolution))
    make = controller_maker(args.controller, args, parameters)
    tolerance = 1e-6 * args.tolerance
    job = clamp_job(piece, parameters, make, args.force, tolerance, args.seed, faults(args), args.max_passes)
    return _run(job, args)


def _run(job: JobRun, args: argparse.Namespace) -> int:
    """Do a job, print and write its figures; return the exit status."""
    from daidalos.industry.grinding.results import write_job
    from daidalos.industry.grinding.tasks import job_figures

    if args.output is not None and args.output.exists() and any(args.output.iterdir()):
        raise UserError(f"{args.output}: is not empty; choose another folder")
    if not args.json:
        print(f"{'pass':>4}{'lines':>7}{'time':>10}{'removed':>12}{'planned':>12}{'mean':>10}{'within':>9}")
    done = job.run(args.robot, on_pass=None if args.json else lambda one: _show_pass(len(job.passes), one))
    files = write_job(done, args.output) if args.output is not None else []
    figures: dict[str, Any] = job_figures(done)
    if args.json:
        print(json.dumps(figures | {"files": [str(file) for file in files]}, indent=1))
    else:
        _show_job(done, figures)
        _say_written(args.output, files)
    return _report_problems({done.title: done.problem} if done.problem else {}, args)


def _show_pass(number: int, one: Pass) -> None:
    time = float(one.record.time[-1]) if len(one.record.time) else 0.0
    print(
        f"{number:4}{len(one.lines):7}{time:8.1f} s{1e9 * one.removed:8.1f} mm3{1e9 * one.predicted:8.1f} mm3"
        f"{1e6 * one.after.mean:7.1f} um{100.0 * one.after.within:7.2f} %",
        flush=True,
    )


def _show_job(job: Job, figures: dict[str, Any]) -> None:
    for state in ("before", "after"):
        one = figures[state]
        print(
            f"{state}: mean {one['mean_um']:.1f} um, std {one['std_um']:.1f} um, 99 % from {one['low_um']:.1f} to "
            f"{one['high_um']:.1f} um, {one['within_percent']:.2f} % within {figures['tolerance_um']:g} um"
        )
    print(f"disc worn by {figures['wear_percent']:.2f} %")


def _live(args: argparse.Namespace) -> int:
    """Launch cell and studio in the foreground."""
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from daidalos.cli.daidalos.launching import run_launch
    from daidalos.cli.ros2.launch import find_launch_file
    from daidalos.common.extensions import locate
    from daidalos.industry.grinding.extensions import FORCE_CONTROLLERS

    locate(FORCE_CONTROLLERS, args.controller)
    if not 0.0 < args.speed <= 20.0:
        raise UserError(f"--speed is {args.speed:g}, but must be above 0, at most 20")
    if args.seed < 0:
        raise UserError(f"--seed is {args.seed}, but must not be negative")
    settings = {
        "task": args.task,
        "controller": args.controller,
        "speed": str(args.speed),
        "seed": str(args.seed),
        "port": str(args.port),
        "open_browser": str(not args.no_browser).lower(),
    }
    source = AnyLaunchDescriptionSource(str(find_launch_file("daidalos_grinding", "demo.launch.py")))
    return run_launch(IncludeLaunchDescription(source, launch_arguments=list(settings.items())))


def _compare(args: argparse.Namespace) -> int:
    from daidalos.industry.grinding.results import compared

    rows = compared(args.first, args.second)
    if args.json:
        print(json.dumps([{"figure": name, "first": one, "second": two} for name, one, two in rows], indent=1))
        return 0
    for name, one, two in rows:
        print(f"{name:48}{_plain(one):>16}{_plain(two):>16}")
    return 0


def _value(value: float | None, unit: str) -> str:
    return "-" if value is None else f"{value:.2f} {unit}"


def _plain(value: Any) -> str:
    return "-" if value is None or value == "" else f"{value:g}" if isinstance(value, int | float) else str(value)


def _say_written(folder: Path | None, files: list[Path]) -> None:
    if folder is not None:
        print(f"written to {folder}: {', '.join(file.name for file in files)}")


def _report_problems(problems: dict[str, str], args: argparse.Namespace) -> int:
    """Print what went wrong to the error output; return the exit status."""
    for name, problem in problems.items():
        print(f"{args._name}: {name}: {problem}", file=sys.stderr)
    return 1 if problems else 0
