import subprocess
import sys

import pytest
import rosbag2_py
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rosbag2_py import (
    ConverterOptions,
    ReadOrder,
    ReadOrderSortBy,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
)
from rosbags.rosbag2 import Reader
from std_msgs.msg import String

from .conftest import CHATTER, SECOND, write_chatter


def opened(uri, storage=""):
    reader = SequentialReader()
    reader.open(StorageOptions(uri=uri, storage_id=storage), ConverterOptions("cdr", "cdr"))
    return reader


def numbers(reader):
    found = []
    while reader.has_next():
        topic, data, _ = reader.read_next()
        found.append(int(deserialize_message(data, String).data))
        assert topic == "/chatter"
    return found


def test_a_program_writes_and_reads_as_in_ros_2(tmp_path, storage):
    uri = write_chatter(tmp_path / "bag", 50, storage)
    reader = opened(uri, storage)
    assert [(one.name, one.type) for one in reader.get_all_topics_and_types()] == [("/chatter", "std_msgs/msg/String")]
    topic, data, time = reader.read_next()
    assert (topic, time) == ("/chatter", SECOND)
    assert deserialize_message(data, String).data == "0"
    assert numbers(reader) == list(range(1, 50))
    with pytest.raises(RuntimeError, match="Bag is at end"):
        reader.read_next()
    definition = reader.get_all_message_definitions()[0]
    assert (definition.topic_type, definition.encoding) == ("std_msgs/msg/String", "ros2msg")
    assert "string data" in definition.encoded_message_definition
    with Reader(uri) as bag:
        assert bag.message_count == 50


def test_order_position_and_filter(tmp_path, storage):
    uri = write_chatter(tmp_path / "bag", 100, storage, max_bagfile_duration=0.3)
    reader = SequentialReader()
    reader.open_uri(uri)
    reader.seek(SECOND + 95 * 10_000_000)
    assert numbers(reader) == [95, 96, 97, 98, 99]
    reader.seek(0)
    assert reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, reverse=True))
    reader.seek(SECOND + 3 * 10_000_000)
    assert numbers(reader) == [3, 2, 1, 0]
    assert not reader.set_read_order(ReadOrder(ReadOrderSortBy.PublishedTimestamp))
    assert reader.set_read_order(ReadOrder(ReadOrderSortBy.File))
    reader.seek(0)
    assert numbers(reader) == list(range(100))
    reader.set_filter(StorageFilter(topics=["/nothing"]))
    reader.seek(0)
    assert not reader.has_next()
    reader.set_filter(StorageFilter(regex="chat"))
    reader.seek(0)
    reader.read_next()
    reader.reset_filter()
    assert numbers(reader)[0] == 1
    metadata = reader.get_metadata()
    assert len(metadata.relative_file_paths) == len(metadata.files) == 4
    assert metadata.duration.nanoseconds == 99 * 10_000_000
    assert metadata.starting_time.nanoseconds == SECOND
    assert metadata.topics_with_message_count[0].message_count == 100
    reader.close()


def test_limits_of_time(tmp_path):
    uri = write_chatter(tmp_path / "bag", 100)
    reader = SequentialReader()
    options = StorageOptions(uri, start_time_ns=SECOND + 10_000_000, end_time_ns=SECOND + 30_000_000)
    reader.open(options, ConverterOptions())
    assert numbers(reader) == [1, 2, 3]
    reader.seek(0)
    assert numbers(reader) == [1, 2, 3]


def test_what_is_not_open(tmp_path):
    reader, writer = SequentialReader(), SequentialWriter()
    with pytest.raises(RuntimeError, match="Bag is not open"):
        reader.has_next()
    with pytest.raises(RuntimeError, match="Bag is not open"):
        writer.write("/chatter", b"", 0)
    with pytest.raises(RuntimeError, match="no such file or folder"):
        reader.open_uri(str(tmp_path / "nowhere"))
    with pytest.raises(RuntimeError, match="No converter for the serialization format 'json'"):
        writer.open(StorageOptions(str(tmp_path / "bag")), ConverterOptions("", "json"))
    writer.open(StorageOptions(str(tmp_path / "bag")), ConverterOptions())
    with pytest.raises(RuntimeError, match="A bag is open already"):
        writer.open(StorageOptions(str(tmp_path / "other")), ConverterOptions())
    with pytest.raises(RuntimeError, match="'/chatter' has not been created yet"):
        writer.write("/chatter", b"", 0)


def test_letting_the_writer_go_completes_the_bag(tmp_path):
    writer = SequentialWriter()
    writer.open(StorageOptions(uri=str(tmp_path / "bag"), storage_id="mcap"), ConverterOptions("", ""))
    writer.create_topic(CHATTER)
    writer.write("/chatter", serialize_message(String(data="7")), 5, 4)
    del writer
    assert numbers(opened(str(tmp_path / "bag"))) == [7]


RECORDER = """
import sys
import rosbag2_py
from rclpy.serialization import serialize_message
from std_msgs.msg import String

class Recorder:
    def __init__(self, writer):
        self.writer = writer
        writer.open(rosbag2_py.StorageOptions(uri=sys.argv[1], storage_id="mcap"), rosbag2_py.ConverterOptions("", ""))
        writer.create_topic(rosbag2_py.TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr"))
        self.myself = self

    def record(self):
        self.writer.write("/chatter", serialize_message(String(data="7")), 5)
        raise KeyboardInterrupt

if sys.argv[2] == "plain":
    recorder = Recorder(rosbag2_py.SequentialWriter())
else:
    options = rosbag2_py.CompressionOptions("zstd", rosbag2_py.CompressionMode.FILE)
    recorder = Recorder(rosbag2_py.SequentialCompressionWriter(options))
recorder.record()
"""


@pytest.mark.parametrize("kind", ["plain", "compressed"])
def test_the_end_of_a_program_completes_the_bag(tmp_path, kind):
    program = subprocess.run(
        [sys.executable, "-c", RECORDER, tmp_path / "bag", kind], capture_output=True, text=True, check=False
    )
    assert program.stderr.splitlines()[-1] == "KeyboardInterrupt"
    reader = rosbag2_py.SequentialCompressionReader() if kind == "compressed" else SequentialReader()
    reader.open(StorageOptions(uri=str(tmp_path / "bag")), ConverterOptions("cdr", "cdr"))
    assert (tmp_path / "bag" / "metadata.yaml").is_file()
    assert numbers(reader) == [7]


def test_topics_as_humble_makes_them():
    topic = TopicMetadata("/a", "std_msgs/msg/String", "cdr")
    assert (topic.name, topic.type, topic.serialization_format) == ("/a", "std_msgs/msg/String", "cdr")
    named = TopicMetadata(name="/a", type="std_msgs/msg/String", serialization_format="cdr")
    assert topic == named
    assert topic.equals(named)
    text = "- history: 1\n  depth: 3\n  reliability: 2\n  durability: 2\n"
    old = TopicMetadata("/a", "std_msgs/msg/String", "cdr", text)
    assert old.topic().qos[0].depth == 3


def test_quality_of_service_is_kept(tmp_path):
    qos = rosbag2_py.QoS(5).best_effort().transient_local().deadline(rosbag2_py._qos.Duration(2, 5)).keep_last(9)
    profile = QoSProfile(depth=2, reliability=ReliabilityPolicy.BEST_EFFORT)
    writer = SequentialWriter()
    writer.open(StorageOptions(str(tmp_path / "bag")), ConverterOptions())
    writer.create_topic(TopicMetadata(0, "/a", "std_msgs/msg/String", "cdr", [qos, profile], "RIHS01_ab"))
    writer.close()
    metadata = rosbag2_py.MetadataIo().read_metadata(str(tmp_path / "bag"))
    topic = metadata.topics_with_message_count[0].topic_metadata
    assert topic.type_description_hash == "RIHS01_ab"
    assert topic.offered_qos_profiles[0] == qos
    back = rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(topic.offered_qos_profiles[1])
    assert (back.depth, back.reliability) == (2, ReliabilityPolicy.BEST_EFFORT)


def test_compressed_bags(tmp_path, storage):
    options = rosbag2_py.CompressionOptions("zstd", rosbag2_py.CompressionMode.MESSAGE)
    writer = rosbag2_py.SequentialCompressionWriter(options)
    writer.open(StorageOptions(str(tmp_path / "bag"), storage), ConverterOptions())
    writer.create_topic(CHATTER)
    writer.write("/chatter", serialize_message(String(data="3")), 1)
    writer.split_bagfile()
    writer.write("/chatter", serialize_message(String(data="4")), 2)
    writer.close()
    reader = rosbag2_py.SequentialCompressionReader()
    reader.open(StorageOptions(str(tmp_path / "bag"), storage), ConverterOptions())
    assert numbers(reader) == [3, 4]
    assert reader.get_metadata().compression_mode == "MESSAGE"
    for mode in rosbag2_py.CompressionMode:
        text = rosbag2_py.compression_mode_to_string(mode)
        assert rosbag2_py.compression_mode_from_string(text.lower()) is mode


def test_snapshots(tmp_path):
    writer = SequentialWriter()
    options = StorageOptions(str(tmp_path / "bag"), max_cache_size=1000, snapshot_mode=True)
    writer.open(options, ConverterOptions())
    writer.create_topic(CHATTER)
    for k in range(100):
        writer.write("/chatter", serialize_message(String(data=str(k))), k)
    assert writer.take_snapshot()
    writer.close()
    found = numbers(opened(str(tmp_path / "bag")))
    assert found == list(range(100 - len(found), 100))
    assert 3 < len(found) < 20


def test_metadata_goes_to_and_fro(tmp_path):
    uri = write_chatter(tmp_path / "bag", 5)
    io = rosbag2_py.MetadataIo()
    assert io.metadata_file_exists(uri)
    assert not io.metadata_file_exists(str(tmp_path))
    metadata = io.read_metadata(uri)
    again = io.deserialize_metadata(io.serialize_metadata(metadata))
    again.bag_size = metadata.bag_size
    assert again == metadata
    assert str(metadata) == str(rosbag2_py.Info().read_metadata(uri, ""))
    io.write_metadata(str(tmp_path), metadata)
    assert io.read_metadata(str(tmp_path)).message_count == 5
    with pytest.raises(RuntimeError, match="Could not find metadata"):
        io.read_metadata(str(tmp_path / "nowhere"))


def test_reindexing(tmp_path, storage):
    uri = write_chatter(tmp_path / "bag", 5, storage)
    (tmp_path / "bag" / "metadata.yaml").unlink()
    rosbag2_py.Reindexer().reindex(StorageOptions(uri, storage))
    assert rosbag2_py.MetadataIo().read_metadata(uri).message_count == 5


def test_what_there_is():
    assert rosbag2_py.get_default_storage_id() == "mcap"
    assert rosbag2_py.get_registered_readers() == rosbag2_py.get_registered_writers() == {"mcap", "sqlite3"}
    assert rosbag2_py.get_registered_compressors() == {"zstd"}
    assert rosbag2_py.get_registered_serializers() == {"cdr_converter"}
    found = rosbag2_py.LocalMessageDefinitionSource().get_full_text("geometry_msgs/msg/Twist")
    assert f"\n\n{80 * '='}\nMSG: geometry_msgs/Vector3\n" in found.encoded_message_definition
    assert rosbag2_py.LocalMessageDefinitionSource().get_full_text("no/msg/Thing").encoded_message_definition == ""
    assert all(hasattr(rosbag2_py, name) for name in rosbag2_py.__all__)


@pytest.mark.parametrize("reverse", [False, True])
def test_a_filter_goes_on_among_messages_of_the_same_time(tmp_path, storage, reverse):
    uri = str(tmp_path / "bag")
    writer = SequentialWriter()
    writer.open(StorageOptions(uri, storage), ConverterOptions("cdr", "cdr"))
    for topic in ("/a", "/b", "/c"):
        writer.create_topic(TopicMetadata(name=topic, type="std_msgs/msg/String", serialization_format="cdr"))
    data = serialize_message(String())
    for time, topics in ((1, "ab"), (2, "acbba"), (3, "c")):
        for topic in topics:
            writer.write(f"/{topic}", data, time)
    writer.close()
    reader = opened(uri, storage)
    reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, reverse=reverse))
    whole = []
    while reader.has_next():
        whole.append(reader.read_next()[::2])
    for read in range(1, len(whole)):
        reader.seek(3 if reverse else 0)
        before = [reader.read_next()[::2] for _ in range(read)]
        reader.set_filter(StorageFilter(topics=["/b", "/c"]))
        after = []
        while reader.has_next():
            after.append(reader.read_next()[::2])
        assert before == whole[:read]
        assert after == [one for one in whole[read:] if one[0] != "/a"]
        reader.reset_filter()


def test_definitions_of_types_without_and_unknown():
    source = rosbag2_py.LocalMessageDefinitionSource()
    assert source.get_full_text("no_package").encoding == "unknown"
    short, full = (source.get_full_text(name) for name in ("std_msgs/String", "std_msgs/msg/String"))
    assert (short.encoding, short.topic_type) == ("ros2msg", "std_msgs/String")
    assert short.encoded_message_definition == full.encoded_message_definition


def test_topics_of_service_events_have_the_definition_of_the_service(tmp_path, storage):
    uri = str(tmp_path / "bag")
    writer = SequentialWriter()
    writer.open(StorageOptions(uri, storage), ConverterOptions("cdr", "cdr"))
    type_name = "rcl_interfaces/srv/GetParameters_Event"
    writer.create_topic(TopicMetadata(name="/get/_service_event", type=type_name, serialization_format="cdr"))
    writer.write("/get/_service_event", b"", 1)
    writer.close()
    (definition,) = opened(uri, storage).get_all_message_definitions()
    assert (definition.topic_type, definition.encoding) == (type_name, "ros2msg")
    text = definition.encoded_message_definition
    assert text.startswith(f"{80 * '='}\nSRV: rcl_interfaces/srv/GetParameters\n")
    assert f"\n\n{80 * '='}\nMSG: rcl_interfaces/ParameterValue\n" in text
