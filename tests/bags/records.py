"""Topics and messages for bags, and the same bags through an independent library."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from rosbags.rosbag2 import Reader

from daidalos.bags.message import BagMessage, Definition, Topic
from daidalos.bags.writer import BagWriter, WriterOptions
from daidalos.transport.qos import Durability, Qos

SECOND = 1_000_000_000
TEXT = Topic(
    "/text",
    "std_msgs/msg/String",
    qos=(Qos(depth=7, durability=Durability.TRANSIENT_LOCAL),),
    type_hash="RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    definition=Definition("string data\n"),
)
NUMBER = Topic("/number", "std_msgs/msg/Int32", definition=Definition("int32 data\n"))
CALLS = Topic("/add/_service_event", "example_interfaces/srv/AddTwoInts_Event")


def cdr(number: int) -> bytes:
    return b"\x00\x01\x00\x00" + number.to_bytes(4, "little")


def messages(count: int, topics: Sequence[Topic] = (TEXT, NUMBER), period_ns: int = 10_000_000) -> list[BagMessage]:
    """Messages on these topics in turn, sent a millisecond before they are received."""
    times = [SECOND + k * period_ns for k in range(count)]
    return [BagMessage(topics[k % len(topics)].name, cdr(k), t, t - 1_000_000) for k, t in enumerate(times)]


def write(
    folder: Path,
    content: Iterable[BagMessage],
    options: WriterOptions | None = None,
    topics: Iterable[Topic] = (TEXT, NUMBER),
) -> Path:
    with BagWriter(folder, options) as bag:
        for topic in topics:
            bag.add_topic(topic)
        for message in content:
            bag.write(message)
    return folder


def received(content: Iterable[BagMessage]) -> list[tuple[str, int, bytes]]:
    return [(message.topic, message.received_ns, message.data) for message in content]


def read_independently(folder: Path) -> list[tuple[str, int, bytes]]:
    with Reader(folder) as bag:
        return [(connection.topic, time, bytes(data)) for connection, time, data in bag.messages()]
