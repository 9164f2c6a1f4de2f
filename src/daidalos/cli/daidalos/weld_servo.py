"""`daidalos weld servo`: a tool that follows a seam which a laser profile sensor measures ahead of it."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.daidalos.weld_arguments import finite
from daidalos.cli.daidalos.weld_servo_run import compare_runs, run_robot, run_servo
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.servoing.loop_design import Compensator


def add_servo(commands: Any) -> None:
    """Declare the commands."""
    servo = commands.add_parser("servo", help="follow a seam that a laser profile sensor measures")
    verbs = servo.add_subparsers(title="commands", required=True, metavar="COMMAND")
    design = verbs.add_parser("design", help="compute margins and step responses of the servo loop")
    design.add_argument(
        "--compensator", action="append", metavar="NAME|GAIN[,ZERO,POLE]",
        help="proportional, lead, or a gain with two time constants [s] (default: both of the workshop)",
    )  # fmt: skip
    design.add_argument("--cycle", type=finite, default=12.0, metavar="MS", help="between corrections (default: 12)")
    design.add_argument(
        "--cutoff", type=finite, default=22.6, metavar="RAD/S", help="of the low-pass filter (default: 22.6)"
    )
    design.add_argument("--spindle", type=finite, default=800.0, metavar="RPM", help="of the notch (default: 800)")
    design.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="where report and figures go")
    design.add_argument("--json", action="store_true", help="print the figures as JSON")
    design.set_defaults(_command=_design)
    run = verbs.add_parser("run", help="follow a seam, in the simulated cell or with a robot")
    run.add_argument("--seam", default="line", metavar="SEAM", help="line, curve or long (default: line)")
    run.add_argument(
        "--controller", default="feedforward", metavar="NAME",
        help="of `daidalos extensions seam_controllers`, or off (default: feedforward)",
    )  # fmt: skip
    run.add_argument("--speed", type=finite, default=300.0, metavar="MM/MIN", help="along the seam (default: 300)")
    run.add_argument("--lead", type=finite, default=35.0, metavar="MM", help="of the sensor (default: 35)")
    run.add_argument("--limit", type=finite, default=5.0, metavar="MM", help="of the correction (default: 5)")
    run.add_argument("--rsi", type=Path, metavar="XML", help="Ethernet configuration (default: that of kr500_2mt)")
    cell = run.add_argument_group("simulated cell")
    cell.add_argument("--seed", type=int, default=0, help="of edges and noise (default: 0)")
    cell.add_argument("--irregularity", type=finite, default=1.0, metavar="SHARE", help="of the edges (default: 1)")
    cell.add_argument("--lost", type=finite, default=0.0, metavar="SHARE", help="of answers that get lost")
    cell.add_argument("--blind", type=finite, nargs=2, metavar="MM", help="where the sensor sees nothing: FROM TO")
    cell.add_argument("--fast", action="store_true", help="IPO_FAST: cycles of 4 ms")
    cell.add_argument("--realtime", action="store_true", help="let cycles take their time")
    robot = run.add_argument_group("robot")
    robot.add_argument(
        "--robot", metavar="ADDRESS[:PORT]",
        help="wait for this robot's telegrams on a port (default: 59152); its profiles are simulated where it is",
    )  # fmt: skip
    robot.add_argument("--heading", type=finite, default=0.0, metavar="DEG", help="of the path in the robot's base")
    robot.add_argument("--wait", type=finite, default=60.0, metavar="S", help="for the robot (default: 60)")
    run.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="where run and report go")
    run.add_argument("--json", action="store_true", help="print the figures as JSON")
    run.set_defaults(_command=run_servo)
    robot_parser = verbs.add_parser("robot", help="simulate a robot with RSI, in real time")
    robot_parser.add_argument("--to", default="127.0.0.1:59152", metavar="ADDRESS[:PORT]", help="where telegrams go")
    robot_parser.add_argument("--rsi", type=Path, metavar="XML", help="Ethernet configuration")
    robot_parser.add_argument("--speed", type=finite, default=300.0, metavar="MM/MIN", help="(default: 300)")
    robot_parser.add_argument("--length", type=finite, default=100.0, metavar="MM", help="of the seam (default: 100)")
    robot_parser.add_argument("--max-lost", type=int, default=10, metavar="N", help="answers in a row (default: 10)")
    robot_parser.add_argument("--wait", type=finite, default=60.0, metavar="S", help="for an answer (default: 60)")
    robot_parser.add_argument(
        "--stand", type=finite, metavar="S", help="stand so long, its axes corrected by ros2_control, instead of a seam"
    )
    robot_parser.add_argument("--fast", action="store_true", help="IPO_FAST: cycles of 4 ms")
    robot_parser.add_argument("--json", action="store_true", help="print what happened as JSON")
    robot_parser.set_defaults(_command=run_robot)
    compare = verbs.add_parser("compare", help="compare saved runs, and write a report")
    compare.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="run.npz of `daidalos weld servo run -o`")
    compare.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="where the report goes")
    compare.add_argument("--json", action="store_true", help="print the figures as JSON")
    compare.set_defaults(_command=compare_runs)


def _design(args: argparse.Namespace) -> int:
    import math

    from daidalos.industry.servoing.design_report import design_report
    from daidalos.industry.servoing.design_table import reachable, rows
    from daidalos.industry.servoing.loop_design import COMPENSATORS, LoopModel, design
    from daidalos.industry.welding.results import write_new

    for option in ("cycle", "cutoff", "spindle"):
        if not getattr(args, option) > 0.0:
            raise UserError(f"--{option} is {getattr(args, option):g}, but must be greater than 0")
    model = LoopModel(cycle=1e-3 * args.cycle, cutoff=args.cutoff, notch=2.0 * math.pi * args.spindle / 60.0)
    compensators = [_compensator(one) for one in args.compensator or COMPENSATORS]
    designs = {one.name: design(model, one) for one in compensators}
    table = rows(designs, reachable(model)) if list(designs) == list(COMPENSATORS) else []
    figures = {
        "designs": [one.as_json() for one in designs.values()],
        "table": [row.as_json() for row in table],
    }
    text = json.dumps(figures, indent=1)
    if args.output is not None:
        page = design_report(list(designs.values()), table)
        write_new(args.output, {"design.html": page, "design.json": text + "\n"})
    if args.json:
        print(text)
        return 0
    print(f"{'':22}{'phase margin':>14}{'gain margin':>13}{'crossover':>14}{'overshoot':>11}{'settling':>10}")
    for name, one in designs.items():
        found = one.figures
        print(
            f"{name:22}{found.phase_margin:10.2f} deg{found.gain_margin:10.2f} dB{found.crossover:8.2f} rad/s"
            f"{found.overshoot:9.2f} %{found.settling_time:8.3f} s"
        )
    if table:
        print(f"\n{'':34}{'workshop':>12}{'here':>12}")
        for row in table:
            print(f"{row.title:34}{row.printed:>12}{row.ours:>12}")
        for row in table:
            if row.remark:
                print(f"- {row.title}: {row.remark}")
    return 0


def _compensator(text: str) -> Compensator:
    from daidalos.industry.servoing.loop_design import Compensator, compensator_named

    if not text[:1].isdigit() and text[:1] not in ".+-":
        return compensator_named(text)
    try:
        values = [finite(part) for part in text.split(",")]
    except argparse.ArgumentTypeError as error:
        raise UserError(f"--compensator {text}: {error}") from None
    if len(values) not in (1, 3) or values[0] <= 0.0 or any(one < 0.0 for one in values):
        raise UserError(f"--compensator is '{text}', but GAIN or GAIN,ZERO,POLE greater than 0 are expected")
    return Compensator(text, *values)
