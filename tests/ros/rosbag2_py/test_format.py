import pytest
from example_interfaces.srv import AddTwoInts
from rclpy.serialization import serialize_message
from rosbag2_py._format import contents, format_metadata, format_size, format_time

from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import BagFile, BagMetadata, TopicCount
from daidalos.bags.reader import BagReader
from daidalos.bags.writer import BagWriter

TEXT = Topic("/text", "std_msgs/msg/String")
CALLS = Topic("/add/_service_event", "example_interfaces/srv/AddTwoInts_Event")


def test_a_bag_as_jazzy_prints_it(monkeypatch):
    monkeypatch.setenv("TZ", "UTC")
    files = (BagFile("test_0.mcap", 0, 0, 0), BagFile("test_1.mcap", 0, 0, 0))
    topics = (TopicCount(CALLS, 4), TopicCount(TEXT, 5), TopicCount(Topic("/number", "std_msgs/msg/Int8"), 6))
    metadata = BagMetadata("mcap", 1791341976116582550, 4999887495, 15, topics, files, ros_distro="jazzy")
    text = format_metadata(metadata, 5530)
    assert text == (
        "\n"
        "Files:             test_0.mcap\n"
        "                   test_1.mcap\n"
        "Bag size:          5.4 KiB\n"
        "Storage id:        mcap\n"
        "ROS Distro:        jazzy\n"
        "Duration:          4.999887495s\n"
        f"Start:             {format_time(1791341976116582550)}\n"
        f"End:               {format_time(1791341981116470045)}\n"
        "Messages:          11\n"
        "Topic information: Topic: /number | Type: std_msgs/msg/Int8 | Count: 6 | Serialization Format: cdr\n"
        "                   Topic: /text | Type: std_msgs/msg/String | Count: 5 | Serialization Format: cdr\n"
        "Service:           1\n"
        "Service information: Service: /add | Type: example_interfaces/srv/AddTwoInts | Event Count: 4 | "
        "Serialization Format: cdr"
    )
    by_count = format_metadata(metadata, 0, sort="count")
    assert by_count.index("/number") < by_count.index("/text")
    by_type = format_metadata(metadata, 0, sort="type")
    assert by_type.index("Int8") < by_type.index("String")


def test_times_as_jazzy_prints_them():
    assert format_time(1586406456763032325).endswith(":36.763032325 (1586406456.763032325)")
    assert format_time(1586406456763032325).startswith("Apr  ")
    assert format_time(2**63 - 1).endswith("(9223372036.854775807)")


@pytest.mark.parametrize(
    ("size", "text"),
    [
        (0, "0 B"),
        (1023, "1023 B"),
        (1024, "1.0 KiB"),
        (233984, "228.5 KiB"),
        (3 * 2**20, "3.0 MiB"),
        (2**50, "1024.0 TiB"),
    ],
)
def test_sizes(size, text):
    assert format_size(size) == text


def test_the_calls_of_a_service_are_counted_once(tmp_path):
    def event(kind, client, number, **parts):
        event = AddTwoInts.Event(**parts)
        event.info.event_type = kind
        event.info.client_gid = [client] * 16
        event.info.sequence_number = number
        return serialize_message(event)

    request, response = AddTwoInts.Request(a=1, b=2), AddTwoInts.Response(sum=3)
    events = [
        event(0, 1, 7, request=[request]),  # sent by the client
        event(1, 1, 7, request=[request]),  # received by the service
        event(2, 1, 7, response=[response]),
        event(1, 1, 8),  # no introspection in the client
        event(1, 2, 8),
    ]
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic(CALLS)
        for k, data in enumerate(events):
            writer.write(BagMessage(CALLS.name, data, k, k))
    with BagReader(tmp_path / "bag") as bag:
        text = format_metadata(bag.metadata, 0, contents=contents(bag))
    size = sum(map(len, events))
    assert f"Request Count: 3 | Response Count: 1 | Size Contribution: {size} B | Serialization Format" in text
    assert "Messages:          0" in text
