"""`daidalos weld`: friction stir welding with arms, in the millimetres and degrees of their controllers."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.weld_arguments import add_robot, cell_of, finite, pose_of
from daidalos.cli.daidalos.weld_load_tests import add_load_tests
from daidalos.cli.daidalos.weld_servo import add_servo
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.welding.planning import Plan


class WeldVerb:
    """Correct the paths of welding robots, and follow seams."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos weld`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
        plan = commands.add_parser("plan", help="correct a path, and write programs, points, figures and a report")
        plan.add_argument(
            "path", type=Path, help="seam: .csv, .stl, .obj, .ply, .step, .mod, .pgf, .src or .yaml (a ROS path)"
        )
        add_robot(plan)
        plan.add_argument(
            "--wrench", type=finite, nargs="+", metavar="W",
            help="FX FY FZ [N] MX MY MZ [Nm] that the tool exerts, x ahead, z into the workpiece",
        )  # fmt: skip
        plan.add_argument(
            "--process", metavar="fsw|CSV", help="wrench by feed and spindle speed: built-in model, or measured welds"
        )
        plan.add_argument(
            "--spindle", type=finite, default=800.0, metavar="RPM", help="speed of the spindle (default: 800)"
        )
        plan.add_argument("--speed", type=finite, default=300.0, metavar="MM/MIN", help="of the tool (default: 300)")
        plan.add_argument("--tilt", type=finite, default=2.5, metavar="DEG", help="of the tool (default: 2.5)")
        plan.add_argument(
            "--rotation", default="0", metavar="DEG|best", help="about the tool's axis; best: the stiffest (default: 0)"
        )
        plan.add_argument("--points", type=int, metavar="N", help="points of the corrected path")
        plan.add_argument(
            "--place", type=finite, nargs="+", default=[0.0] * 6, metavar="P",
            help="pose of the workpiece in the base: X Y Z [mm] A B C [deg] about z, y', x''",
        )  # fmt: skip
        plan.add_argument(
            "--pick",
            type=_point,
            action="append",
            metavar="X,Y,Z",
            help="a point of the seam on a mesh or a STEP model",
        )
        plan.add_argument("--mesh-unit", choices=("mm", "m"), default="mm", help="unit of a mesh (default: mm)")
        plan.add_argument("--places", action="store_true", help="try other places of the workpiece")
        plan.add_argument("-o", "--output", type=Path, required=True, metavar="FOLDER", help="where the files go")
        plan.add_argument("--json", action="store_true", help="print the figures as JSON")
        plan.set_defaults(_command=_plan)
        experiment = commands.add_parser("experiment", help="weld a test path in a simulated cell, and measure it")
        experiment.add_argument("test", choices=("line", "curve"), help="straight line, or curve of nine zones")
        add_robot(experiment)
        experiment.add_argument(
            "--truth", type=Path, metavar="FILE", help="elasticity of the simulated robot (default: drawn by --seed)"
        )
        experiment.add_argument(
            "--seed", type=int, default=0, help="of the robot's elasticity and the noise (default: 0)"
        )
        experiment.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="where the report goes")
        experiment.add_argument("--json", action="store_true", help="print the figures as JSON")
        experiment.set_defaults(_command=_experiment, friction=True)
        add_load_tests(commands)
        add_servo(commands)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        status: int = args._command(args)
        return status


def _point(text: str) -> tuple[float, float, float]:
    parts = [finite(part) for part in text.split(",")]
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f"'{text}' is no point; write X,Y,Z")
    return parts[0], parts[1], parts[2]


def _plan(args: argparse.Namespace) -> int:
    import numpy as np

    from daidalos.industry.welding.planning import Request, plan
    from daidalos.industry.welding.process import process_model
    from daidalos.industry.welding.reading import read_seam
    from daidalos.industry.welding.results import write_plan

    if args.wrench is not None and len(args.wrench) != 6:
        raise UserError(f"--wrench has {len(args.wrench)} values, but FX FY FZ [N] MX MY MZ [Nm] are expected")
    if args.wrench is not None and args.process is not None:
        raise UserError("--wrench and --process exclude each other")
    if not args.spindle > 0.0:
        raise UserError(f"--spindle is {args.spindle:g}, but must be greater than 0 rpm")
    if not args.speed > 0.0:
        raise UserError(f"--speed is {args.speed:g}, but must be greater than 0 mm/min")
    if args.points is not None and not 2 <= args.points <= 100_000:
        raise UserError(f"--points is {args.points}, but must be 2 to 100000")
    cell = cell_of(args)
    seam = read_seam(args.path, args.pick, 1e-3 if args.mesh_unit == "mm" else 1.0, pose_of(args.place, "--place"))
    request = Request(
        speed=args.speed / 60e3,
        wrench=None if args.wrench is None else np.array(args.wrench),
        process=None if args.process is None else process_model(args.process),
        spindle_speed=args.spindle / 60.0,
        tilt=math.radians(args.tilt),
        rotation=None if args.rotation == "best" else math.radians(_angle(args.rotation)),
        points=args.points,
        places=args.places,
    )
    planned = plan(cell, seam, request, str(args.path))
    files = write_plan(planned, args.output, args.path.stem, args.tool_mass)
    if args.json:
        print(json.dumps(planned.as_json() | {"files": [str(file) for file in files]}, indent=1))
    else:
        _show(planned)
        print(f"written to {args.output}: {', '.join(file.name for file in files)}")
    return 0


def _angle(text: str) -> float:
    try:
        return finite(text)
    except argparse.ArgumentTypeError:
        raise UserError(f"--rotation is '{text}', but must be an angle in degrees or 'best'") from None


def _show(planned: Plan) -> None:
    figures = planned.as_json()
    print(
        f"{figures['points']} points over {figures['length_mm']:.1f} mm, "
        f"{len(planned.correction.convergence)} iterations to {1e3 * planned.correction.convergence[-1][0]:.7f} mm"
    )
    if figures["process"] is not None:
        ranges = [f"{name} {one['least']:g} to {one['greatest']:g}" for name, one in figures["wrench"].items()]
        print(f"wrench by the process model {figures['process']['name']}: {', '.join(ranges)}")
    print(f"{'deviation, rms [mm]':24}{'not corrected':>14}{'corrected':>12}")
    for direction in ("ahead", "across", "along_tool"):
        before, after = (figures[state][f"{direction}_rms_mm"] for state in ("before", "after"))
        print(f"  {direction.replace('_', ' '):22}{before:14.3f}{after:12.3f}")
    spline = figures["spline"]
    print(
        f"B-splines of degree 4: {spline['position_knots']} + {spline['orientation_knots']} inner knots in "
        f"{spline['pieces']} pieces, residual {spline['residual_mm']:.4f} mm"
    )
    changes = [f"axis {axis}: {count}" for axis, count in enumerate(figures["flank_changes"], 1) if count]
    print(f"changes of flank: {', '.join(changes) or 'none'}")
    for name, unit, title in (
        ("rotations", "deg", "rotation about the tool"),
        ("places", "mm", "shift of the workpiece"),
    ):
        if figures[name] and figures[name][0]["deflection_mm"] is not None:
            best = figures[name][0]
            value = ", ".join(f"{one:g}" for one in best[f"value_{unit}"])
            print(f"stiffest {title}: {value} {unit}, deflection {best['deflection_mm']:.3f} mm rms")


def _experiment(args: argparse.Namespace) -> int:
    from daidalos.industry.elasticity.elasticity_file import read_elasticity
    from daidalos.industry.welding.comparison import curve_rows, line_rows
    from daidalos.industry.welding.experiments import figures, run_experiment
    from daidalos.industry.welding.nine_zones import nine_zone_curve, straight_line
    from daidalos.industry.welding.report import experiment_report
    from daidalos.industry.welding.results import write_new
    from daidalos.industry.welding.simulated_cell import drawn

    if args.seed < 0:
        raise UserError(f"--seed is {args.seed}, but must not be negative")
    cell = cell_of(args)
    if args.truth is None:
        truth = drawn(cell.elasticity, args.seed)
    elif args.truth.is_file():
        truth = read_elasticity(args.truth, args.robot).with_tool(args.tool_mass)
    else:
        raise UserError(f"{args.truth}: there is no such file")
    is_line = args.test == "line"
    done = run_experiment(cell, truth, straight_line() if is_line else nine_zone_curve(), args.seed)
    rows = line_rows(done) if is_line else curve_rows(done)
    if args.output is not None:
        page = experiment_report(done, rows, f"Experiment: {args.test}")
        write_new(args.output, {f"{args.test}.html": page})
    if args.json:
        print(json.dumps({"welds": figures(done), "table": [row.as_json() for row in rows]}, indent=1))
        return 0
    print(f"{'':48}{'workshop':>22}{'here':>20}")
    for row in rows:
        print(f"{row.title:48}{row.printed:>22}{row.ours:>20}")
    remarks = dict.fromkeys(row.remark for row in rows if row.remark)
    for remark in remarks:
        print(f"- {remark}")
    return 0
