"""`ros2 topic bw`."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from collections import deque

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2cli.qos import add_qos_arguments

from daidalos.cli.ros2.completion import complete_topics
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.topics import add_window_argument, spin, subscribe, topic_class

DEFAULT_WINDOW_SIZE = 100


class BwVerb(Verb):
    """Display bandwidth used by topic."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(
            parser.add_argument("topic", metavar="topic_name", help="Topic name to monitor for bandwidth utilization")
        )
        add_qos_arguments(parser, "subscribe", "sensor_data")
        add_window_argument(parser, DEFAULT_WINDOW_SIZE, "maximum window size, in # of messages, for calculating rate")

    def main(self, *, args: Namespace) -> Status:
        """Print the bandwidth every second until Ctrl-C."""
        from rclpy.clock import Clock, ClockType

        meter = BandwidthMeter(args.window)
        with direct_node(args) as node:
            message_type = topic_class(node, args.topic, wait=True)

            def report() -> None:
                text = meter.report(time.monotonic())
                if text:
                    print(text)

            subscribe(
                node, args, args.topic, message_type, lambda data: meter.add(time.monotonic(), len(data)), raw=True
            )
            print(f"Subscribed to [{args.topic}]")
            node.create_timer(1.0, report, clock=Clock(clock_type=ClockType.STEADY_TIME))
            spin(node)
        return 0


class BandwidthMeter:
    """Statistics of the received data over the last `window_size` messages."""

    def __init__(self, window_size: int) -> None:
        self._messages: deque[tuple[float, int]] = deque(maxlen=window_size)

    def add(self, now_s: float, size: int) -> None:
        """Record a message of `size` bytes."""
        self._messages.append((now_s, size))

    def report(self, now_s: float) -> str:
        """Return the text to print; empty before the second message."""
        if len(self._messages) < 2:
            return ""
        sizes = [size for _, size in self._messages]
        rate = sum(sizes) / max(now_s - self._messages[0][0], 1e-9)
        # One unit for all numbers, chosen by the largest, is easier to compare.
        unit, divisor, digits = next(entry for entry in _UNITS if rate >= entry[1] or entry[1] == 1)
        mean, least, most = (
            f"{value / divisor:.{digits}f} {unit}" for value in (sum(sizes) / len(sizes), min(sizes), max(sizes))
        )
        return (
            f"{rate / divisor:.{digits}f} {unit}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {mean} min: {least} max: {most}"
        )


_UNITS = (("MB", 1_000_000, 2), ("KB", 1000, 2), ("B", 1, 0))
