"""`tf2_monitor`: prints the rates and delays of frames."""

from __future__ import annotations

from collections import deque
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time

from daidalos.common.documents import parse_yaml
from daidalos.nodes.runner import UserError, program_arguments, run, run_program

_GATHER_S = 10.0
_KEPT = 1000
_AUTHORITY = "<no authority available>"
_USAGE = """TF_Monitor: usage
  tf2_monitor                              Monitor all frames
  tf2_monitor <source_frame> <target_frame>   Monitor a specific chain"""


class _Delays:
    """Latest delays of a frame or publisher, with their times."""

    def __init__(self) -> None:
        self.delays: deque[float] = deque(maxlen=_KEPT)
        self.times: deque[float] = deque(maxlen=_KEPT)

    def note(self, delay_s: float, now_s: float) -> None:
        self.delays.append(delay_s)
        self.times.append(now_s)

    @property
    def average(self) -> float:
        return sum(self.delays) / len(self.delays) if self.delays else 0.0

    @property
    def most(self) -> float:
        return max(self.delays, default=0.0)

    @property
    def rate(self) -> float:
        span = self.times[-1] - self.times[0] if len(self.times) > 1 else 0.0
        return (len(self.times) - 1) / span if span > 0.0 else 0.0


class TransformMonitor(Node):
    """Node that collects transforms for ten seconds, prints statistics, and continues."""

    def __init__(self, chain: tuple[str, str] | None, **kwargs: Any) -> None:
        super().__init__("tf2_monitor", **kwargs)
        from tf2_msgs.msg import TFMessage
        from tf2_ros import Buffer

        self._chain = chain
        self._buffer = Buffer(node=self)
        self._frames: dict[str, _Delays] = {}
        self._all = _Delays()
        self._net = _Delays()
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, "/tf", self._receive, 100)
        self.create_subscription(TFMessage, "/tf_static", self._receive_static, latched)
        self.create_timer(_GATHER_S, self._report)
        if chain is None:
            print("Gathering data on all frames for 10 seconds...", flush=True)
        else:
            print(f"Waiting for transform chain to become available between {chain[0]} and {chain[1]} ", flush=True)

    def _receive(self, message: Any) -> None:
        self._note(message.transforms, fixed=False)

    def _receive_static(self, message: Any) -> None:
        self._note(message.transforms, fixed=True)

    def _note(self, transforms: list[Any], *, fixed: bool) -> None:
        take = self._buffer.set_transform_static if fixed else self._buffer.set_transform
        now_s = self._now_s()
        delay_s = 0.0
        for transform in transforms:
            take(transform, _AUTHORITY)
            # What holds for ever is never late.
            delay_s = 0.0 if fixed else now_s - _seconds(transform.header.stamp)
            self._frames.setdefault(transform.child_frame_id, _Delays()).note(delay_s, now_s)
        if transforms:
            self._all.note(delay_s, now_s)
        self._note_chain(now_s)

    def _note_chain(self, now_s: float) -> None:
        from tf2_ros import TransformException

        if self._chain is None:
            return
        try:
            stamp = self._buffer.get_latest_common_time(*self._chain)
        except TransformException:
            return
        # A chain of fixed transforms has no stamp.
        self._net.note(now_s - stamp.nanoseconds * 1e-9 if stamp.nanoseconds else 0.0, now_s)

    def _report(self) -> None:
        frames = self._frames
        if self._chain is None:
            print("\n\n\nRESULTS: for all Frames")
        else:
            source, target = self._chain
            found, problem = self._buffer.can_transform_core(source, target, Time())
            if not found:
                self.get_logger().info(f"Waiting for transform {source} ->  {target}: {problem}")
                return
            chain = self._frames_of_chain(source, target)
            frames = {name: delays for name, delays in frames.items() if name in chain}
            print(f"\n\n\nRESULTS: for {source} to {target}")
            print(f"Chain is: {' -> '.join(chain)}")
            print(f"Net delay     avg = {self._net.average:g}: max = {self._net.most:g}")
        print("\nFrames:")
        for name, delays in sorted(frames.items()):
            rate = f", {delays.rate:g} Hz" if self._chain is not None else ""
            late = f"Average Delay: {delays.average:g}, Max Delay: {delays.most:g}"
            print(f"Frame: {name}, published by {_AUTHORITY}{rate}, {late}")
        print("\nAll Broadcasters:")
        print(
            f"Node: {_AUTHORITY} {self._all.rate:g} Hz, Average Delay: {self._all.average:g} "
            f"Max Delay: {self._all.most:g}",
            flush=True,
        )

    def _frames_of_chain(self, source: str, target: str) -> list[str]:
        """Return the frames on the way from one to the other."""
        import yaml

        tree = parse_yaml(self._buffer.all_frames_as_yaml(), "the frames", yaml.BaseLoader)  # names stay text

        def to_root(frame: str) -> list[str]:
            way = [frame]
            while way[-1] in tree:
                way.append(tree[way[-1]]["parent"])
            return way

        up, down = to_root(source), to_root(target)
        meeting = next(frame for frame in up if frame in down)
        return [*up[: up.index(meeting) + 1], *reversed(down[: down.index(meeting)])]

    def _now_s(self) -> float:
        return float(self.get_clock().now().nanoseconds) * 1e-9


def _seconds(stamp: Any) -> float:
    return float(stamp.sec) + float(stamp.nanosec) * 1e-9


def main() -> int:
    """Run the node."""
    words = program_arguments()

    def check() -> None:
        if len(words) not in (0, 2):
            raise UserError(_USAGE)

    return run_program(check) or run(lambda: TransformMonitor((words[0], words[1]) if words else None))
