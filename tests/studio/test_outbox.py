"""The queue of one client: newest of each topic, turns, bounds."""

import struct

from hypothesis import given
from hypothesis import strategies as st

from daidalos.studio import outbox as module
from daidalos.studio.outbox import BACKLOG, LIGHT_BYTES, LONG_BACKLOG, Outbox


def make_outbox():
    wakes = []
    return Outbox(lambda: wakes.append(1)), wakes


def drain(outbox):
    frames = []
    while (frame := outbox.take()) is not None:
        frames.append(frame)
    return frames


def message(frame):
    subscription, stamp = struct.unpack_from("<IQ", frame, 1)
    return subscription, stamp, frame[13:]


def test_keeps_the_newest_messages_of_a_topic_in_order():
    outbox, _ = make_outbox()
    outbox.open(1, latched=False)
    for stamp in range(100):
        outbox.put_message(1, stamp, bytes(LIGHT_BYTES))
    assert [message(frame)[1] for frame in drain(outbox)] == list(range(100 - BACKLOG, 100))
    assert outbox.dropped == 100 - BACKLOG


def test_small_messages_of_many_frames_wait_longer_but_not_for_ever():
    outbox, _ = make_outbox()
    outbox.open(1, latched=False)
    for stamp in range(2 * LONG_BACKLOG):
        outbox.put_message(1, stamp, b"x")
    assert [message(frame)[1] for frame in drain(outbox)] == list(range(LONG_BACKLOG, 2 * LONG_BACKLOG))


def test_latched_topics_keep_what_many_publishers_said():
    outbox, _ = make_outbox()
    outbox.open(1, latched=True)
    for stamp in range(300):
        outbox.put_message(1, stamp, b"x")
    assert len(drain(outbox)) == min(300, LONG_BACKLOG)


def test_topics_take_turns():
    outbox, _ = make_outbox()
    for number in (1, 2):
        outbox.open(number, latched=False)
        for stamp in range(3):
            outbox.put_message(number, stamp, b"")
    assert [message(frame)[0] for frame in drain(outbox)] == [1, 2, 1, 2, 1, 2]


def test_replies_go_first_and_in_order():
    outbox, _ = make_outbox()
    outbox.open(1, latched=False)
    outbox.put_message(1, 0, b"")
    outbox.put_reply("a")
    outbox.put_reply(b"b")
    assert drain(outbox)[:2] == ["a", b"b"]


def test_only_the_newest_time_is_told():
    outbox, _ = make_outbox()
    outbox.put_time(1)
    outbox.put_time(2)
    assert drain(outbox) == [b"\x02" + (2).to_bytes(8, "little")]


def test_wakes_once_until_it_is_empty_again():
    outbox, wakes = make_outbox()
    outbox.open(1, latched=False)
    for _ in range(5):
        outbox.put_message(1, 0, b"")
    outbox.put_reply("x")
    assert len(wakes) == 1
    drain(outbox)
    outbox.put_time(3)
    assert len(wakes) == 2


def test_a_closed_subscription_leaves_nothing_behind():
    outbox, _ = make_outbox()
    outbox.open(1, latched=False)
    outbox.put_message(1, 0, b"old")
    outbox.close(1)
    outbox.put_message(1, 1, b"late")
    assert drain(outbox) == []


def test_bytes_are_bounded_and_the_fattest_topic_pays(monkeypatch):
    monkeypatch.setattr(module, "MESSAGE_BYTES", 1000)
    outbox, _ = make_outbox()
    outbox.open(1, latched=False)
    outbox.open(2, latched=False)
    for stamp in range(3):
        outbox.put_message(2, stamp, bytes(10))
    for stamp in range(10):
        outbox.put_message(1, stamp, bytes(300))
    frames = [message(frame) for frame in drain(outbox)]
    assert [stamp for number, stamp, _ in frames if number == 2] == [0, 1, 2]
    assert [stamp for number, stamp, _ in frames if number == 1] == [7, 8, 9]


def test_the_newest_of_a_topic_always_stays(monkeypatch):
    monkeypatch.setattr(module, "MESSAGE_BYTES", 10)
    outbox, _ = make_outbox()
    for number in (1, 2):
        outbox.open(number, latched=False)
        for stamp in range(3):
            outbox.put_message(number, stamp, bytes(100))
    assert sorted(message(frame)[:2] for frame in drain(outbox)) == [(1, 2), (2, 2)]


ACTIONS = st.lists(
    st.tuples(st.just("put"), st.integers(1, 4), st.integers(0, 60))
    | st.tuples(st.sampled_from(["open", "close"]), st.integers(1, 4), st.just(0))
    | st.tuples(st.just("take"), st.just(0), st.just(0)),
    max_size=120,
)


@given(ACTIONS)
def test_whatever_happens_each_topic_stays_in_order_and_the_count_of_bytes_true(actions):
    outbox, _ = make_outbox()
    last: dict[int, int] = {}
    opened = set()
    for stamp, (action, number, size) in enumerate(actions):
        if action == "put":
            outbox.put_message(number, stamp, bytes(size))
        elif action == "open":
            if number not in opened:
                outbox.open(number, latched=False)
                opened.add(number)
        elif action == "close":
            outbox.close(number)
            opened.discard(number)
        elif (frame := outbox.take()) is not None:
            taken, stamp, _ = message(frame)
            assert taken in opened
            assert stamp > last.get(taken, -1)
            last[taken] = stamp
    drain(outbox)
    assert outbox._message_bytes == 0
