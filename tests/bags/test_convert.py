import pytest

from daidalos.bags.compression import Compression
from daidalos.bags.convert import Output, convert
from daidalos.bags.errors import BagError
from daidalos.bags.message import Topic
from daidalos.bags.reader import BagReader
from daidalos.bags.selection import Selection
from daidalos.bags.writer import WriterOptions

from .records import CALLS, NUMBER, TEXT, messages, read_independently, received, write


def test_one_bag_into_others(tmp_path):
    content = messages(300, (TEXT, NUMBER, CALLS))
    source = write(tmp_path / "source", content, topics=(TEXT, NUMBER, CALLS))
    seen = []
    notes = convert(
        [(source, "")],
        [
            Output(tmp_path / "all", WriterOptions("sqlite3")),
            Output(tmp_path / "text", WriterOptions(compression=Compression("MESSAGE", "zstd")), Selection(("/text",))),
            Output(tmp_path / "no_text", selection=Selection(exclude_topics=("/text",))),
            Output(tmp_path / "part", start_ns=content[100].received_ns, stop_ns=content[199].received_ns),
        ],
        lambda done, total: seen.append((done, total)),
    )
    assert notes == []
    assert seen[-1] == (300, 300)
    assert read_independently(tmp_path / "all") == received(content)
    assert read_independently(tmp_path / "text") == received(content[::3])
    assert read_independently(tmp_path / "no_text") == received(m for m in content if m.topic != "/text")
    assert read_independently(tmp_path / "part") == received(content[100:200])
    with BagReader(tmp_path / "no_text") as bag:
        assert sorted(bag.topics) == ["/add/_service_event", "/number"]
    with BagReader(tmp_path / "all") as bag:
        assert bag.topics_with_definitions()["/text"] == TEXT


def test_several_bags_into_one(tmp_path):
    content = messages(100)
    one = write(tmp_path / "one", content[::3], topics=[TEXT, NUMBER])
    other = write(tmp_path / "other", content[1::3], WriterOptions("sqlite3"))
    third = write(tmp_path / "third", content[2::3])
    convert([(one, ""), (other, "sqlite3"), (third, "mcap")], [Output(tmp_path / "whole")])
    assert read_independently(tmp_path / "whole") == received(content)


def test_nothing_is_left_of_what_fails(tmp_path):
    source = write(tmp_path / "source", messages(3000))
    file = source / "source_0.mcap"
    data = bytearray(file.read_bytes())
    data[5000] ^= 1
    file.write_bytes(data)
    with pytest.raises(BagError, match="damaged"):
        convert([(source, "")], [Output(tmp_path / "a"), Output(tmp_path / "b")])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["source"]
    good = write(tmp_path / "good", messages(3))
    with pytest.raises(BagError, match="good: already exists"):
        convert([(source, "")], [Output(tmp_path / "a"), Output(good)])
    with pytest.raises(BagError, match="nowhere: no such file or folder"):
        convert([(tmp_path / "nowhere", "")], [Output(tmp_path / "a")])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["good", "source"]


def test_a_topic_of_two_types(tmp_path):
    one = write(tmp_path / "one", messages(3))
    other = write(tmp_path / "other", [], topics=[Topic("/text", "std_msgs/msg/Int8")])
    with pytest.raises(BagError, match="topic /text is of type std_msgs/msg/Int8 here and std_msgs/msg/String in"):
        convert([(one, ""), (other, "")], [Output(tmp_path / "whole")])
