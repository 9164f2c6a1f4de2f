"""`ros2 topic delay`."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace
from collections import deque
from typing import Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2cli.qos import add_qos_arguments

from daidalos.cli.ros2.completion import complete_topics
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.topics import add_window_argument, spin, subscribe, topic_class

DEFAULT_WINDOW_SIZE = 10000
_S = 1_000_000_000


class DelayVerb(Verb):
    """Display delay of topic from timestamp in header."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(
            parser.add_argument("topic", metavar="topic_name", help="Topic name to calculate the delay for")
        )
        add_qos_arguments(parser, "subscribe", "sensor_data")
        add_window_argument(
            parser, DEFAULT_WINDOW_SIZE, "window size, in # of messages, for calculating rate, string to"
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the delay every second until Ctrl-C."""
        meter = DelayMeter(args.window)
        with direct_node(args) as node:
            message_type = topic_class(node, args.topic, wait=True)
            if "header" not in message_type.get_fields_and_field_types():
                raise CliError("msg does not have header")
            clock = node.get_clock()

            def on_message(message: Any) -> None:
                stamp = message.header.stamp
                meter.add(clock.now().nanoseconds, stamp.sec * _S + stamp.nanosec)

            def report() -> None:
                text = meter.report()
                if text:
                    print(text)

            subscribe(node, args, args.topic, message_type, on_message)
            node.create_timer(1.0, report)
            spin(node)
        return 0


class DelayMeter:
    """Statistics of the age of messages at reception over the last `window_size` messages."""

    def __init__(self, window_size: int) -> None:
        self._delays: deque[float] = deque(maxlen=window_size)
        self._new = False

    def add(self, now_ns: int, stamp_ns: int) -> None:
        """Record a message."""
        self._delays.append((now_ns - stamp_ns) / _S)
        self._new = True

    def report(self) -> str:
        """Return the text to print; empty without new messages."""
        if not self._new:
            return ""
        self._new = False
        count = len(self._delays)
        mean = sum(self._delays) / count
        deviation = math.sqrt(sum((delay - mean) ** 2 for delay in self._delays) / count)
        return (
            f"average delay: {mean:.3f}\n\tmin: {min(self._delays):.3f}s max: {max(self._delays):.3f}s "
            f"std dev: {deviation:.5f}s window: {count}"
        )
