"""`daidalos diff`: comparison of two bags."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.bags.compare import Difference
    from daidalos.bags.message import BagMessage
    from daidalos.bags.reader import BagReader

EPILOG = """The exit status is 0 when the bags hold the same messages on the same topics, 1 when not, and 2 when one
cannot be read. For every topic that differs its first difference is printed, the earliest first."""

_MAX_FIELDS = 8
_WORDS = {
    "missing": "the second bag has no message more",
    "added": "the first bag has no message more",
    "time": "the same message at another time",
    "type": "another type",
}


class DiffVerb:
    """Compare two bags, message by message."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos diff`."""
        parser.epilog = EPILOG
        parser.add_argument("first", type=Path, help="bag: a folder, an .mcap or a .db3 file")
        parser.add_argument("second", type=Path, help="the other one")
        parser.add_argument("--topics", nargs="+", metavar="TOPIC", help="compare only these (default: all)")
        parser.add_argument("--ignore-times", action="store_true", help="compare contents and their order only")
        parser.add_argument("--json", action="store_true", help="print one JSON object")

    def main(self, *, args: argparse.Namespace) -> int:
        """Compare; return 0 when the bags are alike, 1 when not, 2 for a bag that cannot be read."""
        from daidalos.bags.compare import differences
        from daidalos.bags.errors import BagError
        from daidalos.bags.reader import BagReader

        try:
            with BagReader(args.first) as first, BagReader(args.second) as second:
                for topic in args.topics or ():
                    if topic not in first.topics and topic not in second.topics:
                        print(f"error: {_unknown(topic, first, second)}", file=sys.stderr)
                        return 2
                found = differences(first, second, args.topics, times=not args.ignore_times)
                reports = [_report(one, first, second) for one in found]
                count = first.metadata.message_count
        except BagError as error:
            print(f"error: {error}", file=sys.stderr)
            return 2
        if args.json:
            print(json.dumps({"alike": not reports, "messages": count, "differences": reports}, indent=2))
        elif not reports:
            print(f"alike: {count} messages")
        else:
            for report in reports:
                _print(report)
        return 1 if reports else 0


def _unknown(topic: str, first: BagReader, second: BagReader) -> str:
    from daidalos.common.suggestions import did_you_mean

    return f"neither bag has the topic '{topic}'{did_you_mean(topic, [*first.topics, *second.topics])}"


def _report(difference: Difference, first: BagReader, second: BagReader) -> dict[str, Any]:
    """Return a difference as plain data."""
    topic = first.topics.get(difference.topic) or second.topics[difference.topic]
    pairs = ((difference.first, first), (difference.second, second))
    times = [None if one is None else 1e-9 * (one.received_ns - bag.metadata.start_ns) for one, bag in pairs]
    report: dict[str, Any] = {
        "topic": difference.topic,
        "type": topic.type,
        "message": difference.number,
        "what": difference.what,
        "times_s": times,
    }
    if difference.what == "type":
        report["types"] = [first.topics[difference.topic].type, second.topics[difference.topic].type]
    if difference.what == "data" and difference.first is not None and difference.second is not None:
        report["fields"] = _fields(topic.type, difference.first, difference.second)
    return report


def _fields(type_name: str, first: BagMessage, second: BagMessage) -> list[list[Any]]:
    """Return the fields that differ, with both values; nothing for types that are not installed."""
    from rclpy.serialization import deserialize_message
    from rosidl_runtime_py import message_to_ordereddict
    from rosidl_runtime_py.utilities import get_message

    try:
        kind = get_message(type_name)
    except (ImportError, AttributeError, ValueError):
        return []
    one, other = (message_to_ordereddict(deserialize_message(message.data, kind)) for message in (first, second))
    found: list[list[Any]] = []
    _compare("", one, other, found)
    return found


def _compare(name: str, one: Any, other: Any, found: list[list[Any]]) -> None:
    if isinstance(one, dict):
        for key in one:
            _compare(f"{name}.{key}" if name else key, one[key], other[key], found)
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for index, (a, b) in enumerate(zip(one, other, strict=True)):
            _compare(f"{name}[{index}]", a, b, found)
    elif repr(one) != repr(other):  # NaN is equal to NaN here
        found.append([name, one, other])


def _print(report: dict[str, Any]) -> None:
    when = next((f"{time:.6f} s" for time in report["times_s"] if time is not None), "")
    print(f"{report['topic']} [{report['type']}] message {report['message']}{f' at {when}' if when else ''}:")
    if report["what"] == "data":
        fields = report["fields"]
        for name, one, other in fields[:_MAX_FIELDS]:
            print(f"  {name}: {_short(one)} -> {_short(other)}")
        if len(fields) > _MAX_FIELDS:
            print(f"  and {len(fields) - _MAX_FIELDS} more fields")
        if not fields:
            print("  other bytes")
    elif report["what"] == "time":
        print(f"  {_WORDS['time']}: {report['times_s'][0]:.9f} s -> {report['times_s'][1]:.9f} s")
    elif report["what"] == "type":
        print(f"  {_WORDS['type']}: {report['types'][0]} -> {report['types'][1]}")
    else:
        print(f"  {_WORDS[report['what']]}")


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
