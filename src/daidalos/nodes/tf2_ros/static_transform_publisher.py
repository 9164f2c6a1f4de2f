"""`static_transform_publisher`: publishes one static transform."""

from __future__ import annotations

import argparse
import random
import string
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from rclpy.node import Node

from daidalos.common.parameters import Parameters, group, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import UserError, program_arguments, run, run_program

_DESCRIPTION = """A command line utility for manually sending a static transform. If no translation or orientation is
provided, the identity transform will be published. The translation offsets are in meters. The rotation may be
provided with roll, pitch, yaw euler angles in radians, or as a quaternion."""
_TRANSLATION = ("x", "y", "z")
_QUATERNION = ("qx", "qy", "qz", "qw")
_ANGLES = ("roll", "pitch", "yaw")
_FRAMES = ("frame-id", "child-frame-id")
_OLD_ORDERS = {
    8: (*_TRANSLATION, "yaw", "pitch", "roll", *_FRAMES),
    9: (*_TRANSLATION, *_QUATERNION, *_FRAMES),
}


@dataclass(frozen=True)
class TranslationParameters(Parameters):
    """Translation of a transform."""

    x: float = parameter(0.0, "Translation along x.", unit="m")
    y: float = parameter(0.0, "Translation along y.", unit="m")
    z: float = parameter(0.0, "Translation along z.", unit="m")


@dataclass(frozen=True)
class RotationParameters(Parameters):
    """Rotation of a transform."""

    x: float = parameter(0.0, "Component x of the rotation's quaternion.")
    y: float = parameter(0.0, "Component y of the rotation's quaternion.")
    z: float = parameter(0.0, "Component z of the rotation's quaternion.")
    w: float = parameter(1.0, "Component w of the rotation's quaternion.")


@dataclass(frozen=True)
class StaticTransformParameters(Parameters):
    """Parameters of ``static_transform_publisher``."""

    translation: TranslationParameters = group(TranslationParameters)
    rotation: RotationParameters = group(RotationParameters)
    frame_id: str = parameter("/frame", "Parent frame.")
    child_frame_id: str = parameter("/child", "Child frame.")


class StaticTransformBroadcasterNode(Node):
    """Node that publishes the static transform of its parameters on ``/tf_static``.

    Raises
    ------
    UserError
        When a frame is missing, or both are the same.
    """

    def __init__(self, node_name: str = "static_transform_publisher", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
        from std_msgs.msg import Header
        from tf2_ros import StaticTransformBroadcaster

        settings = declare(self, StaticTransformParameters)
        translation, rotation = settings.translation, settings.rotation
        frame, child = settings.frame_id, settings.child_frame_id
        if frame == child:
            raise UserError(f"cannot publish static transform from '{frame}' to '{child}', exiting")
        self._broadcaster = StaticTransformBroadcaster(self)
        self._broadcaster.sendTransform(
            TransformStamped(
                header=Header(stamp=self.get_clock().now().to_msg(), frame_id=frame),
                child_frame_id=child,
                transform=Transform(translation=Vector3(**vars(translation)), rotation=Quaternion(**vars(rotation))),
            )
        )
        self.get_logger().info(
            "Spinning until stopped - publishing transform\n"
            f"translation: ('{translation.x:f}', '{translation.y:f}', '{translation.z:f}')\n"
            f"rotation: ('{rotation.x:f}', '{rotation.y:f}', '{rotation.z:f}', '{rotation.w:f}')\n"
            f"from '{frame}' to '{child}'"
        )


def parse(arguments: Sequence[str]) -> dict[str, Any]:
    """Return the parameters of the node that a command line means, in the new style or in the old one.

    Raises
    ------
    UserError
        When the old style is used with words that are not numbers.
    """
    if len(arguments) in _OLD_ORDERS and not any(word.startswith("--") for word in arguments):
        print("[WARN] []: Old-style arguments are deprecated; see --help for new-style arguments", file=sys.stderr)
        return _parameters(dict(zip(_OLD_ORDERS[len(arguments)], arguments, strict=True)))
    parser = _Parser(prog="static_transform_publisher", description=_DESCRIPTION)
    for name in _TRANSLATION:
        parser.add_argument(f"--{name}", help=f"{name} component of translation", default=0.0)
    for name in _QUATERNION:
        parser.add_argument(f"--{name}", help=f"{name[1]} component of quaternion rotation")
    for name in _ANGLES:
        parser.add_argument(f"--{name}", help=f"{name} component Euler rotation")
    parser.add_argument("--frame-id", required=True, help="parent frame")
    parser.add_argument("--child-frame-id", required=True, help="child frame id")
    given = {name.replace("_", "-"): value for name, value in vars(parser.parse_args(_joined(arguments))).items()}
    if any(given[name] is not None for name in _QUATERNION) and any(given[name] is not None for name in _ANGLES):
        parser.error("a rotation is given by roll, pitch and yaw or by a quaternion, not by both")
    return _parameters({name: value for name, value in given.items() if value is not None})


class _Parser(argparse.ArgumentParser):
    """Parser that ends the process as the original program does, with status 255."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(255, f"{self.prog}: error: {message}\n")


def _joined(arguments: Sequence[str]) -> list[str]:
    """Join options with their values, so that ``-1e-3`` is a number and no option."""
    joined: list[str] = []
    words = iter(arguments)
    for word in words:
        takes_value = word.startswith("--") and "=" not in word and word != "--help"
        value = next(words, None) if takes_value else None
        joined.append(word if value is None else f"{word}={value}")
    return joined


def _parameters(given: dict[str, Any]) -> dict[str, Any]:
    from tf_transformations import quaternion_from_euler

    numbers = {name: _number(name, value) for name, value in given.items() if name not in _FRAMES}
    if any(name in numbers for name in _ANGLES):
        roll, pitch, yaw = (numbers.get(name, 0.0) for name in _ANGLES)
        rotation = [float(each) for each in quaternion_from_euler(roll, pitch, yaw)]
    else:
        has_rotation = any(name in numbers for name in _QUATERNION)
        rotation = [numbers.get(name, 0.0 if has_rotation or name != "qw" else 1.0) for name in _QUATERNION]
    return {
        **{f"translation.{axis}": numbers.get(axis, 0.0) for axis in _TRANSLATION},
        **{f"rotation.{name[1]}": value for name, value in zip(_QUATERNION, rotation, strict=True)},
        "frame_id": given["frame-id"],
        "child_frame_id": given["child-frame-id"],
    }


def _number(name: str, text: Any) -> float:
    try:
        return float(text)
    except ValueError:
        raise UserError(f"{name} must be a number, not '{text}'") from None


def main() -> int:
    """Run the node."""
    parameters: dict[str, Any] = {}

    def read() -> None:
        parameters.update(parse(program_arguments()))

    def make() -> StaticTransformBroadcasterNode:
        from rclpy.parameter import Parameter

        overrides: list[Any] = [Parameter(name, value=value) for name, value in parameters.items()]
        ending = "".join(random.choices(string.ascii_letters + string.digits, k=16))
        return StaticTransformBroadcasterNode(f"static_transform_publisher_{ending}", parameter_overrides=overrides)

    return run_program(read) or run(make)
