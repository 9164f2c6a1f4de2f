"""A graph of this process alone, and bags."""

from pathlib import Path

import pytest
from rclpy.serialization import serialize_message
from rosbag2_py import ConverterOptions, SequentialWriter, StorageOptions, TopicMetadata
from std_msgs.msg import String

from ros.graph import graph, node  # noqa: F401

SECOND = 1_000_000_000
CHATTER = TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr")


@pytest.fixture(params=["mcap", "sqlite3"])
def storage(request: pytest.FixtureRequest) -> str:
    return request.param


def write_chatter(folder: Path, count: int, storage: str = "mcap", period_ns: int = 10_000_000, **options) -> str:
    """Write a bag whose messages are numbers, from second 1 on."""
    writer = SequentialWriter()
    writer.open(StorageOptions(str(folder), storage, **options), ConverterOptions("", ""))
    writer.create_topic(CHATTER)
    for k in range(count):
        writer.write("/chatter", serialize_message(String(data=str(k))), SECOND + k * period_ns)
    writer.close()
    return str(folder)
