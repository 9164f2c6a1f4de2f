"""`daidalos weld poses`, `measure` and `identify`: the elasticity of a robot from load tests."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.daidalos.weld_arguments import add_robot, cell_of, elasticity_of, finite
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.elasticity.elasticity import Elasticity
    from daidalos.industry.elasticity.identification import Friction, Identification

_FRICTION = ("coulomb_friction", "breakaway_friction", "stribeck_speed", "viscous_friction")
_BESIDE = [300.0, 0.0, 500.0]
"""Place of the load beside axis 6 [mm], since a load in line with an axis does not wind it."""


def add_load_tests(commands: Any) -> None:
    """Declare the commands."""
    poses = commands.add_parser("poses", help="choose poses and loads for a load test")
    add_robot(poses)
    poses.add_argument("--count", type=int, default=12, metavar="N", help="poses (default: 12)")
    poses.add_argument("--force", type=finite, default=3000.0, metavar="N", help="greatest load (default: 3000)")
    poses.add_argument("--seed", type=int, default=0, help="of the poses (default: 0)")
    poses.add_argument("-o", "--output", type=Path, required=True, metavar="CSV", help="poses and loads")
    poses.set_defaults(_command=_poses, tool=_BESIDE, tool_mass=0.0)

    measure = commands.add_parser("measure", help="do a load test in the simulated cell")
    measure.add_argument("path", type=Path, metavar="CSV", help="poses and loads")
    add_robot(measure)
    measure.add_argument("--seed", type=int, default=0, help="of the robot's elasticity and the noise (default: 0)")
    measure.add_argument("-o", "--output", type=Path, required=True, metavar="CSV", help="with measured places")
    measure.add_argument("--friction-output", type=Path, metavar="CSV", help="torques of runs at constant speed")
    measure.add_argument("--truth-output", type=Path, metavar="YAML", help="elasticity of the simulated robot")
    measure.set_defaults(_command=_measure, tool=_BESIDE, tool_mass=0.0)

    identify = commands.add_parser("identify", help="estimate stiffness, backlash and friction from measurements")
    identify.add_argument("path", type=Path, metavar="CSV", help="pose, joint_1_deg..., fx..., x_mm, y_mm, z_mm")
    add_robot(identify)
    identify.add_argument("--runs", type=Path, metavar="CSV", help="axis, speed_deg_s, torque_nm")
    identify.add_argument("-o", "--output", type=Path, metavar="YAML", help="elasticity with what was found")
    identify.add_argument("--json", action="store_true", help="print the figures as JSON")
    identify.set_defaults(_command=_identify, tool=_BESIDE, tool_mass=0.0)


def _poses(args: argparse.Namespace) -> int:
    from daidalos.industry.elasticity.load_tests import as_csv, design

    if not 2 <= args.count <= 100:
        raise UserError(f"--count is {args.count}, but must be 2 to 100")
    if not args.force > 0.0:
        raise UserError(f"--force is {args.force:g}, but must be greater than 0 N")
    cell = cell_of(args)
    try:
        test = design(cell.arm, cell.elasticity, cell.tool, args.count, args.force, _seed(args))
    except ValueError as error:
        raise UserError(str(error)) from None
    _write(args.output, as_csv(test))
    print(f"written to {args.output}: {args.count} poses, {len(test.poses)} loads up to {args.force:g} N")
    return 0


def _measure(args: argparse.Namespace) -> int:
    from daidalos.industry.elasticity.elasticity_file import read_elasticity, write_elasticity
    from daidalos.industry.elasticity.load_tests import as_csv, read_load_test
    from daidalos.industry.welding.simulated_cell import drawn
    from daidalos.industry.welding.simulated_load_test import friction_runs, measure

    cell = cell_of(args)
    test = read_load_test(_file(args.path), measured=False)
    for path in (args.output, args.friction_output, args.truth_output):
        if path is not None and path.exists():
            raise UserError(f"{path}: is there already")
    truth = drawn(cell.elasticity, _seed(args))
    _write(args.output, as_csv(measure(cell.arm, truth, test, cell.tool, args.seed)))
    if args.friction_output is not None:
        _write(args.friction_output, friction_runs(truth, args.seed))
    if args.truth_output is not None:
        known = read_elasticity(args.elasticity or elasticity_of(cell.arm.name), cell.arm.name)
        bare = drawn(known, args.seed)
        write_elasticity(args.truth_output, cell.arm.name, bare, dict.fromkeys(bare.uncertainty, "Drawn."))
    print(f"written to {args.output}: {len(test.poses)} loads measured")
    return 0


def _identify(args: argparse.Namespace) -> int:
    from daidalos.industry.elasticity.elasticity_file import read_elasticity
    from daidalos.industry.elasticity.identification import identify, identify_friction, read_friction_runs
    from daidalos.industry.elasticity.load_tests import read_load_test

    cell = cell_of(args)
    test = read_load_test(_file(args.path), measured=True)
    try:
        found = identify(cell.arm, cell.elasticity, test, cell.tool)
    except ValueError as error:
        raise UserError(f"{args.path}: {error}") from None
    friction: dict[int, Friction] = {}
    if args.runs is not None:
        for axis, runs in read_friction_runs(_file(args.runs)).items():
            try:
                friction[axis] = identify_friction(runs)
            except ValueError as error:
                raise UserError(f"{args.runs}: axis {axis}: {error}") from None
    if args.output is not None:
        known = read_elasticity(args.elasticity or elasticity_of(cell.arm.name), cell.arm.name)
        _write_elasticity(args.output, cell.arm.name, known, found, friction, args.path)
    if args.json:
        print(json.dumps(found.as_json() | {"friction": [_friction_json(*one) for one in friction.items()]}, indent=1))
    else:
        _show(found, friction)
        if args.output is not None:
            print(f"written to {args.output}")
    return 0


def _show(found: Identification, friction: dict[int, Friction]) -> None:
    print(f"{'axis':6}{'stiffness [Nm/rad]':>20}{'+-95 %':>10}{'backlash [arcmin]':>20}{'+-95 %':>8}")
    for one in found.as_json()["axes"]:
        share = 100.0 * one["stiffness_confidence"] / one["stiffness_nm_per_rad"]
        print(
            f"{one['axis']:<6}{one['stiffness_nm_per_rad']:>20.4g}{share:>9.1f}%"
            f"{one['backlash_arcmin']:>20.3f}{one['backlash_confidence']:>8.3f}"
        )
    print(
        f"residuals {1e3 * found.noise:.3f} mm, condition {found.condition:.1f}, "
        f"{found.used} of {found.given} loads used"
    )
    if friction:
        print(f"{'axis':6}{'Coulomb [Nm]':>16}{'breakaway [Nm]':>16}{'Stribeck [deg/s]':>18}{'viscous [Nm s/rad]':>20}")
    for axis, one in friction.items():
        coulomb, breakaway, stribeck, viscous = one.values
        print(f"{axis:<6}{coulomb:>16.1f}{breakaway:>16.1f}{math.degrees(stribeck):>18.2f}{viscous:>20.1f}")


def _friction_json(axis: int, one: Friction) -> dict[str, Any]:
    return {"axis": axis} | {
        name: {"value": float(f"{value:.6g}"), "deviation": float(f"{deviation:.3g}")}
        for name, value, deviation in zip(_FRICTION, one.values, one.deviations, strict=True)
    }


def _write_elasticity(
    path: Path, robot: str, known: Elasticity, found: Identification, friction: dict[int, Friction], source: Path
) -> None:
    from daidalos.industry.elasticity.elasticity_file import write_elasticity

    values = {"stiffness": found.stiffness, "backlash": found.backlash}
    deviations = {**known.uncertainty, "stiffness": found.stiffness_deviation, "backlash": found.backlash_deviation}
    sources = dict.fromkeys(known.uncertainty, "As before the identification.")
    sources |= dict.fromkeys(values, f"Identified from {source.name}.")
    for index, name in enumerate(_FRICTION):
        if not friction:
            break
        values[name], deviations[name] = getattr(known, name).copy(), known.uncertainty[name].copy()
        for axis, one in friction.items():
            values[name][axis - 1], deviations[name][axis - 1] = one.values[index], one.deviations[index]
        sources[name] = f"Identified on axes {', '.join(map(str, friction))}."
    new = replace(known, **values, uncertainty=deviations)
    try:
        write_elasticity(path, robot, new, sources)
    except FileExistsError:
        raise UserError(f"{path}: is there already") from None
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from None


def _seed(args: argparse.Namespace) -> int:
    if args.seed < 0:
        raise UserError(f"--seed is {args.seed}, but must not be negative")
    return int(args.seed)


def _file(path: Path) -> Path:
    if not path.is_file():
        raise UserError(f"{path}: there is no such file")
    return path


def _write(path: Path, text: str) -> None:
    from daidalos.industry.welding.results import write_new

    write_new(path.parent, {path.name: text})
