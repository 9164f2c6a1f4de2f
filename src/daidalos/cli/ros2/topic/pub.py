"""`ros2 topic pub`."""

from __future__ import annotations

import sys
import time
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node
from ros2cli.qos import add_qos_arguments, qos_profile_from_short_keys
from ros2topic.api import positive_float, unsigned_int

from daidalos.cli.ros2.completion import complete_topics, complete_types, complete_values
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interfaces import fill, message_class, parse_values
from daidalos.cli.ros2.qos import requested_qos
from daidalos.cli.ros2.topics import spin
from daidalos.common.suggestions import hint_line

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher


class PubVerb(Verb):
    """Publish a message to a topic."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        complete_topics(parser.add_argument("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')"))
        complete_types(
            parser.add_argument("message_type", help="Type of the ROS message (e.g. 'std_msgs/String')"),
            "msg",
            "topic_name",
        )
        source = parser.add_mutually_exclusive_group()
        complete_values(
            source.add_argument(
                "values",
                nargs="?",
                default="{}",
                help='Values to fill the message with in YAML format (e.g. "data: Hello World"), otherwise the message '
                "will be published with default values",
            ),
            "message_type",
        )
        source.add_argument("--stdin", action="store_true", help="Read values from standard input")
        parser.add_argument(
            "-r", "--rate", metavar="N", type=positive_float, default=1.0, help="Publishing rate in Hz (default: 1)"
        )
        parser.add_argument(
            "-p",
            "--print",
            metavar="N",
            type=int,
            default=1,
            help="Only print every N-th published message (default: 1)",
        )
        count = parser.add_mutually_exclusive_group()
        count.add_argument("-1", "--once", action="store_true", help="Publish one message and exit")
        count.add_argument(
            "-t", "--times", type=unsigned_int, default=0, help="Publish this number of times and then exit"
        )
        parser.add_argument(
            "-w",
            "--wait-matching-subscriptions",
            type=unsigned_int,
            default=None,
            help='Wait until finding the specified number of matching subscriptions. Defaults to 1 when using "-1"/'
            '"--once"/"--times", otherwise defaults to 0.',
        )
        parser.add_argument(
            "--max-wait-time-secs",
            type=positive_float,
            default=None,
            help="This sets the maximum wait time in seconds if '--wait-matching-subscriptions', '--once' or "
            "'--times' is set. By default, this flag is not set meaning the subscriber will wait endlessly.",
        )
        parser.add_argument(
            "--keep-alive",
            metavar="N",
            type=_seconds,
            default=0.1,
            help="Keep publishing node alive for N seconds after the last msg (default: 0.1)",
        )
        parser.add_argument("-n", "--node-name", help="Name of the created publishing node")
        add_qos_arguments(parser, "publish", "default")

    def main(self, *, args: Namespace) -> Status:
        """Publish until Ctrl-C, or the requested number of times."""
        message_type = message_class(args.message_type)
        text = sys.stdin.read() if args.stdin else args.values
        values = parse_values(text)
        message = message_type()
        stampers = fill(message, values)
        times = 1 if args.once else args.times
        if args.max_wait_time_secs is not None and not times and args.wait_matching_subscriptions is None:
            raise CliError(
                "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
            )
        with direct_node(args, args.node_name) as node:
            publisher = node.create_publisher(
                message_type, args.topic_name, requested_qos(args) or qos_profile_from_short_keys("default")
            )
            wanted = args.wait_matching_subscriptions
            _wait_for_subscriptions(
                node, publisher, (1 if times else 0) if wanted is None else wanted, args.max_wait_time_secs
            )
            print("publisher: beginning loop")
            _publish(node, args, publisher, message, stampers, times)
            if times:
                time.sleep(args.keep_alive)
        return 0


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not value >= 0.0:
        raise ArgumentTypeError("value must be a number of seconds, not negative")
    return value


def _wait_for_subscriptions(node: Node, publisher: Publisher, wanted: int, limit_s: float | None) -> None:
    """Wait for a number of matching subscriptions, and report progress every second."""
    waited, step, hint = 0.0, 1.0, None
    while publisher.get_subscription_count() < wanted:
        if step >= 1.0:
            print(f"Waiting for at least {wanted} matching subscription(s)...")
        step = 1.0 if limit_s is None else min(1.0, limit_s - waited)
        if step <= 0:
            raise CliError(
                f"Timed out waiting for subscribers: Expected {wanted} subcribers but only got "
                f"{publisher.get_subscription_count()} subscribers"
            )
        node.handle.graph.wait_for(lambda: publisher.get_subscription_count() >= wanted, step)
        waited += step
        if hint is None and publisher.get_subscription_count() < wanted:
            hint = _mismatch_hint(node, publisher)
            sys.stderr.write(hint)


def _mismatch_hint(node: Node, publisher: Publisher) -> str:
    """Return a hint about subscriptions of another type, or of a similar topic; empty without any."""
    listened = {
        name: types
        for name, types in node.get_topic_names_and_types()
        if any(info.node_name != node.get_name() for info in node.get_subscriptions_info_by_topic(name))
    }
    others = {
        info.topic_type
        for info in node.get_subscriptions_info_by_topic(publisher.topic_name)
        if info.node_name != node.get_name()
    }
    if others:
        return f"'{publisher.topic_name}' is listened to as {' or '.join(sorted(others))}\n"
    return hint_line(publisher.topic_name, listened)


def _publish(node: Node, args: Namespace, publisher: Publisher, message: Any, stampers: list[Any], times: int) -> None:
    from rclpy.task import Future

    done = Future()
    count = 0

    def publish() -> None:
        nonlocal count
        if done.done():
            return
        count += 1
        now = node.get_clock().now().to_msg() if stampers else None
        for stamp in stampers:
            stamp(now)
        if args.print and count % args.print == 0:
            print(f"publishing #{count}: {message!r}\n")
        publisher.publish(message)
        if count == times:
            done.set_result(True)

    node.create_timer(1.0 / args.rate, publish)
    publish()
    spin(node, done)
