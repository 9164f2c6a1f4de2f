"""`ros2 doctor hello`."""

from __future__ import annotations

import os
import select
import socket
import time
from argparse import ArgumentParser, Namespace
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node
from ros2multicast.api import DEFAULT_GROUP, DEFAULT_PORT, hops, open_receiver, receive_from, send
from ros2topic.api import positive_float

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb

_TOPIC = "/canyouhearme"


class HelloVerb(Verb):
    """Check network connectivity between multiple hosts."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        parser.add_argument(
            "-t", "--topic", default=_TOPIC, help=f"Name of ROS topic to publish to (default: {_TOPIC})"
        )
        parser.add_argument(
            "-ep",
            "--emit-period",
            metavar="N",
            type=positive_float,
            default=0.1,
            help="Time period to publish/send one message (default: 0.1s)",
        )
        parser.add_argument(
            "-pp",
            "--print-period",
            metavar="N",
            type=positive_float,
            default=1.0,
            help="Time period to print summary table (default: 1.0s)",
        )
        parser.add_argument("--ttl", type=hops, help="TTL for multicast send (default: None)")
        parser.add_argument(
            "-1", "--once", action="store_true", help="Publish and multicast send for one emit period then exit."
        )

    def main(self, *, args: Namespace) -> Status:
        """Send on a topic and by multicast, and count received messages."""
        from std_msgs.msg import String

        name = f"{socket.gethostname()}_{os.getpid()}"
        summary = Summary(args.topic)
        with direct_node(args) as node, _receiver() as receiver:
            publisher = node.create_publisher(String, args.topic, 10)

            def on_message(message: Any) -> None:
                summary.subscribed[_sender(message.data)] += 1

            node.create_subscription(String, args.topic, on_message, 10)

            def greet() -> None:
                text = f"hello, it's me {name}"
                publisher.publish(String(data=text))
                summary.published += 1
                send(text.encode(), ttl=args.ttl)
                summary.sent += 1

            _run(node, args, summary, receiver, greet)
        return 0


@dataclass
class Summary:
    """Messages sent, and messages received by sender, since the last print."""

    topic: str
    published: int = 0
    sent: int = 0
    subscribed: Counter[str] = field(default_factory=Counter)
    received: Counter[str] = field(default_factory=Counter)

    def text(self) -> str:
        """Return the summary as text."""
        lines = ["MULTIMACHINE COMMUNICATION SUMMARY", f"Topic: {self.topic}, Published Msg Count: {self.published}"]
        lines += ["Subscribed from:", *_rows(self.subscribed)]
        lines += [f"Multicast Group/Port: {DEFAULT_GROUP}/{DEFAULT_PORT}, Sent Msg Count: {self.sent}"]
        lines += ["Received from:", *_rows(self.received)]
        return "\n".join(["", *lines, "-" * 60])

    def reset(self) -> None:
        """Reset the counters."""
        self.published = self.sent = 0
        self.subscribed.clear()
        self.received.clear()


def _rows(counts: Counter[str]) -> list[str]:
    return [f"    Host {host}: {count}" for host, count in sorted(counts.items())] or ["    nobody"]


def _sender(text: str) -> str:
    return text.rpartition(" ")[2].rpartition("_")[0]


def _receiver() -> socket.socket:
    try:
        return open_receiver()
    except OSError as error:
        raise CliError(f"{DEFAULT_GROUP}:{DEFAULT_PORT} cannot be listened to: {error.strerror}") from None


def _run(node: Any, args: Namespace, summary: Summary, receiver: socket.socket, greet: Any) -> None:
    """Send and receive until Ctrl-C, or for one period."""
    from rclpy.executors import SingleThreadedExecutor

    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    print_at = time.monotonic() + args.print_period
    while True:
        try:
            greet()
        except OSError as error:
            raise CliError(f"Nothing can be sent by multicast: {error.strerror}") from None
        emit_at = time.monotonic() + args.emit_period
        while (left := emit_at - time.monotonic()) > 0:
            executor.spin_once(timeout_sec=min(left, 0.02))
            while select.select([receiver], [], [], 0)[0]:
                data, _ = receive_from(receiver)
                summary.received[_sender(data.decode(errors="replace"))] += 1
        if args.once or time.monotonic() >= print_at:
            print(summary.text())
            summary.reset()
            print_at = time.monotonic() + args.print_period
        if args.once:
            return
