"""`daidalos weld servo run`, `robot` and `compare`: seams that are followed through RSI."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError
from daidalos.interfaces.library import BUILT_IN

if TYPE_CHECKING:
    from daidalos.industry.rsi.configuration import Configuration
    from daidalos.industry.servoing.seam_servo import ServoSettings
    from daidalos.industry.servoing.servo_run import ServoRun

_CONFIGURATION = BUILT_IN / "kr500_2mt_description/config/rsi/seam_servo.xml"
_ROWS = (
    ("response time [s]", "response_time_s"),
    ("overshoot [mm]", "overshoot_mm"),
    ("residual [mm]", "residual_mm"),
    ("standard deviation [mm]", "std_mm"),
    ("interval [mm]", "interval_mm"),
    ("worst 100 mm, std [mm]", "worst_piece_std_mm"),
    ("gap [mm]", "gap_mm"),
    ("seam seen [%]", "seen_percent"),
    ("computing time [ms]", "computing_ms"),
    ("cycles", "cycles"),
    ("answers lost", "lost"),
)


def run_servo(args: argparse.Namespace) -> int:
    """Follow a seam; the status is 1 where its end was not reached."""
    from daidalos.industry.rsi.controller import IPO_FAST, ControllerSettings
    from daidalos.industry.servoing.butt_joint import seam_named
    from daidalos.industry.servoing.experiments import OFF, CellOptions, controller_named, run_in_cell

    seam, configuration = seam_named(args.seam), _configuration(args.rsi)
    settings = _settings(args)
    controller_named(args.controller, settings)
    output = _new_output(args.output)
    if "RKorr" not in configuration.corrected and args.controller != OFF:
        raise UserError(f"{args.rsi}: RECEIVE has no RKorr, which corrects the pose")
    if args.robot is not None:
        run = _with_robot(args, configuration, settings)
    else:
        limits = ControllerSettings(position_limit=args.limit)
        options = CellOptions(
            seed=args.seed,
            irregularity=args.irregularity,
            lost=args.lost,
            blind=None if args.blind is None else (1e-3 * args.blind[0], 1e-3 * args.blind[1]),
            realtime=args.realtime,
            controller=replace(limits, cycle=IPO_FAST) if args.fast else limits,
        )
        run = run_in_cell(seam, args.controller, configuration, settings, options)
    if output is not None:
        _write(output, run)
    _show([run], args.json)
    if not args.json and output is not None:
        print(f"written to {args.output}: run.npz, servo.html")
    return 0 if run.is_complete else 1


def run_robot(args: argparse.Namespace) -> int:
    """Simulate a robot that sends its telegrams; the status is 1 where it stopped before its end."""
    import numpy as np

    from daidalos.industry.rsi.controller import IPO, IPO_FAST, ControllerSettings, SimulatedController
    from daidalos.industry.rsi.controller_server import ControllerServer
    from daidalos.industry.servoing.servo_cell import RUN_OUT, STANDING, START, straight_program

    for option in ("speed", "length", "wait"):
        _positive(option, getattr(args, option))
    if not 1 <= args.max_lost <= 1000:
        raise UserError(f"--max-lost is {args.max_lost}, but must be 1 to 1000")
    address, port = _address(args.to, "--to")
    speed, length = args.speed / 60e3, 1e-3 * args.length
    settings = ControllerSettings(cycle=IPO_FAST if args.fast else IPO, max_lost=args.max_lost)
    if args.stand is None:
        duration = (START + length + RUN_OUT) / speed
        controller = SimulatedController(_configuration(args.rsi), straight_program(speed), settings)
    else:
        _positive("stand", args.stand)
        duration = args.stand
        settings = replace(settings, relative=False, axis_limit=180.0)
        configuration = _configuration(args.rsi or _CONFIGURATION.with_name("joints.xml"))
        controller = SimulatedController(configuration, lambda _: np.zeros(6), settings, STANDING)
    with ControllerServer(controller, address, port) as server:
        server.wait_for_partner(args.wait)
        server.run(duration)
        figures = {
            "ended": controller.stopped or "the program's end was reached",
            "cycles": round(controller.time / settings.cycle),
            "lost": controller.total_lost,
            "refused": server.refused,
            "last_refusal": server.last_refusal,
            "correction_mm": [round(float(one), 4) for one in controller.correction[:3]],
            "axes_deg": [round(float(one), 4) for one in controller.axes],
        }
    if args.json:
        print(json.dumps(figures, indent=1))
    else:
        print("\n".join(f"{key}: {'none' if one == '' else one}" for key, one in figures.items()))
    return 1 if controller.stopped else 0


def compare_runs(args: argparse.Namespace) -> int:
    """Print the figures of saved runs beside each other."""
    from daidalos.industry.servoing.servo_report import servo_report
    from daidalos.industry.servoing.servo_run import load
    from daidalos.industry.welding.results import write_new

    runs = [load(path / "run.npz" if path.is_dir() else path) for path in args.runs]
    if args.output is not None:
        write_new(args.output, {"servo.html": servo_report(runs)})
    _show(runs, args.json)
    return 0


def _with_robot(args: argparse.Namespace, configuration: Configuration, settings: ServoSettings) -> ServoRun:
    from daidalos.industry.rsi.client import RsiClient, own_address_towards
    from daidalos.industry.servoing.butt_joint import ButtJoint, seam_named
    from daidalos.industry.servoing.experiments import run_with_robot, warm_up
    from daidalos.industry.servoing.servo_cell import RehearsalSensor

    _positive("wait", args.wait)
    seam = seam_named(args.seam)
    address, port = _address(args.robot, "--robot")
    sensor = RehearsalSensor(
        ButtJoint(seam, args.seed, args.irregularity), settings.heading, settings.sensor_lead, args.seed
    )
    own = own_address_towards(address)
    warm_up(args.controller, settings)
    with RsiClient(own, port, configuration.sensor, robot=address) as client:
        if not args.json:
            print(f"waiting for {address} on {own}:{client.port}", flush=True)
        return run_with_robot(client, seam, args.controller, settings, sensor, args.wait)


def _settings(args: argparse.Namespace) -> ServoSettings:
    from daidalos.industry.rsi.controller import IPO, IPO_FAST
    from daidalos.industry.servoing.contracts import LoopSetup
    from daidalos.industry.servoing.loop_design import LoopModel
    from daidalos.industry.servoing.seam_servo import ServoSettings

    for option in ("speed", "lead", "limit"):
        _positive(option, getattr(args, option))
    if args.seed < 0:
        raise UserError(f"--seed is {args.seed}, but must not be negative")
    if args.irregularity < 0.0:
        raise UserError(f"--irregularity is {args.irregularity:g}, but must not be negative")
    if not 0.0 <= args.lost < 1.0:
        raise UserError(f"--lost is {args.lost:g}, but must be 0 to 1")
    model = LoopModel(cycle=IPO_FAST if args.fast else IPO)
    setup = LoopSetup(model, speed=args.speed / 60e3, max_correction=1e-3 * args.limit)
    return ServoSettings(setup, heading=math.radians(args.heading), sensor_lead=1e-3 * args.lead)


def _positive(option: str, value: float) -> None:
    if not value > 0.0:
        raise UserError(f"--{option} is {value:g}, but must be greater than 0")


def _address(text: str, option: str) -> tuple[str, int]:
    from daidalos.industry.rsi.client import DEFAULT_PORT

    address, _, port = text.partition(":")
    if not address or (port and not (port.isdecimal() and 1 <= int(port) <= 65535)):
        raise UserError(f"{option} is '{text}', but ADDRESS or ADDRESS:PORT with a port from 1 to 65535 is expected")
    return address, int(port) if port else DEFAULT_PORT


def _configuration(path: Path | None) -> Configuration:
    from daidalos.industry.rsi.configuration import read_configuration

    return read_configuration(_CONFIGURATION if path is None else path)


def _new_output(folder: Path | None) -> Path | None:
    """Return the folder, where none of the files is there already: a run is not thrown away at its end."""
    for name in ("run.npz", "servo.html") if folder is not None else ():
        if folder is not None and (folder / name).exists():
            raise UserError(f"{folder / name}: is there already; choose another folder or remove it")
    return folder


def _write(folder: Path, run: ServoRun) -> None:
    from daidalos.industry.servoing.servo_report import servo_report
    from daidalos.industry.welding.results import write_new

    write_new(folder, {"servo.html": servo_report([run])})
    run.save(folder / "run.npz")


def _show(runs: list[ServoRun], as_json: bool) -> None:
    from daidalos.industry.servoing.servo_report import servo_rows

    figures = [run.figures() for run in runs]
    rows = [row for run in runs for row in servo_rows(run)]
    if as_json:
        print(json.dumps({"runs": figures, "table": [row.as_json() for row in rows]}, indent=1))
        return
    titles = [f"{run.seam}, {run.controller}" for run in runs]
    print(f"{'':26}" + "".join(f"{title:>22}" for title in titles))
    for title, key in _ROWS:
        print(f"{title:26}" + "".join(f"{_text(one.get(key)):>22}" for one in figures))
    for run in runs:
        print(f"{run.seam}, {run.controller}: {run.ended}")
    if rows:
        print(f"\n{'':36}{'workshop':>18}{'here':>18}")
        for row in rows:
            print(f"{row.title:36}{row.printed:>18}{row.ours:>18}")
        for remark in dict.fromkeys(row.remark for row in rows if row.remark):
            print(f"- {remark}")


def _text(value: Any) -> str:
    if isinstance(value, list):
        return f"{value[0]:.3f} to {value[1]:.3f}"
    if value is None:
        return "-"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
