"""`daidalos arm`: kinematics of industrial robots, in the millimetres and degrees of their controllers."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.arm_egm import add_egm_arguments
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from daidalos.industry.robots import Arm
    from daidalos.industry.robots.redundant import RedundantArm

_QUATERNION_TOLERANCE = 1e-3
"""Deviation of a quaternion's length from 1 up to which it is normalised: RAPID programs print six digits."""


class ArmVerb:
    """Compute poses, joint angles and configurations of industrial robots."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos arm`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
        commands.add_parser("list", help="print the known arms").set_defaults(_command=_list)
        show = commands.add_parser("show", help="print dimensions, ranges and speeds of an arm")
        show.add_argument("arm", metavar="ARM", help="such as irb120")
        show.set_defaults(_command=_show)
        forward = commands.add_parser("forward", help="print the pose and the configuration of angles")
        forward.add_argument("arm", metavar="ARM", help="such as irb120")
        forward.add_argument("angles", type=_finite, nargs="+", metavar="DEG", help="angles of axes 1 to 6 or 7 [deg]")
        forward.set_defaults(_command=_forward)
        inverse = commands.add_parser("inverse", help="print all solutions of a pose of the flange")
        inverse.add_argument("arm", metavar="ARM", help="such as irb120")
        inverse.add_argument("position", type=_finite, nargs=3, metavar="MM", help="position in the base [mm]")
        inverse.add_argument("orientation", type=_finite, nargs=4, metavar="Q", help="quaternion q1 (real) to q4")
        inverse.add_argument(
            "--arm-angle", type=_finite, metavar="DEG", help="arm angle of an arm with seven axes (default: any)"
        )
        inverse.set_defaults(_command=_inverse)
        egm = commands.add_parser(
            "egm", help="ABB's Externally Guided Motion, with a simulated controller or a real one"
        )
        add_egm_arguments(egm)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        try:
            args._command(args)
        except ValueError as error:
            raise UserError(str(error)) from None
        return 0


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not finite")
    return value


def _list(args: argparse.Namespace) -> None:
    from daidalos.industry.robots import ARMS, REDUNDANT_ARMS

    arms: list[Arm | RedundantArm] = [*ARMS.values(), *REDUNDANT_ARMS.values()]
    for arm in arms:
        print(f"{arm.name:10} {arm.title:24} {arm.payload:g} kg, reach {arm.reach:.2f} m")


def _show(args: argparse.Namespace) -> None:
    from daidalos.industry.robots import REDUNDANT_ARMS, arm_named

    if args.arm.lower() in REDUNDANT_ARMS:
        from daidalos.cli.daidalos.redundant_arm import show

        show(REDUNDANT_ARMS[args.arm.lower()])
        return
    arm = arm_named(args.arm)
    print(f"{arm.title}: payload {arm.payload:g} kg, mass {arm.mass:g} kg")
    for title, name in (
        ("floor to axis 2", "base_height"), ("axis 1 to axis 2", "shoulder_offset"), ("axis 2 to axis 3", "lower_arm"),
        ("axis 3 to axis 4", "elbow_offset"), ("axis 3 to wrist", "forearm"), ("wrist to flange", "flange"),
    ):  # fmt: skip
        print(f"  {title:18}{1e3 * getattr(arm, name):8.1f} mm")
    for number, axis in enumerate(arm.axes, 1):
        lower, upper, speed = (math.degrees(value) for value in (axis.lower, axis.upper, axis.speed))
        print(f"  axis {number}  {lower:7.1f} to {upper:6.1f} deg, {speed:6.1f} deg/s")
    print(f"Source: {arm.source}")


def _forward(args: argparse.Namespace) -> None:
    import numpy as np

    from daidalos.common.pose3 import Pose
    from daidalos.industry.motion.kinematics import confdata, forward, within_limits
    from daidalos.industry.robots import REDUNDANT_ARMS, arm_named

    if args.arm.lower() in REDUNDANT_ARMS:
        from daidalos.cli.daidalos.redundant_arm import print_pose

        print_pose(REDUNDANT_ARMS[args.arm.lower()], args.angles)
        return
    arm, angles = arm_named(args.arm), np.radians(args.angles)
    if len(angles) != len(arm.axes):
        raise ValueError(f"{arm.title} has {len(arm.axes)} axes, not {len(angles)}")
    pose = Pose.from_matrix(forward(arm, angles))
    x, y, z, w = (value if pose.orientation[3] >= 0.0 else -value for value in pose.orientation)
    position = ", ".join(rounded(1e3 * value, 3) for value in pose.position)
    orientation = ", ".join(rounded(value, 6) for value in (w, x, y, z))
    configuration = ", ".join(str(value) for value in confdata(arm, angles))
    print(
        f"[[{position}], [{orientation}], [{configuration}]]{_remarks(arm, angles, bool(within_limits(arm, angles)))}"
    )


def _inverse(args: argparse.Namespace) -> None:
    import numpy as np

    from daidalos.common.pose3 import Pose, normalize
    from daidalos.industry.motion.kinematics import confdata, inverse
    from daidalos.industry.robots import REDUNDANT_ARMS, arm_named

    redundant = REDUNDANT_ARMS.get(args.arm.lower())
    if redundant is None and args.arm_angle is not None:
        raise ValueError(f"--arm-angle goes with an arm that has seven axes, such as {next(iter(REDUNDANT_ARMS))}")
    if redundant is None:
        arm_named(args.arm)
    w, x, y, z = args.orientation
    if abs(math.hypot(w, x, y, z) - 1.0) > _QUATERNION_TOLERANCE:
        raise ValueError(f"the quaternion has the length {math.hypot(w, x, y, z):.4g}, but must have 1")
    position = tuple(1e-3 * value for value in args.position)
    pose = Pose(position, normalize((x, y, z, w))).matrix
    if redundant is not None:
        from daidalos.cli.daidalos.redundant_arm import print_solutions

        print_solutions(redundant, pose, args.arm_angle)
        return
    arm = arm_named(args.arm)
    solutions = inverse(arm, pose)
    if not solutions.reachable.any():
        raise ValueError(f"the pose is out of reach of {arm.title}")
    print("cfx    axis 1    axis 2    axis 3    axis 4    axis 5    axis 6  [cf1, cf4, cf6, cfx]")
    for cfx in np.flatnonzero(solutions.reachable):
        angles = solutions.joints[cfx]
        conf = confdata(arm, angles)
        if conf[3] != cfx:
            continue  # in a singularity, where it is the same solution as another
        columns = "".join(f"{rounded(value, 3):>10}" for value in np.degrees(angles))
        configuration = ", ".join(str(value) for value in conf)
        remarks = _remarks(arm, angles, bool(solutions.within_limits[cfx]))
        print(f"{cfx:<3}{columns}  [{configuration}]{remarks}")


def rounded(value: float, digits: int) -> str:
    """Return a number without a minus sign before zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def _remarks(arm: Arm, angles: NDArray[np.float64], inside: bool) -> str:
    """Return the singularities and the axes that are outside their ranges, as the end of a line."""
    from daidalos.industry.motion.kinematics import Singularity, singularities

    found = Singularity(int(singularities(arm, angles)))
    remarks = [f"{one.name.lower()} singularity" for one in found if one.name]
    if not inside:
        axes = zip(angles, arm.axes, strict=True)
        outside = [str(n) for n, (angle, axis) in enumerate(axes, 1) if not axis.lower <= angle <= axis.upper]
        remarks.append(f"axis {', '.join(outside)} out of range")
    return f"  {'; '.join(remarks)}" if remarks else ""
