"""`daidalos rapid calibrate`: tools and work objects from touched points, guided on the terminal or recorded."""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    import numpy as np

JOINTS = tuple(f"joint_{number}" for number in range(1, 7))
WAIT_S = 10.0


def add_calibrate(commands: Any) -> None:
    """Declare the arguments of `daidalos rapid calibrate`."""
    calibrate = commands.add_parser("calibrate", help="find a tool or a work object by touching points")
    kinds = calibrate.add_subparsers(title="what", required=True, metavar="tool | wobj")
    tool = kinds.add_parser("tool", help="tooldata from four touches of a fixed point and more, with its axes")
    tool.add_argument("name", metavar="NAME", help="name of the tooldata")
    tool.add_argument("--points", type=int, default=4, metavar="N", help="touches of the fixed point (default: 4)")
    tool.add_argument(
        "--method",
        choices=("tcp", "z", "zx"),
        default="tcp",
        help="tcp: the axes of the flange; z: a pose with the fixed point on z; zx: poses on z and on x (default: tcp)",
    )
    tool.add_argument("--mass", type=float, default=1.0, metavar="KG", help="mass of the tool (default: 1)")
    tool.set_defaults(_command=_calibrate_tool)
    wobj = kinds.add_parser("wobj", help="wobjdata from three points: x1, x2 and y1")
    wobj.add_argument("name", metavar="NAME", help="name of the wobjdata")
    wobj.add_argument(
        "--tool",
        type=float,
        nargs=3,
        required=True,
        metavar=("X", "Y", "Z"),
        help="tip that touches, in the flange [mm]",
    )
    wobj.add_argument("--noise", type=float, default=0.3, metavar="MM", help="deviation of a touch (default: 0.3)")
    wobj.set_defaults(_command=_calibrate_wobj)
    for one in (tool, wobj):
        one.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.mod", help="module for the data")
        one.add_argument("--force", action="store_true", help="replace data of that name")
        one.add_argument("--robot", default="irb120", metavar="ARM", help="the arm (default: irb120)")
        one.add_argument(
            "--poses",
            type=Path,
            metavar="FILE.mod",
            help="recorded jointtargets, or robtargets of tool0 in wobj0, in the order in which they are asked for "
            "(default: the arm's present angles, at each press of Enter)",
        )
        one.add_argument(
            "--joint-states",
            default="/joint_states",
            metavar="TOPIC",
            help="angles of the arm (default: /joint_states)",
        )


def _calibrate_tool(args: argparse.Namespace) -> int:
    from daidalos.industry.rapid.teaching import FEWEST_POINTS, MOST_POINTS, teach_tool, tool_prompts

    if not FEWEST_POINTS <= args.points <= MOST_POINTS:
        raise UserError(f"--points takes {FEWEST_POINTS} to {MOST_POINTS}, not {args.points}")
    if not (math.isfinite(args.mass) and args.mass > 0.0):
        raise UserError(f"--mass takes more than 0 kg, not {args.mass:g}")
    return _calibrate(
        args, tool_prompts(args.points, args.method), lambda poses: teach_tool(args.name, poses, args.method, args.mass)
    )


def _calibrate_wobj(args: argparse.Namespace) -> int:
    import numpy as np

    from daidalos.industry.rapid.teaching import teach_work_object, work_object_prompts

    if not all(map(math.isfinite, args.tool)):
        raise UserError("--tool takes finite millimetres")
    if not (math.isfinite(args.noise) and args.noise > 0.0):
        raise UserError(f"--noise takes more than 0 mm, not {args.noise:g}")
    tool = np.eye(4)
    tool[:3, 3] = 1e-3 * np.array(args.tool)
    return _calibrate(
        args, work_object_prompts(), lambda poses: teach_work_object(args.name, poses, tool, 1e-3 * args.noise)
    )


def _calibrate(args: argparse.Namespace, prompts: Sequence[str], teach: Callable[[Sequence[np.ndarray]], Any]) -> int:
    """Collect poses, compute, print and write.

    Raises
    ------
    UserError
        Where poses are missing or do not determine the result, or the data may not be written.
    """
    from daidalos.industry.calibration import CalibrationError
    from daidalos.industry.rapid.teaching import save

    if not (args.name.isascii() and args.name.isidentifier() and args.name[0] != "_" and len(args.name) <= 32):
        raise UserError(f"'{args.name}' is no name in RAPID: a letter, then letters, digits and _, up to 32")
    poses = _recorded(args, prompts) if args.poses is not None else _guided(args, prompts)
    try:
        result = teach(poses)
    except CalibrationError as error:
        raise UserError(str(error)) from None
    for line in result.lines:
        print(line)
    for warning in result.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    print(save(result, args.output, args.force))
    return 0


def _arm(name: str) -> Any:
    from daidalos.industry.robots import arm_named

    try:
        return arm_named(name)
    except ValueError as error:
        raise UserError(str(error)) from None


def _recorded(args: argparse.Namespace, prompts: Sequence[str]) -> list[np.ndarray]:
    """Return the flange's poses of targets that a module declares."""
    import numpy as np

    from daidalos.industry.motion.kinematics import forward
    from daidalos.industry.rapid.literals import parse_literals
    from daidalos.industry.rapid.runtime.arm_robot import matrix_of
    from daidalos.industry.rapid.sources import read_source
    from daidalos.industry.rapid.teaching import poses_of_source

    arm = _arm(args.robot)
    found = poses_of_source(read_source(args.poses))
    if len(found) != len(prompts):
        raise UserError(
            f"{args.poses}: declares {len(found)} targets, and {len(prompts)} are needed: {'; '.join(prompts)}"
        )
    poses = []
    for type_, text in found:
        (value,) = parse_literals(f"[{text}]")
        if type_ == "robtarget":
            poses.append(matrix_of([value[0], value[1]]))
        else:
            poses.append(np.asarray(forward(arm, np.radians(np.array(value[0], dtype=float)))))
    return poses


def _guided(args: argparse.Namespace, prompts: Sequence[str]) -> list[np.ndarray]:
    """Return the flange's poses that the arm has at each press of Enter."""
    import numpy as np

    from daidalos.industry.motion.kinematics import forward

    arm = _arm(args.robot)
    poses = []
    with _Joints(args.joint_states) as joints:
        for number, prompt in enumerate(prompts, 1):
            try:
                input(f"{number}/{len(prompts)} {prompt}, then press Enter: ")
            except EOFError:
                raise UserError("nobody has pressed Enter; nothing was written") from None
            angles = joints.present()
            poses.append(np.asarray(forward(arm, angles)))
            at = ", ".join(f"{one:.2f}" for one in np.degrees(angles))
            print(f"  axes at {at} deg")
    return poses


class _Joints:
    """The present angles of an arm, from a topic."""

    def __init__(self, topic: str) -> None:
        import rclpy
        from sensor_msgs.msg import JointState

        rclpy.init(args=[])
        self._topic = topic
        self._node = rclpy.create_node("rapid_calibration")
        self._message: Any = None
        self._node.create_subscription(JointState, topic, self._take, 1)

    def __enter__(self) -> _Joints:
        return self

    def __exit__(self, *_: object) -> None:
        import rclpy

        self._node.destroy_node()
        rclpy.try_shutdown()

    def _take(self, message: Any) -> None:
        self._message = message

    def present(self) -> np.ndarray:
        """Return angles (6,) [rad] of a message that comes from now on.

        Raises
        ------
        UserError
            Where none comes, or without the joints, or an angle is no number.
        """
        import numpy as np
        import rclpy

        self._message = None
        end = time.monotonic() + WAIT_S
        seen = 0
        while time.monotonic() < end:
            rclpy.spin_once(self._node, timeout_sec=0.1)
            if self._message is None:
                continue
            seen += 1
            angles = dict(zip(self._message.name, self._message.position, strict=False))
            self._message = None
            if seen < _FRESH:
                continue  # the first may have waited in the queue since before
            if not all(name in angles for name in JOINTS):
                raise UserError(f"{self._topic} has no joint_1 to joint_6, but {', '.join(angles) or 'nothing'}")
            found = np.array([angles[name] for name in JOINTS])
            if not np.isfinite(found).all():
                raise UserError(f"{self._topic} has an angle that is no number")
            return found
        raise UserError(f"waited {WAIT_S:g} s for {self._topic}; is the arm running?")


_FRESH = 2
