"""The command `daidalos diff`."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bags.records import NUMBER, SECOND, TEXT, messages, write
from daidalos.bags.compare import differences
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.reader import BagReader
from daidalos.cli.daidalos import main
from properties import examples


def diff(*words: object) -> int:
    return main(["diff", *map(str, words)])


def test_a_bag_is_like_itself_and_like_one_at_another_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = messages(50)
    one = write(tmp_path / "one", sent)
    later = write(tmp_path / "later", [m._replace(received_ns=m.received_ns + SECOND) for m in sent])
    assert diff(one, one) == 0
    assert diff(one, later) == 0
    assert capsys.readouterr().out == "alike: 50 messages\n" * 2


def test_the_first_message_that_differs_is_shown_with_its_fields(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sent = messages(20)
    changed = [m._replace(data=b"\x00\x01\x00\x00\x2a\x00\x00\x00") if k in (7, 9) else m for k, m in enumerate(sent)]
    assert diff(write(tmp_path / "one", sent), write(tmp_path / "other", changed)) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines == ["/number [std_msgs/msg/Int32] message 3 at 0.070000 s:", "  data: 7 -> 42"]


def test_missing_added_late_and_retyped_messages_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = messages(10)
    one = write(tmp_path / "one", sent)
    assert diff(one, write(tmp_path / "short", sent[:-2])) == 1
    assert "the second bag has no message more" in capsys.readouterr().out
    assert diff(write(tmp_path / "short2", sent[:-2]), one) == 1
    assert "the first bag has no message more" in capsys.readouterr().out
    late = [m._replace(received_ns=m.received_ns + 1) if k == 5 else m for k, m in enumerate(sent)]
    late_bag = write(tmp_path / "late", late)
    assert diff(one, late_bag) == 1
    assert "the same message at another time: 0.050000000 s -> 0.050000001 s" in capsys.readouterr().out
    assert diff(one, late_bag, "--ignore-times") == 0
    retyped = replace(NUMBER, type="std_msgs/msg/UInt32")
    assert diff(one, write(tmp_path / "retyped", sent, topics=(TEXT, retyped))) == 1
    assert "another type: std_msgs/msg/Int32 -> std_msgs/msg/UInt32" in capsys.readouterr().out


def test_json_and_chosen_topics(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = messages(20)
    one, other = write(tmp_path / "one", sent), write(tmp_path / "other", sent[:11])
    assert diff(one, other, "--topics", "/number", "--json") == 1
    report = json.loads(capsys.readouterr().out)
    assert not report["alike"]
    assert [(d["topic"], d["message"], d["what"]) for d in report["differences"]] == [("/number", 5, "missing")]


def test_bad_bags_and_topics_end_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = write(tmp_path / "one", messages(4))
    assert diff(one, tmp_path / "none") == 2
    assert diff(one, one, "--topics", "/numbr") == 2
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == f"error: {tmp_path / 'none'}: no such file or folder"
    assert lines[1:] == ["error: neither bag has the topic '/numbr'", "Did you mean '/number'?"]


@examples(25)
@given(
    bags=st.tuples(*[st.lists(st.tuples(st.integers(0, 2), st.integers(0, 2)), max_size=8)] * 2),
)
def test_bags_are_alike_exactly_when_every_topic_has_the_same_messages(
    tmp_path_factory: pytest.TempPathFactory, bags: tuple[list[tuple[int, int]], list[tuple[int, int]]]
) -> None:
    topics = [Topic(f"/t{k}", "std_msgs/msg/Int32") for k in range(3)]
    readers = []
    for content in bags:
        sent = [
            BagMessage(f"/t{topic}", b"\x00\x01\x00\x00" + value.to_bytes(4, "little"), SECOND, SECOND)
            for topic, value in content
        ]
        readers.append(BagReader(write(tmp_path_factory.mktemp("bags") / "bag", sent, topics=topics)))
    expected = {f"/t{k}" for k in range(3) if [v for t, v in bags[0] if t == k] != [v for t, v in bags[1] if t == k]}
    assert {one.topic for one in differences(*readers)} == expected
    for reader in readers:
        reader.close()
