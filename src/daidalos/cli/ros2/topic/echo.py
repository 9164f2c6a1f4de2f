"""`ros2 topic echo`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2cli.qos import add_qos_arguments
from ros2topic.api import positive_float, unsigned_int

from daidalos.cli.ros2.completion import complete_topics, complete_types
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.topics import Field, filter_function, spin, subscribe, topic_class

if TYPE_CHECKING:
    from rclpy.node import Node

DEFAULT_TRUNCATE_LENGTH = 128
_INFO_KEYS = (
    "source_timestamp",
    "received_timestamp",
    "publication_sequence_number",
    "reception_sequence_number",
)
_CLEAR = "\x1b[2J\x1b[H"


class EchoVerb(Verb):
    """Output messages from a topic."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')"))
        complete_types(
            parser.add_argument("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')"),
            "msg",
            "topic_name",
        )
        add_qos_arguments(parser, "subscribe", "sensor_data")
        add_format_arguments(parser)
        parser.add_argument("--no-lost-messages", action="store_true", help="Don't report when a message is lost")
        parser.add_argument("--raw", action="store_true", help="Echo the raw binary representation")
        parser.add_argument(
            "--filter",
            dest="filter_expr",
            metavar="FILTER_EXPR",
            help="Python expression to filter messages that are printed. Expression can use Python builtins as well as "
            "m (the message).",
        )
        parser.add_argument("--once", action="store_true", help="Print the first message received and then exit.")
        parser.add_argument(
            "--timeout", metavar="N", type=positive_float, help="Set a timeout in seconds waiting for messages"
        )
        parser.add_argument(
            "--include-message-info", "-i", action="store_true", help="Shows the associated message info."
        )
        parser.add_argument("--clear", "-c", action="store_true", help="Clear screen before printing next message")
        parser.add_argument("--node-name", "-n", help="The name of the echoing node; by default, will be a hidden node")

    def main(self, *, args: Namespace) -> Status:
        """Print messages until Ctrl-C, the first one with ``--once``, or the timeout."""
        show = _printer(args)
        accept = filter_function(args.filter_expr) if args.filter_expr else None
        with direct_node(args, args.node_name) as node:
            message_type = topic_class(node, args.topic_name, args.message_type)
            _listen(node, args, message_type, show, accept)
        return 0


def add_format_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of the output format."""
    parser.add_argument(
        "--csv", action="store_true", help="Output all recursive fields separated by commas (e.g. for plotting)"
    )
    parser.add_argument(
        "--field",
        action="append",
        metavar="FIELD",
        help="Echo a selected field of a message. Use '.' to select sub-fields. For example, to echo the position "
        "field of a nav_msgs/msg/Odometry message: 'ros2 topic echo /odom --field pose.pose.position'. Use the option "
        "several times to echo several fields.",
    )
    add_length_arguments(parser)


def add_length_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of the output length."""
    parser.add_argument(
        "--full-length",
        "-f",
        action="store_true",
        help="Output all elements for arrays, bytes, and string with a length > '--truncate-length', by default they "
        "are truncated after '--truncate-length' elements with '...''",
    )
    parser.add_argument(
        "--truncate-length",
        "-l",
        type=unsigned_int,
        default=DEFAULT_TRUNCATE_LENGTH,
        help=f"The length to truncate arrays, bytes, and string to (default: {DEFAULT_TRUNCATE_LENGTH})",
    )
    parser.add_argument("--no-arr", action="store_true", help="Don't print array fields of messages")
    parser.add_argument("--no-str", action="store_true", help="Don't print string fields of messages")
    parser.add_argument(
        "--flow-style", action="store_true", help="Print collections in the block style (not available with csv format)"
    )


def _listen(
    node: Node,
    args: Namespace,
    message_type: Any,
    show: Callable[[Any, Any], None],
    accept: Callable[[Any], bool] | None,
) -> None:
    from rclpy.task import Future

    done = Future()
    losses = Losses()

    def on_message(message: Any, info: Any) -> None:
        if not args.no_lost_messages:
            losses.note(info)
        if done.done() or (accept is not None and not accept(message)):
            return
        show(message, info)
        if args.once:
            done.set_result(True)

    subscribe(node, args, args.topic_name, message_type, on_message, raw=args.raw)
    spin(node, done, args.timeout)


class Losses:
    """Detector of lost messages by the publishers' sequence numbers."""

    def __init__(self) -> None:
        self._last: dict[bytes, int] = {}
        self._total = 0

    def note(self, info: Any) -> int:
        """Record a message's info; return the number of lost messages before it, and report them on standard error."""
        number, publisher = info["publication_sequence_number"], info["publisher_gid"]
        if number is None or publisher is None:
            return 0
        last = self._last.get(publisher["data"], number - 1)
        self._last[publisher["data"]] = max(number, last)
        lost: int = max(number - last - 1, 0)
        if lost:
            self._total += lost
            print(f"A message was lost!!!\n\ttotal count change:{lost}\n\ttotal count: {self._total}", file=sys.stderr)
        return lost


def _printer(args: Namespace) -> Callable[[Any, Any], None]:
    """Return a function that prints a message with its info in the format of the options."""
    fields = [Field(path) for path in args.field or ()]
    text = csv_text if args.csv else yaml_text

    def show(message: Any, info: Any) -> None:
        parts = [field.of(message) for field in fields] if fields and not args.raw else [message]
        shown = text(args, parts)
        if args.include_message_info:
            shown = _with_info(args, info, shown)
        sys.stdout.write(f"{_CLEAR if args.clear else ''}{shown}")

    return show


def yaml_text(args: Namespace, parts: list[Any]) -> str:
    """Return messages or values as YAML documents that end with three dashes."""
    from rosidl_runtime_py import message_to_yaml

    def shown(part: Any) -> str:
        if not hasattr(part, "get_fields_and_field_types"):
            return f"{part}\n"
        text: str = message_to_yaml(
            part,
            truncate_length=None if args.full_length else args.truncate_length,
            no_arr=args.no_arr,
            no_str=args.no_str,
            flow_style=args.flow_style,
        )
        return text

    return "".join(map(shown, parts)) + "---\n"


def csv_text(args: Namespace, parts: list[Any]) -> str:
    """Return messages or values as one line, separated by commas."""
    from rosidl_runtime_py import message_to_csv

    def shown(part: Any) -> str:
        if not hasattr(part, "get_fields_and_field_types"):
            return str(part)
        text: str = message_to_csv(
            part,
            truncate_length=None if args.full_length else args.truncate_length,
            no_arr=args.no_arr,
            no_str=args.no_str,
        )
        return text

    return ",".join(map(shown, parts)) + "\n"


def _with_info(args: Namespace, info: Any, shown: str) -> str:
    import yaml

    values = {key: info[key] for key in _INFO_KEYS}
    if args.csv:
        return f"{','.join(str(value) for value in values.values())},{shown}"
    return f"{yaml.safe_dump(values)}---\n{shown}"
