import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader

from daidalos.bags.compression import Compression
from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage
from daidalos.bags.metadata import read_metadata
from daidalos.bags.reader import BagReader
from daidalos.bags.storage import PROFILES, StorageOptions
from daidalos.bags.writer import BagWriter, WriterOptions
from properties import examples

from .records import NUMBER, SECOND, TEXT, messages, read_independently, received, write

PLAIN = Compression()
WAYS = [
    ("mcap", "none", PLAIN),
    ("mcap", "fastwrite", PLAIN),
    ("mcap", "zstd_fast", PLAIN),
    ("mcap", "zstd_small", PLAIN),
    ("mcap", "none", Compression("FILE", "zstd")),
    ("mcap", "none", Compression("MESSAGE", "zstd")),
    ("sqlite3", "none", PLAIN),
    ("sqlite3", "resilient", PLAIN),
    ("sqlite3", "none", Compression("FILE", "zstd", 2)),
    ("sqlite3", "none", Compression("MESSAGE", "zstd")),
]


@pytest.mark.parametrize(("storage", "profile", "compression"), WAYS)
def test_what_is_written_is_read_also_by_others(tmp_path, storage, profile, compression):
    content = messages(500)
    options = WriterOptions(storage, StorageOptions(profile), compression=compression)
    folder = write(tmp_path / "bag", content, options)
    with BagReader(folder) as bag:
        read = list(bag.messages())
        assert bag.notes == []
        assert bag.metadata.compression_mode == compression.mode
        assert bag.topics_with_definitions() == {"/number": NUMBER, "/text": TEXT}
    assert received(read) == received(content)
    if storage == "mcap":
        assert read == content  # sqlite3 keeps one time only
    assert read_independently(folder) == received(content)


def test_files_have_the_names_and_the_description_that_ros_2_gives(tmp_path):
    options = WriterOptions(max_duration_ns=SECOND, custom_data={"robot": "r2d2"})
    folder = write(tmp_path / "walk", messages(350), options)
    assert sorted(path.name for path in folder.iterdir()) == [
        "metadata.yaml", "walk_0.mcap", "walk_1.mcap", "walk_2.mcap", "walk_3.mcap",
    ]  # fmt: skip
    metadata = read_metadata(folder)
    assert metadata.version == 9
    assert metadata.storage_id == "mcap"
    assert metadata.ros_distro == "jazzy"
    assert metadata.custom_data == {"robot": "r2d2"}
    assert [file.message_count for file in metadata.files] == [101, 101, 101, 47]
    assert all(file.duration_ns <= SECOND for file in metadata.files)
    assert {one.topic.name: one.count for one in metadata.topics} == {"/number": 175, "/text": 175}
    assert metadata.message_count == 350
    assert metadata.start_ns == SECOND
    assert metadata.end_ns == SECOND + 349 * 10_000_000
    assert [one.topic.qos for one in metadata.topics] == [(), TEXT.qos]


@pytest.mark.parametrize(("storage", "limit"), [("mcap", 20_000), ("sqlite3", 90_000)])
def test_files_stay_below_a_size(tmp_path, storage, limit):
    splits = []
    content = [BagMessage("/text", bytes(1000), SECOND + k, SECOND + k) for k in range(300)]
    with BagWriter(
        tmp_path / "bag", WriterOptions(storage, max_size=limit), lambda *paths: splits.append(paths)
    ) as bag:
        bag.add_topic(TEXT)
        for message in content:
            bag.write(message)
    files = read_metadata(tmp_path / "bag").files
    assert len(files) == len(splits) + 1 > 2
    assert [path.name for path, _ in splits] == [file.path for file in files[:-1]]
    assert [path.name for _, path in splits] == [file.path for file in files[1:]]
    # The limit is for messages; a summary and the description come on top.
    assert all((tmp_path / "bag" / file.path).stat().st_size < limit * 1.25 + 8000 for file in files)
    assert read_independently(tmp_path / "bag") == received(content)


def test_mcap_files_say_what_they_are(tmp_path):
    folder = write(tmp_path / "bag", messages(4))
    with (folder / "bag_0.mcap").open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
        channel = next(one for one in summary.channels.values() if one.topic == "/text")
        schema = summary.schemas[channel.schema_id]
        assert (schema.name, schema.encoding, schema.data) == ("std_msgs/msg/String", "ros2msg", b"string data\n")
        assert channel.message_encoding == "cdr"
        assert channel.metadata["topic_type_hash"] == TEXT.type_hash
        assert "durability: transient_local" in channel.metadata["offered_qos_profiles"]
        assert [one.name for one in reader.iter_metadata()] == ["rosbag2", "rosbag2"]
        assert [message.publish_time for _, _, message in reader.iter_messages()] == [m.sent_ns for m in messages(4)]


@pytest.mark.parametrize("profile", PROFILES["mcap"])
@pytest.mark.parametrize(
    "text", ["", "enableDataCRC: true", "noSummary: true", "noMessageIndex: true\nnoStatistics: true"]
)
def test_the_reference_implementation_finds_nothing_wrong(tmp_path, profile, text):
    config = tmp_path / "settings.yaml"
    config.write_text(text)
    folder = write(tmp_path / "bag", messages(300), WriterOptions(storage=StorageOptions(profile, config)))
    with (folder / "bag_0.mcap").open("rb") as file:
        found = [one for one in StreamReader(file, validate_crcs=True).records if isinstance(one, Message)]
    assert [(one.log_time, one.publish_time, one.data) for one in found] == [
        (one.received_ns, one.sent_ns, one.data) for one in messages(300)
    ]
    with BagReader(folder) as bag:
        assert list(bag.messages()) == messages(300)


def test_a_setting_outweighs_the_profile(tmp_path):
    config = tmp_path / "settings.yaml"
    config.write_text("chunkSize: 2000\ncompression: Lz4\ncompressionLevel: Fast\nforceCompression: true\n")
    options = WriterOptions(storage=StorageOptions("zstd_fast", config))
    folder = write(tmp_path / "bag", messages(300), options)
    with (folder / "bag_0.mcap").open("rb") as file:
        chunks = make_reader(file).get_summary().chunk_indexes
    assert {chunk.compression for chunk in chunks} == {"lz4"}
    assert len(chunks) > 5
    assert read_independently(folder) == received(messages(300))


@pytest.mark.parametrize(
    ("storage", "text", "fault"),
    [
        ("mcap", "chunksize: 3", "chunksize: 3 is not a setting of MCAP files; there are: chunkSize"),
        ("mcap", "chunkSize: -3", "chunkSize: -3"),
        ("mcap", "compression: Gzip", "compression: 'Gzip'"),
        ("mcap", "noChunking: maybe", "noChunking: 'maybe'"),
        ("mcap", "- noChunking", "expected a mapping"),
        ("mcap", "a: [", "cannot be read"),
        ("sqlite3", "write: 3", 'expected "write" with a list "pragmas"'),
        ("sqlite3", 'write: {pragmas: ["no such pragma ("]}', "cannot be made"),
    ],
)
def test_settings_that_are_not_understood(tmp_path, storage, text, fault):
    config = tmp_path / "settings.yaml"
    config.write_text(text)
    with pytest.raises(BagError, match=".*".join(map(_escaped, fault.split("...")))):
        BagWriter(tmp_path / "bag", WriterOptions(storage, StorageOptions(config=config)))


def _escaped(text):
    import re

    return re.escape(text)


def test_options_that_make_no_sense(tmp_path):
    for options, fault in (
        (WriterOptions("leveldb"), "unknown storage 'leveldb'; there are: mcap, sqlite3"),
        (WriterOptions(storage=StorageOptions("resilient")), "mcap has no profile 'resilient'; there are: none"),
        (WriterOptions(max_size=10), "files cannot be limited to 10 bytes; with mcap the limit must be 1024 or more"),
        (WriterOptions("sqlite3", max_size=2000), "must be 86016 or more"),
        (WriterOptions(compression=Compression("FILE", "gzip")), "unknown compression format 'gzip'; there is: zstd"),
        (WriterOptions(compression=Compression("HALF", "zstd")), "unknown compression mode 'HALF'"),
    ):
        with pytest.raises(BagError, match=_escaped(fault)):
            BagWriter(tmp_path / "bag", options)
        assert not (tmp_path / "bag").exists()


def test_a_bag_is_not_written_over_another(tmp_path):
    folder = write(tmp_path / "bag", messages(3))
    with pytest.raises(BagError, match="already exists"):
        BagWriter(folder)
    assert read_independently(folder) == received(messages(3))


def test_a_topic_must_be_declared(tmp_path):
    with BagWriter(tmp_path / "bag") as bag, pytest.raises(BagError, match="topic '/text' has not been created yet"):
        bag.write(messages(1)[0])


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_an_empty_bag(tmp_path, storage):
    folder = write(tmp_path / "bag", [], WriterOptions(storage))
    with BagReader(folder) as bag:
        assert list(bag.messages()) == []
        assert list(bag.topics) == ["/number", "/text"]
        assert (bag.metadata.message_count, bag.metadata.start_ns, bag.metadata.duration_ns) == (0, 0, 0)


@examples(60)
@given(
    st.lists(st.tuples(st.booleans(), st.binary(max_size=300), st.integers(0, 2**62)), max_size=60),
    st.sampled_from(WAYS),
    st.integers(1, 4000),
)
@example(
    [(False, b"", 0), (False, b"", 1), (False, b"", 1), (False, b"", 0), (False, b"", 0), (True, b"", 1)], WAYS[0], 32
)
def test_any_content_survives(tmp_path_factory, content, way, chunk):
    storage, profile, compression = way
    folder = tmp_path_factory.mktemp("bags")
    config = folder / "settings.yaml"
    config.write_text(f"chunkSize: {chunk}" if storage == "mcap" else "")
    written = [BagMessage("/text" if text else "/number", data, time, time) for text, data, time in content]
    options = WriterOptions(storage, StorageOptions(profile, config), compression=compression)
    write(folder / "bag", written, options)
    by_time = sorted(written, key=lambda message: message.received_ns)
    with BagReader(folder / "bag") as bag:
        assert list(bag.messages()) == by_time
        assert list(bag.messages(reverse=True)) == by_time[::-1]
        assert sorted(bag.messages(by_file=True)) == sorted(written)
        assert list(bag.messages({"/text"})) == [message for message in by_time if message.topic == "/text"]
