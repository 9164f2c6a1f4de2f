"""Arguments of `daidalos grind` that describe the cell, the force control and what breaks."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.weld_arguments import finite
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.grinding.cell import Fault
    from daidalos.industry.grinding.force_control import ForceController
    from daidalos.industry.grinding.height_field import Workpiece
    from daidalos.industry.grinding.settings import CellParameters


def add_cell(parser: argparse.ArgumentParser, resolution: float) -> None:
    """Declare the arguments that every grinding command has, with a default of the resolution [mm]."""
    parser.add_argument(
        "--resolution", type=finite, default=resolution, metavar="MM", help=f"edge of a cell (default: {resolution:g})"
    )
    parser.add_argument("--cell", type=Path, metavar="FILE", help="YAML with parameters of the cell, in groups")
    parser.add_argument(
        "--set", dest="settings", action="append", default=[], metavar="NAME=VALUE",
        help="parameter of the force controller, such as integral=5",
    )  # fmt: skip
    parser.add_argument(
        "--fault", dest="faults", action="append", default=[], metavar="KIND@S",
        help="break sensor_stops, sensor_nan or valve_stops at a time",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, default=0, help="of noise and errors (default: 0)")
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="where figures, records and report go")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")


def add_job(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the commands that grind a workpiece."""
    parser.add_argument("--controller", default="pi", metavar="NAME", help="force controller (default: pi)")
    parser.add_argument("--force", type=finite, default=30.0, metavar="N", help="on the workpiece (default: 30)")
    parser.add_argument("--robot", default="irb8700", metavar="ARM", help="of `daidalos arm list` (default: irb8700)")
    parser.add_argument("--input", type=Path, metavar="FILE", help="workpiece: .npz, or .csv with a grid of heights")
    parser.add_argument(
        "--place", type=finite, nargs="+", metavar="P",
        help="pose of the workpiece in the base: X Y Z [mm] A B C [deg] about z, y', x''",
    )  # fmt: skip
    add_cell(parser, 0.25)


def cell_parameters(args: argparse.Namespace) -> CellParameters:
    """Return the parameters of the cell.

    Raises
    ------
    UserError
        Where the file is none, or the seed is negative.
    """
    from daidalos.industry.grinding.settings import CellParameters, read_cell

    if not 0.1 <= args.resolution <= 2.0:
        raise UserError(f"--resolution is {args.resolution:g}, but must be 0.1 to 2 mm")
    if args.seed < 0:
        raise UserError(f"--seed is {args.seed}, but must not be negative")
    if args.cell is None:
        return CellParameters()
    if not args.cell.is_file():
        raise UserError(f"{args.cell}: there is no such file")
    return read_cell(args.cell)


def controller_maker(name: str, args: argparse.Namespace, parameters: CellParameters) -> Callable[[], ForceController]:
    """Return what makes force controllers with the settings of the command line.

    Raises
    ------
    UserError
        Where there is no such controller, or it has no such parameter.
    """
    from daidalos.industry.grinding.tasks import make_controller

    settings: dict[str, object] = {}
    for text in args.settings:
        key, equals, value = text.partition("=")
        if not equals:
            raise UserError(f"--set is '{text}', but NAME=VALUE is expected")
        try:
            settings[key] = finite(value)
        except argparse.ArgumentTypeError as error:
            raise UserError(f"--set {key}: {error}") from None
    make_controller(name, settings, parameters)
    return lambda: make_controller(name, settings, parameters)


def faults(args: argparse.Namespace) -> list[Fault]:
    """Return what breaks when.

    Raises
    ------
    UserError
        Where there is no such fault, or its time is none.
    """
    from daidalos.industry.grinding.cell import parse_fault

    return [parse_fault(text) for text in args.faults]


def workpiece(args: argparse.Namespace, default: Callable[[float], Workpiece]) -> Workpiece:
    """Return the workpiece of the command line, or a default one of a resolution [m]."""
    from daidalos.cli.daidalos.weld_arguments import pose_of
    from daidalos.industry.grinding.height_field import read_workpiece
    from daidalos.industry.grinding.workpieces import place

    piece = default(1e-3 * args.resolution) if args.input is None else read_workpiece(args.input)
    if args.place is not None:
        return replace(piece, pose=pose_of(args.place, "--place"))
    has_place = args.input is None or args.input.suffix.lower() != ".csv"
    return piece if has_place else replace(piece, pose=place())
