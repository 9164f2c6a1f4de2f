"""`tf2_echo`: prints the transform between two frames periodically."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node
from rclpy.time import Time

from daidalos.nodes.runner import UserError, program_arguments, run, run_program

_USAGE = """Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame.
Note: This is the transform to get data from target_frame into the source_frame.
Default echo rate is 1 if echo_rate is not given."""


class TransformEcho(Node):
    """Prints the newest transform that takes data from the target frame into the source frame."""

    def __init__(self, source: str, target: str, rate: float, **kwargs: Any) -> None:
        super().__init__("tf2_echo", **kwargs)
        from tf2_ros import Buffer, TransformListener

        self._frames = (source, target)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._was_there = False
        self.create_timer(1.0 / rate, self._echo)

    def _echo(self) -> None:
        from tf2_ros import TransformException

        source, target = self._frames
        if not self._was_there:
            self._was_there, problem = self._buffer.can_transform_core(source, target, Time())
            if not self._was_there:
                self.get_logger().info(f"Waiting for transform {source} ->  {target}: {problem}")
                return
        try:
            found = self._buffer.lookup_transform(source, target, Time())
        except TransformException as error:
            print(f"Failure at {self.get_clock().now().nanoseconds * 1e-9:f}")
            print(f"Exception thrown:{error}")
            print("The current list of frames is:")
            print(self._buffer.all_frames_as_string(), flush=True)
            return
        print("\n".join(_lines(found)), flush=True)


def _lines(found: Any) -> list[str]:
    from tf_transformations import euler_from_quaternion, quaternion_matrix

    stamp, move, turn = found.header.stamp, found.transform.translation, found.transform.rotation
    quaternion = [turn.x, turn.y, turn.z, turn.w]
    angles = euler_from_quaternion(quaternion)
    matrix = quaternion_matrix(quaternion)
    matrix[:3, 3] = move.x, move.y, move.z
    # A stamp of zero is that of a transform that is valid at all times.
    time = f"{stamp.sec}.{stamp.nanosec:09d}" if stamp.sec or stamp.nanosec else "0.0"
    return [
        f"At time {time}",
        f"- Translation: {_listed((move.x, move.y, move.z))}",
        f"- Rotation: in Quaternion {_listed(quaternion)}",
        f"- Rotation: in RPY (radian) {_listed(angles)}",
        f"- Rotation: in RPY (degree) {_listed(map(math.degrees, angles))}",
        "- Matrix:",
        *(" " + " ".join(f"{value:6.3f}" for value in row) for row in matrix),
    ]


def _listed(values: Any) -> str:
    return "[" + ", ".join(f"{value:.3f}" for value in values) + "]"


def _rate(words: list[str]) -> float:
    try:
        rate = float(words[2]) if len(words) > 2 else 1.0
    except ValueError:
        raise UserError(f"echo rate must be a number, not '{words[2]}'") from None
    if not 0.0 < rate < math.inf:
        raise UserError("Echo rate must be > 0.0")
    return rate


def main() -> int:
    """Run the node."""
    words = program_arguments()
    if len(words) not in (2, 3):
        print(_USAGE)
        return 0 if set(words) & {"-h", "--help"} else 255
    rates: list[float] = []
    return run_program(lambda: rates.append(_rate(words))) or run(lambda: TransformEcho(words[0], words[1], *rates))
