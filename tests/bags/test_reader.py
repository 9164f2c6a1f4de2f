from pathlib import Path

import pytest
from mcap.reader import make_reader

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage
from daidalos.bags.metadata import format_metadata
from daidalos.bags.reader import BagReader
from daidalos.bags.writer import WriterOptions

from .records import SECOND, TEXT, messages, received, write


def _read_by_mcap(path: Path) -> list[tuple[str, int, bytes]]:
    """Read a file by the format's own library; rosbags leaves the first message of an uncompressed chunk out."""
    with path.open("rb") as file:
        return [
            (channel.topic, message.log_time, message.data) for _, channel, message in make_reader(file).iter_messages()
        ]


@pytest.mark.parametrize("log", ["intel", "fr079"])
def test_bags_that_others_wrote(shared_data, log):
    folder = shared_data / "slam" / log
    with BagReader(folder) as bag:
        assert received(bag.messages()) == _read_by_mcap(folder / f"{log}.mcap")
        assert bag.notes == []
        assert {topic.definition.encoding for topic in bag.topics_with_definitions().values()} == {"ros2msg"}
        assert bag.metadata.end_ns - bag.metadata.start_ns == bag.metadata.duration_ns > 0
    with BagReader(folder / f"{log}.mcap") as file:
        assert file.metadata.message_count == bag.metadata.message_count
        assert (file.metadata.start_ns, file.metadata.end_ns) == (bag.metadata.start_ns, bag.metadata.end_ns)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_part_by_time_and_topic(tmp_path, storage):
    content = messages(1000)
    folder = write(tmp_path / "bag", content, WriterOptions(storage, max_duration_ns=SECOND))
    first, last = content[210].received_ns, content[730].received_ns
    opened = []
    with BagReader(folder, on_file=lambda closed, opened_file: opened.append((closed.name, opened_file.name))) as bag:
        assert received(bag.messages(start_ns=first, stop_ns=last)) == received(content[210:731])
        assert received(bag.messages(start_ns=first, stop_ns=last, reverse=True)) == received(content[210:731][::-1])
        assert received(bag.messages(["/number"], start_ns=first)) == received(content[211::2])
        assert list(bag.messages(["/nothing"])) == []
        assert list(bag.messages(start_ns=last, stop_ns=first)) == []
        suffix = {"mcap": "mcap", "sqlite3": "db3"}[storage]
        assert opened[0] == (f"bag_2.{suffix}", f"bag_3.{suffix}")


def test_files_that_overlap_are_put_in_order(tmp_path):
    even = [BagMessage("/text", b"%d" % k, k, k) for k in range(0, 100, 2)]
    odd = [BagMessage("/text", b"%d" % k, k, k) for k in range(1, 100, 2)]
    folder = write(tmp_path / "bag", even, topics=[TEXT])
    other = write(tmp_path / "other", odd, topics=[TEXT])
    (other / "other_0.mcap").rename(folder / "bag_1.mcap")
    (folder / "metadata.yaml").unlink()
    with BagReader(folder) as bag:
        assert [message.received_ns for message in bag.messages()] == list(range(100))
        assert [message.received_ns for message in bag.messages(reverse=True)] == list(range(99, -1, -1))


def test_a_bag_without_description_is_read_from_its_files(tmp_path):
    folder = write(tmp_path / "bag", messages(300), WriterOptions(max_duration_ns=SECOND))
    with BagReader(folder) as bag:
        described = bag.metadata
    (folder / "metadata.yaml").unlink()
    with BagReader(folder) as bag:
        assert format_metadata(bag.metadata) == format_metadata(described)
        assert bag.notes == [f"{folder}: there is no metadata.yaml; its files were read instead"]
        assert list(bag.messages()) == messages(300)


@pytest.mark.slow
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_of_many_files_does_not_keep_them_all_open(tmp_path, storage):
    import psutil

    content = messages(120)
    folder = write(tmp_path / "bag", content, WriterOptions(storage, max_duration_ns=1))
    process = psutil.Process()
    before, most = process.num_fds(), 0
    with BagReader(folder) as bag:
        assert len(bag.metadata.files) == 120
        for number, message in enumerate(bag.messages()):
            assert message.data == content[number].data
            most = max(most, process.num_fds() - before)
        assert received(bag.messages(reverse=True)) == received(content[::-1])
    assert most <= 2 * 17
    assert process.num_fds() <= before


def test_a_file_that_is_missing(tmp_path):
    folder = write(tmp_path / "bag", messages(300), WriterOptions(max_duration_ns=SECOND))
    (folder / "bag_1.mcap").unlink()
    with pytest.raises(BagError, match=r"its file 'bag_1\.mcap' is missing"):
        BagReader(folder)


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("a.mcap", b"", "the file is empty, expected a bag"),
        ("a.mcap", b"hello, this is no bag", "not a bag: it begins with 68 65 6c 6c 6f"),
        ("a.mcap", b"\x89MCAP1\r\n", "not an MCAP file: it begins with"),
        ("a.db3", b"SQLite format 3\0", "not an sqlite3 file|damaged|cannot be opened"),
        ("a.db3", b"SQLite format 3\0" + bytes(5000), "not an sqlite3 file|damaged|cannot be opened"),
        ("a.mcap.zstd", b"\x28\xb5\x2f\xfd" + bytes(30), "empty|cannot be decompressed"),
        ("a.zstd", b"\x28\xb5\x2f\xfd" + bytes(30), "not a bag"),
    ],
)
def test_files_that_are_no_bags(tmp_path, name, content, fault):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(BagError, match=fault) as raised:
        BagReader(path)
    assert str(path) in str(raised.value)


def test_places_where_there_is_no_bag(tmp_path):
    with pytest.raises(BagError, match="no such file or folder"):
        BagReader(tmp_path / "nowhere")
    with pytest.raises(BagError, match=r"not a bag: it holds no file that ends in \.mcap or \.db3"):
        BagReader(tmp_path)


def test_an_sqlite_file_that_is_no_bag(tmp_path):
    import sqlite3

    database = sqlite3.connect(tmp_path / "a.db3")
    database.execute("CREATE TABLE birds(name TEXT)")
    database.commit()
    database.close()
    with pytest.raises(BagError, match="not a bag: the database has no table 'messages'"):
        BagReader(tmp_path / "a.db3")


def test_an_sqlite_file_of_foxy(tmp_path):
    import sqlite3

    database = sqlite3.connect(tmp_path / "a.db3")
    database.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
        "INSERT INTO topics VALUES(3, '/text', 'std_msgs/msg/String', 'cdr');"
        "INSERT INTO messages VALUES(1, 3, 7, x'0001'), (2, 3, 5, x'0002');"
    )
    database.close()
    with BagReader(tmp_path / "a.db3") as bag:
        assert received(bag.messages()) == [("/text", 5, b"\0\2"), ("/text", 7, b"\0\1")]
        assert received(bag.messages(by_file=True)) == [("/text", 7, b"\0\1"), ("/text", 5, b"\0\2")]
        assert bag.topics["/text"].qos == ()
