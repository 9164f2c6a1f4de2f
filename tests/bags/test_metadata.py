import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from daidalos.bags.errors import BagError
from daidalos.bags.message import Topic
from daidalos.bags.metadata import (
    BagFile,
    BagMetadata,
    TopicCount,
    format_metadata,
    parse_metadata,
    read_metadata,
    write_metadata,
)
from daidalos.transport.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability

OF_JAZZY = """\
rosbag2_bagfile_information:
  version: 9
  storage_identifier: mcap
  duration:
    nanoseconds: 28000217976
  starting_time:
    nanoseconds_since_epoch: 1791340443504644767
  message_count: 29
  topics_with_message_count:
    - topic_metadata:
        name: /number_count
        type: example_interfaces/msg/Int64
        serialization_format: cdr
        offered_qos_profiles:
          - history: unknown
            depth: 0
            reliability: reliable
            durability: volatile
            deadline:
              sec: 9223372036
              nsec: 854775807
            lifespan:
              sec: 9223372036
              nsec: 854775807
            liveliness: automatic
            liveliness_lease_duration:
              sec: 9223372036
              nsec: 854775807
            avoid_ros_namespace_conventions: false
        type_description_hash: RIHS01_1b3b
      message_count: 29
  compression_format: ""
  compression_mode: ""
  relative_file_paths:
    - walk_0.mcap
  files:
    - path: walk_0.mcap
      starting_time:
        nanoseconds_since_epoch: 1791340443504644767
      duration:
        nanoseconds: 28000217976
      message_count: 29
  custom_data: ~
  ros_distro: jazzy
"""
OF_GALACTIC = """\
rosbag2_bagfile_information:
  version: 4
  storage_identifier: sqlite3
  relative_file_paths:
    - walk/walk_0.db3
    - walk_1.db3
  duration: {nanoseconds: 7}
  starting_time: {nanoseconds_since_epoch: 5}
  message_count: 3
  topics_with_message_count:
    - topic_metadata:
        name: /text
        type: std_msgs/msg/String
        serialization_format: cdr
        offered_qos_profiles: "- history: 3\\n  depth: 0\\n  reliability: 2\\n  durability: 1\\n  deadline:\\n    sec: \
2147483647\\n    nsec: 4294967295\\n  lifespan:\\n    sec: 10\\n    nsec: 5\\n  liveliness: 1\\n  \
liveliness_lease_duration:\\n    sec: 2147483647\\n    nsec: 4294967295\\n  avoid_ros_namespace_conventions: false"
      message_count: 3
  compression_format: zstd
  compression_mode: FILE
"""


def test_a_description_that_jazzy_wrote():
    metadata = parse_metadata(OF_JAZZY, "metadata.yaml")
    qos = Qos(history=History.UNKNOWN, depth=0)
    topic = Topic("/number_count", "example_interfaces/msg/Int64", "cdr", (qos,), "RIHS01_1b3b")
    start, duration = 1791340443504644767, 28000217976
    assert metadata == BagMetadata(
        "mcap",
        start,
        duration,
        29,
        (TopicCount(topic, 29),),
        (BagFile("walk_0.mcap", start, duration, 29),),
        ros_distro="jazzy",
    )
    # What is written back is the same document.
    assert yaml.safe_load(format_metadata(metadata)) == yaml.safe_load(OF_JAZZY)


def test_a_description_of_an_old_version():
    metadata = parse_metadata(OF_GALACTIC, "/bags/walk/metadata.yaml")
    assert [file.path for file in metadata.files] == ["walk_0.db3", "walk_1.db3"]
    assert {(file.start_ns, file.duration_ns) for file in metadata.files} == {(5, 7)}
    assert (metadata.compression_format, metadata.compression_mode) == ("zstd", "FILE")
    assert metadata.topics[0].topic.qos == (
        Qos(
            Reliability.BEST_EFFORT,
            Durability.TRANSIENT_LOCAL,
            History.UNKNOWN,
            0,
            INFINITE_NS,
            10_000_000_005,
            Liveliness.AUTOMATIC,
            INFINITE_NS,
        ),
    )


@pytest.mark.parametrize(
    ("before", "after", "fault"),
    [
        ("version: 9", "version: 10", "its version is 10; versions 1 to 9 are known"),
        ("version: 9", "version: nine", "rosbag2_bagfile_information.version: expected a whole number, found 'nine'"),
        ("  message_count: 29\n  topics", "  topics", "rosbag2_bagfile_information.message_count is missing"),
        ("rosbag2_bagfile_information:", "bag:", "not a description of a bag: rosbag2_bagfile_information is missing"),
        ("name: /number_count", "name: [", "not valid YAML: line 13, column 29"),
        ("reliability: reliable", "reliability: sometimes", "reliability: expected one of system_default, reliable"),
        ("depth: 0", "depth: -1", "depth: expected a number not below 0, found -1"),
        ("nanoseconds: 28000217976", "seconds: 28", "duration.nanoseconds is missing"),
        ("    - walk_0.mcap", "    walk_0.mcap", "relative_file_paths: expected a list, found 'walk_0.mcap'"),
    ],
)
def test_what_is_wrong_is_named(before, after, fault):
    assert before in OF_JAZZY
    with pytest.raises(BagError) as raised:
        parse_metadata(OF_JAZZY.replace(before, after, 1), "/bag/metadata.yaml")
    assert fault in str(raised.value)
    assert str(raised.value).startswith("/bag/metadata.yaml: ")
    assert "\n" not in str(raised.value)


@given(st.one_of(st.text(), st.text(alphabet="abc:[]{}-\n '\"", max_size=60)))
def test_any_text_is_a_description_or_an_error(text):
    with pytest.raises(BagError):
        parse_metadata(text, "metadata.yaml")


names = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=20)
times = st.integers(0, 2**62)


@given(
    st.builds(
        BagMetadata,
        storage_id=st.sampled_from(["mcap", "sqlite3"]),
        start_ns=times,
        duration_ns=times,
        message_count=times,
        topics=st.lists(
            st.builds(
                TopicCount,
                st.builds(
                    Topic,
                    names,
                    names,
                    names,
                    st.lists(
                        st.builds(
                            Qos,
                            st.sampled_from(Reliability),
                            st.sampled_from(Durability),
                            st.sampled_from(History),
                            st.integers(0, 1000),
                            st.integers(1, INFINITE_NS),
                        ),
                        max_size=2,
                    ).map(tuple),
                    names,
                ),
                times,
            ),
            max_size=3,
        ).map(tuple),
        files=st.lists(
            st.builds(BagFile, names, times, times, times), max_size=3, unique_by=lambda file: file.path
        ).map(tuple),
        compression_format=st.sampled_from(["", "zstd"]),
        compression_mode=st.sampled_from(["", "FILE", "MESSAGE"]),
        custom_data=st.dictionaries(names, names, max_size=3),
        ros_distro=names,
    )
)
def test_what_is_written_is_read(metadata):
    assert parse_metadata(format_metadata(metadata), "metadata.yaml") == metadata


def test_writing_leaves_one_file(tmp_path):
    metadata = parse_metadata(OF_JAZZY, "metadata.yaml")
    write_metadata(tmp_path, metadata)
    assert [path.name for path in tmp_path.iterdir()] == ["metadata.yaml"]
    assert read_metadata(tmp_path) == metadata
    with pytest.raises(BagError, match="cannot be written"):
        write_metadata(tmp_path / "nowhere", metadata)
    with pytest.raises(BagError, match="Could not find metadata"):
        read_metadata(tmp_path / "nowhere")
