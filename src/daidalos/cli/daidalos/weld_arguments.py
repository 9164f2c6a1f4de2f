"""Arguments of `daidalos weld` that describe the robot, its elasticity and its tool."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.welding.correction import Cell


def add_robot(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments that describe the robot and what counts for its deflection."""
    parser.add_argument("--robot", default="kr500_2mt", metavar="ARM", help="of `daidalos arm list`")
    parser.add_argument(
        "--elasticity", type=Path, metavar="FILE", help="YAML (default: that of the robot's description)"
    )
    parser.add_argument(
        "--tool", type=finite, nargs="+", default=[0.0, 0.0, 800.0], metavar="T",
        help="tool's centre point on the flange: X Y Z [mm] and A B C [deg] (default: 0 0 800)",
    )  # fmt: skip
    parser.add_argument("--tool-mass", type=finite, default=120.0, metavar="KG", help="for gravity (default: 120)")
    parser.add_argument("--gravity", action="store_true", help="count the weight of the links and the tool")
    parser.add_argument("--friction", action="store_true", help="count friction of the joints")
    parser.add_argument("--no-backlash", action="store_true", help="do not count backlash")


def finite(text: str) -> float:
    """Return a finite number of the command line."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is no finite number")
    return value


def cell_of(args: argparse.Namespace) -> Cell:
    """Return the robot and its tool that arguments describe.

    Raises
    ------
    UserError
        Where there is no such robot, or it has no elasticity.
    """
    from daidalos.industry.elasticity.deflection import Options
    from daidalos.industry.elasticity.elasticity_file import read_elasticity
    from daidalos.industry.robots import arm_named
    from daidalos.industry.welding.correction import Cell

    try:
        arm = arm_named(args.robot)
    except ValueError as error:
        raise UserError(str(error)) from None
    file = args.elasticity or elasticity_of(arm.name)
    if not file.is_file():
        if args.elasticity is None:
            raise UserError(f"the stiffness of {arm.title} is not known; give --elasticity FILE")
        raise UserError(f"{file}: there is no such file")
    if args.tool_mass < 0.0:
        raise UserError(f"--tool-mass is {args.tool_mass:g}, but must not be negative")
    elasticity = read_elasticity(file, arm.name).with_tool(args.tool_mass)
    tool = pose_of(args.tool, "--tool")
    return Cell(arm, elasticity, tool, Options(args.gravity, args.friction, (not args.no_backlash,) * 6))


def elasticity_of(robot: str) -> Path:
    """Return where a robot's description has its elasticity, whether it is there or not."""
    return Path(__file__).parents[2] / "share" / f"{robot}_description" / "config" / "elasticity.yaml"


def pose_of(values: list[float], option: str) -> Any:
    """Return the pose (4, 4) of X Y Z [mm] and A B C [deg]; the angles may be left out."""
    from daidalos.common.pose3 import Pose

    if len(values) not in (3, 6):
        raise UserError(f"{option} has {len(values)} values, but X Y Z or X Y Z A B C are expected")
    x, y, z, a, b, c = (*values, 0.0, 0.0, 0.0)[:6]
    position = (1e-3 * x, 1e-3 * y, 1e-3 * z)
    return Pose.from_xyz_rpy(position, (math.radians(c), math.radians(b), math.radians(a))).matrix
