import pytest

from daidalos.bags.errors import BagError
from daidalos.bags.merged import MergedBags
from daidalos.bags.message import Topic
from daidalos.bags.reader import BagReader
from daidalos.bags.writer import WriterOptions

from .records import NUMBER, SECOND, TEXT, messages, received, write


def test_messages_come_in_one_order(tmp_path):
    content = messages(100)
    one = write(tmp_path / "one", content[::3], topics=[TEXT, NUMBER])
    other = write(tmp_path / "other", [*content[1::3], *content[2::3]], WriterOptions("sqlite3"))
    empty = write(tmp_path / "empty", [])
    with MergedBags([(one, ""), (other, "sqlite3"), (empty, "")]) as bags:
        assert received(bags.messages()) == received(content)
        assert received(bags.messages(["/number"])) == received(content[1::2])
        start, stop = content[20].received_ns, content[70].received_ns
        assert received(bags.messages(start_ns=start, stop_ns=stop)) == received(content[20:71])
        assert (bags.start_ns, bags.end_ns, bags.message_count) == (SECOND, content[-1].received_ns, 100)
        assert bags.notes == []


def test_topics_are_published_as_all_tell(tmp_path):
    one = write(tmp_path / "one", [], topics=[TEXT])
    other = write(tmp_path / "other", messages(10), topics=[TEXT, NUMBER])
    with MergedBags([(one, ""), (other, "")]) as bags:
        assert sorted(bags.topics) == ["/number", "/text"]
        assert bags.topics["/text"].qos == TEXT.qos * 2
        assert bags.topics_with_definitions()["/number"].definition == NUMBER.definition


def test_types_that_differ(tmp_path, monkeypatch):
    closed = []
    monkeypatch.setattr(BagReader, "close", lambda self: closed.append(self.path))
    one = write(tmp_path / "one", [], topics=[TEXT])
    other = write(tmp_path / "other", [], topics=[Topic("/text", "std_msgs/msg/Int32")])
    with pytest.raises(BagError, match="other: topic /text is of type std_msgs/msg/Int32 here and std_msgs/msg/String"):
        MergedBags([(one, ""), (other, "")])
    assert sorted(closed) == [one, other]
