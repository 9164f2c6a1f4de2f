"""Description of a bag as printed by `ros2 bag info`."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from daidalos.bags.errors import BagError
from daidalos.bags.metadata import BagMetadata, TopicCount
from daidalos.bags.reader import BagReader

_INDENT = 19
_SECOND = 1_000_000_000
_EVENT_INFO = struct.Struct("<4xB3xiI16s4xq")
"""Header of CDR, then service_msgs/ServiceEventInfo: kind of event, stamp, client, number of the call."""
_REQUESTS, _RESPONSES = (0, 1), (2, 3)
"""Events of kinds SENT and RECEIVED: client and server may both publish events of the same call."""
_ORDERS: dict[str, Callable[[TopicCount], Any]] = {
    "name": lambda one: one.topic.name,
    "type": lambda one: (one.topic.type, one.topic.name),
    "count": lambda one: (-one.count, one.topic.name),
}


@dataclass
class Contents:
    """Totals of a bag's messages: bytes of each topic; requests and responses of each service's topic."""

    sizes: Counter[str] = field(default_factory=Counter)
    requests: Counter[str] = field(default_factory=Counter)
    responses: Counter[str] = field(default_factory=Counter)


def contents(bag: BagReader) -> Contents:
    """Read a bag through."""
    found = Contents()
    events = {name for name, topic in bag.topics.items() if topic.is_service_event}
    seen: set[tuple[str, bool, bytes, int]] = set()
    for message in bag.messages(by_file=True):
        found.sizes[message.topic] += len(message.data)
        if message.topic not in events:
            continue
        try:
            kind, _, _, client, number = _EVENT_INFO.unpack_from(message.data)
        except struct.error:
            raise BagError(bag.path, f"an event on {message.topic} is cut off") from None
        key = (message.topic, kind in _REQUESTS, client, number)
        if key not in seen:
            seen.add(key)
            (found.requests if kind in _REQUESTS else found.responses)[message.topic] += 1
    return found


def format_metadata(metadata: BagMetadata, size: int, *, sort: str = "name", contents: Contents | None = None) -> str:
    """Return what a bag holds as text; `size` in bytes, `contents` for the details."""
    topics = [one for one in metadata.topics if not one.topic.is_service_event]
    services = [one for one in metadata.topics if one.topic.is_service_event]
    duration = f"{metadata.duration_ns // _SECOND}.{metadata.duration_ns % _SECOND:09d}s"
    messages = metadata.message_count - sum(one.count for one in services)
    lines = [
        "",
        _field("Files", f"\n{' ' * _INDENT}".join(file.path for file in metadata.files)),
        _field("Bag size", format_size(size)),
        _field("Storage id", metadata.storage_id),
        _field("ROS Distro", metadata.ros_distro or "unknown"),
        _field("Duration", duration),
        _field("Start", format_time(metadata.start_ns)),
        _field("End", format_time(metadata.end_ns)),
        _field("Messages", str(messages)),
        "Topic information: " + _listing((_topic(one, contents) for one in ordered(topics, sort)), _INDENT),
        _field("Service", str(len(services))),
        "Service information: " + _listing((_service(one, contents) for one in ordered(services, sort)), _INDENT + 2),
    ]
    return "\n".join(lines)


def _field(name: str, value: str) -> str:
    return f"{name + ':':<{_INDENT}}{value}"


def _listing(entries: Iterable[str], indent: int) -> str:
    return ("\n" + " " * indent).join(entries)


def ordered(topics: Iterable[TopicCount], sort: str) -> list[TopicCount]:
    """Return topics by ``name``, ``type`` or ``count``."""
    return sorted(topics, key=_ORDERS[sort])


def _topic(one: TopicCount, contents: Contents | None) -> str:
    topic = one.topic
    size = f"Size Contribution: {format_size(contents.sizes[topic.name])} | " if contents else ""
    return (
        f"Topic: {topic.name} | Type: {topic.type} | Count: {one.count} | {size}"
        f"Serialization Format: {topic.serialization_format}"
    )


def _service(one: TopicCount, contents: Contents | None) -> str:
    topic = one.topic
    counts = f"Event Count: {one.count} | "
    if contents:
        counts = (
            f"Request Count: {contents.requests[topic.name]} | Response Count: {contents.responses[topic.name]} | "
            f"Size Contribution: {format_size(contents.sizes[topic.name])} | "
        )
    return (
        f"Service: {topic.service_name} | Type: {topic.service_type} | {counts}"
        f"Serialization Format: {topic.serialization_format}"
    )


def format_size(size: float) -> str:
    """Return a size in bytes as people read it."""
    units = ("B", "KiB", "MiB", "GiB", "TiB")
    index = 0
    while size >= 1024 and index < len(units) - 1:
        size /= 1024
        index += 1
    return f"{size:.{1 if index else 0}f} {units[index]}"


def format_time(nanoseconds: int) -> str:
    """Return a time as a date and as a number of seconds."""
    seconds, rest = divmod(nanoseconds, _SECOND)
    try:
        moment = datetime.fromtimestamp(seconds)
        date = f"{moment:%b} {moment.day:2} {moment:%Y %H:%M:%S}"
    except (OverflowError, ValueError, OSError):
        date = "beyond the calendar"
    return f"{date}.{rest:09d} ({seconds}.{rest:09d})"
