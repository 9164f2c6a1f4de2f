"""`ros2 topic hz`."""

from __future__ import annotations

import functools
import math
from argparse import ArgumentParser, Namespace
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2cli.qos import add_qos_arguments
from ros2topic.api import unsigned_int

from daidalos.cli.ros2.completion import complete_topics
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.topics import filter_function, spin, subscribe, topic_class

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.node import Node

DEFAULT_WINDOW_SIZE = 10000
_S = 1_000_000_000


class HzVerb(Verb):
    """Print the average receiving rate to screen."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(
            parser.add_argument("topic_name", nargs="+", help="Names of the ROS topic to listen to (e.g. '/chatter')")
        )
        add_qos_arguments(parser, "subscribe", "sensor_data")
        parser.add_argument(
            "--window",
            "-w",
            dest="window_size",
            type=unsigned_int,
            default=DEFAULT_WINDOW_SIZE,
            metavar="WINDOW",
            help=f"window size, in # of messages, for calculating rate (default: {DEFAULT_WINDOW_SIZE})",
        )
        parser.add_argument(
            "--filter",
            dest="filter_expr",
            metavar="EXPR",
            help="only measure messages matching the specified Python expression",
        )
        parser.add_argument(
            "--wall-time",
            dest="use_wtime",
            action="store_true",
            help="calculates rate using wall time which can be helpful when clock is not published during simulation",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the rates every second until Ctrl-C."""
        from rclpy.clock import Clock, ClockType

        accept = filter_function(args.filter_expr) if args.filter_expr else None
        with direct_node(args) as node:
            clock = Clock(clock_type=ClockType.STEADY_TIME) if args.use_wtime else node.get_clock()
            if len(args.topic_name) == 1:
                _measure_one(node, args, clock, accept)
            else:
                _measure_many(node, args, clock, accept)
            spin(node)
        return 0


@dataclass(frozen=True)
class Rate:
    """Statistics of the intervals between messages, in seconds; `rate` in hertz."""

    rate: float
    shortest: float
    longest: float
    deviation: float
    window: int

    def __str__(self) -> str:
        return (
            f"average rate: {self.rate:.3f}\n\tmin: {self.shortest:.3f}s max: {self.longest:.3f}s "
            f"std dev: {self.deviation:.5f}s window: {self.window}"
        )


class RateMeter:
    """Statistics of the rate of events.

    Parameters
    ----------
    window_size
        How many of the last intervals are looked at.
    """

    def __init__(self, window_size: int) -> None:
        self._intervals: deque[int] = deque(maxlen=max(window_size, 1))
        self._last: int | None = None

    def add(self, now_ns: int) -> bool:
        """Record an event; return False if the clock went back, which resets the statistics."""
        last, self._last = self._last, now_ns
        if last is not None and now_ns < last:
            self._intervals.clear()
            return False
        if last is not None:
            self._intervals.append(now_ns - last)
        return True

    def rate(self) -> Rate | None:
        """Return the statistics, None before the second event."""
        if not self._intervals:
            return None
        count = len(self._intervals)
        mean = sum(self._intervals) / count
        variance = sum((interval - mean) ** 2 for interval in self._intervals) / count
        return Rate(
            _S / mean if mean > 0 else 0.0,
            min(self._intervals) / _S,
            max(self._intervals) / _S,
            math.sqrt(variance) / _S,
            count,
        )


def _measure_one(node: Node, args: Namespace, clock: Clock, accept: Callable[[Any], bool] | None) -> None:
    """Print the rate of one topic at the first message at least a second after the last print."""
    meter = RateMeter(args.window_size)
    printed_at: int | None = None

    def on_message(message: Any) -> None:
        nonlocal printed_at
        if not _note(meter, clock, accept, message):
            printed_at = None
            return
        now = clock.now().nanoseconds
        if printed_at is None:
            printed_at = now
        elif now - printed_at >= _S:
            printed_at = now
            rate = meter.rate()
            if rate is not None:
                print(rate)

    _subscribe(node, args, args.topic_name[0], on_message, raw=accept is None)


def _measure_many(node: Node, args: Namespace, clock: Clock, accept: Callable[[Any], bool] | None) -> None:
    """Print a table of the rates of several topics every second."""
    meters = {topic: RateMeter(args.window_size) for topic in args.topic_name}
    for topic, meter in meters.items():
        on_message = functools.partial(_note, meter, clock, accept)
        _subscribe(node, args, topic, on_message, raw=accept is None)
        print(f"Subscribed to [{topic}]")

    def report() -> None:
        rates = {topic: meter.rate() for topic, meter in meters.items()}
        rows = [(topic, rate) for topic, rate in rates.items() if rate is not None]
        if rows:
            print(table(rows))

    node.create_timer(1.0, report, clock=clock)


def table(rows: list[tuple[str, Rate]]) -> str:
    """Return rates as a table; its lines end in a space, as scripts that read the original's table expect."""
    width = max(len("topic"), *(len(topic) for topic, _ in rows))
    columns = ("rate", "min_delta", "max_delta", "std_dev", "window")
    head = f"{'topic':>{width}}" + "".join(f"{name:>12}" for name in columns) + " "
    lines = [head, "=" * len(head)]
    for topic, one in rows:
        values = (f"{one.rate:.3f}", f"{one.shortest:.3f}", f"{one.longest:.3f}", f"{one.deviation:.5f}", one.window)
        lines.append(f"{topic:<{width}}" + "".join(f"{value:>12}" for value in values) + " ")
    return "\n".join(lines)


def _note(meter: RateMeter, clock: Clock, accept: Callable[[Any], bool] | None, message: Any) -> bool:
    """Count a message; return False if the clock went back."""
    if accept is not None and not accept(message):
        return True
    now = clock.now().nanoseconds
    if meter.add(now):
        return True
    print("time has reset, resetting counters")
    return False


def _subscribe(node: Node, args: Namespace, topic: str, on_message: Callable[[Any], Any], raw: bool) -> None:
    subscribe(node, args, topic, topic_class(node, topic, wait=True), on_message, raw=raw)
