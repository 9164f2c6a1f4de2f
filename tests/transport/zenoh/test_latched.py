"""Transient-local topics: with zenoh's own advanced publishers and subscribers, and in every order of events."""

from __future__ import annotations

import os
import queue
import signal
import threading
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh
from std_msgs.msg import Int32, String
from zenoh import ext
from zenoh.handlers import Callback

from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Durability, Qos
from daidalos.transport.session import Session
from daidalos.transport.zenoh import attachment, keys
from daidalos.transport.zenoh.history_queries import HistoryQueries
from daidalos.transport.zenoh.keys import gid_of
from daidalos.transport.zenoh.latched import History
from transport.peers import Peer
from transport.test_sessions import node_of, subscribe
from transport.zenoh.test_backend import TEXT, TIMEOUT_S, token

LATCHED = Qos(durability=Durability.TRANSIENT_LOCAL, depth=2)
TOPIC = "/kept"


class Reader:
    """Zenoh's own advanced subscriber, as rmw_zenoh has it."""

    def __init__(self, session: zenoh.Session, domain: int) -> None:
        self._received: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._subscriber = ext.declare_advanced_subscriber(
            session,
            f"{domain}{TOPIC}/{TEXT}",
            Callback(lambda sample: self._received.put(_text(sample.payload.to_bytes())), indirect=False),
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=2),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
            subscriber_detection=True,
        )

    def read(self, count: int) -> list[str]:
        return [self._received.get(timeout=TIMEOUT_S) for _ in range(count)]


class Writer:
    """Zenoh's own advanced publisher, as rmw_zenoh has it."""

    def __init__(self, session: zenoh.Session, domain: int) -> None:
        name = token(session, domain, "MP", TOPIC, TEXT).replace("::,10:", ":1:,2:")
        self._gid = gid_of(name)
        self._count = 0
        self._publisher = ext.declare_advanced_publisher(
            session,
            f"{domain}{TOPIC}/{TEXT}",
            cache=ext.CacheConfig(max_samples=2),
            sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5),
            publisher_detection=True,
        )
        self._token = session.liveliness().declare_token(name)

    def write(self, *texts: str, attaching: bool = True) -> None:
        for text in texts:
            self._count += 1
            attached = attachment.pack(self._count, time.time_ns(), self._gid) if attaching else None
            self._publisher.put(_cdr(text), attachment=attached)


def _cdr(text: str) -> bytes:
    return b"\0\1\0\0" + (len(text) + 1).to_bytes(4, "little") + text.encode() + b"\0"


def _text(data: bytes) -> str:
    return data[8:-1].decode()


def until(condition: Callable[[], Any]) -> None:
    """Look again and again: nothing tells of what happens within zenoh."""
    deadline = time.monotonic() + TIMEOUT_S
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.005)
    assert condition()


def say(publisher: Any, *texts: str) -> None:
    for text in texts:
        publisher.publish(String(data=text))


def test_zenohs_subscriber_has_our_history_whichever_comes_first(session: Session, stranger, domain):
    node = node_of(session, "me")
    early = Reader(stranger, domain)
    one = session.create_publisher(node, TOPIC, String, LATCHED)
    until(lambda: one._remote._publisher.matching_status.matching)
    say(one, "a", "b", "c")
    assert early.read(3) == ["a", "b", "c"]
    late = Reader(stranger, domain)
    assert late.read(2) == ["b", "c"]
    other = session.create_publisher(node, TOPIC, String, LATCHED)
    say(other, "d")
    say(one, "e")
    assert early.read(2) == late.read(2) == ["d", "e"]


def test_we_have_the_history_of_zenohs_publisher_whichever_comes_first(session: Session, stranger, domain):
    node = node_of(session, "me")
    early = subscribe(session, node, TOPIC, String, LATCHED)
    writer = Writer(stranger, domain)
    writer.write("a", "b")
    assert [message.data for message, _ in early.wait(2, TIMEOUT_S)] == ["a", "b"]
    writer.write("c")
    assert [message.data for message, _ in early.wait(3, TIMEOUT_S)] == ["a", "b", "c"]
    late = subscribe(session, node, TOPIC, String, LATCHED)
    assert [message.data for message, _ in late.wait(2, TIMEOUT_S)] == ["b", "c"]
    writer.write("d")
    assert [message.data for message, _ in late.wait(3, TIMEOUT_S)] == ["b", "c", "d"]


def test_samples_without_attachments_are_told_apart(session: Session, stranger, domain):
    writer = Writer(stranger, domain)
    writer.write("a", "b", attaching=False)
    inbox = subscribe(session, node_of(session, "me"), TOPIC, String, LATCHED)
    assert [message.data for message, _ in inbox.wait(2, TIMEOUT_S)] == ["a", "b"]
    writer.write("c", attaching=False)
    assert [message.data for message, _ in inbox.wait(3, TIMEOUT_S)] == ["a", "b", "c"]


def test_publishers_that_come_and_go_leave_no_keys(session: Session, stranger, domain):
    node = node_of(session, "me")

    def kept() -> list[str]:
        return [str(reply.ok.key_expr) for reply in stranger.liveliness().get("**/@adv/**") if reply.ok]

    first = [session.create_publisher(node, TOPIC, String, LATCHED) for _ in range(2)]
    until(kept)
    names = kept()
    assert names == [f"{domain}{TOPIC}/{TEXT}/@adv/pub/{session.backend._session_id}/uhlc/_"]
    first.pop().close()
    assert kept() == names
    first.pop().close()
    until(lambda: not kept())
    say(session.create_publisher(node, TOPIC, String, LATCHED), "again")
    assert Reader(stranger, domain).read(1) == ["again"]


def test_a_peer_that_dies_while_it_is_asked_blocks_nobody(session: Session, domain):
    node = node_of(session, "me")
    with Peer("keep", ROS_DOMAIN_ID=str(domain)).ready() as keeper:
        until(lambda: session.graph.endpoints(EndpointKind.PUBLISHER, name="/kept"))
        os.kill(keeper.process.pid, signal.SIGSTOP)
        subscriptions = [session.create_subscription(node, "/kept", Int32, LATCHED) for _ in range(3)]
        asker = keys.session_of(session.graph.endpoints(EndpointKind.PUBLISHER, name="/kept")[0].node.key)
        for one in subscriptions:
            one._remote.request_history(asker)  # as for a further publisher: the query is repeated when it has ended
    thread = threading.Thread(
        target=lambda: session.create_subscription(node, "/kept", Int32, LATCHED).close(), daemon=True
    )
    thread.start()
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()


def test_subscriptions_made_together_share_queries(session: Session, domain, monkeypatch):
    node, arrived = node_of(session, "me"), threading.Semaphore(0)
    asked = []
    monkeypatch.setattr(HistoryQueries, "_send", _noting(HistoryQueries._send, asked))
    with Peer("keep", ROS_DOMAIN_ID=str(domain)).ready():
        until(lambda: session.graph.endpoints(EndpointKind.PUBLISHER, name="/kept"))
        made = [session.create_subscription(node, "/kept", Int32, LATCHED, arrived.release) for _ in range(300)]
        for _ in range(2 * len(made)):
            assert arrived.acquire(timeout=TIMEOUT_S)
    assert {len(one) for one in made} == {2}
    assert len(asked) < len(made) // 2


def _noting(function: Callable[..., None], calls: list[Any]) -> Callable[..., None]:
    def call(*arguments: Any) -> None:
        calls.append(arguments)
        function(*arguments)

    return call


# History alone, against questions that the test answers.


class Oracle:
    """Stands for `HistoryQueries`: notes what it is asked, and answers when it is told to."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, str, History]] = []

    def request(self, key: str, session: str, asker: History) -> None:
        self.asked.append((key, session, asker))

    def answer(self, *samples: Any, in_time: bool = True) -> None:
        _, session, asker = self.asked.pop(0)
        asker.merge(session, list(samples), in_time)


def sample(number: int, stamp: int = 0, gid: bytes = b"g" * 16, session: str = "ab") -> Any:
    """Return a sample; without a stamp, one that is sent later than now."""
    attached = attachment.pack(number, stamp or 2**62 + number, gid)
    return SimpleNamespace(
        number=number,
        attachment=SimpleNamespace(to_bytes=lambda: attached),
        timestamp=SimpleNamespace(get_id=lambda: session),
    )


@pytest.fixture
def oracle() -> Oracle:
    return Oracle()


@pytest.fixture
def received() -> list[int]:
    return []


@pytest.fixture
def history(oracle: Oracle, received: list[int]) -> History:
    return History(oracle.request, "0/kept/x", 3, lambda one: received.append(one.number))


def test_what_was_kept_comes_before_what_is_sent(history, oracle, received):
    history.request_history("ab")
    assert oracle.asked == [("0/kept/x", "ab", history)]
    history.accept(sample(3))
    history.accept(sample(4))
    assert received == []
    oracle.answer(sample(2), sample(3), sample(1))
    assert received == [1, 2, 3, 4]
    history.accept(sample(3))  # it was on its way when it was answered
    history.accept(sample(5))
    assert received == [1, 2, 3, 4, 5]
    assert oracle.asked == []


def test_no_more_are_delivered_than_are_kept(history, oracle, received):
    other = b"o" * 16
    history.request_history("ab")
    for number in range(1, 6):
        history.accept(sample(number, stamp=number))
    history.accept(sample(6))
    history.accept(sample(8, gid=other))
    oracle.answer(sample(3, stamp=3), sample(4, stamp=4), sample(5, stamp=5))
    assert received == [4, 5, 6, 8]


def test_a_session_that_is_heard_before_it_is_known_is_asked(history, oracle, received):
    history.accept(sample(2))
    history.accept(sample(9, session="cd"))
    assert [session for _, session, _ in oracle.asked] == ["ab", "cd"]
    oracle.answer(sample(1))
    assert received == [1, 2]
    oracle.answer()
    assert received == [1, 2, 9]


def test_a_session_is_asked_again_for_a_further_publisher(history, oracle, received):
    other = b"o" * 16
    history.request_history("ab")
    history.request_history("ab")
    oracle.answer(sample(1))
    oracle.answer(sample(1), sample(7, gid=other))
    assert received == [1, 7]
    history.request_history("ab")  # as when a link was lost and came back
    oracle.answer(sample(1), sample(2), sample(7, gid=other))
    assert received == [1, 7, 2]


def test_a_session_that_does_not_answer_in_time_is_heard_and_asked_again(history, oracle, received):
    history.request_history("ab")
    history.accept(sample(2))
    oracle.answer(in_time=False)
    assert received == [2]
    history.accept(sample(3))
    oracle.answer(sample(1), sample(2))
    assert received == [2, 3]  # what is older than what was heard is history
    assert oracle.asked == []


def test_a_publisher_that_is_made_again_counts_anew(history, oracle, received):
    history.accept(sample(5, stamp=50))
    oracle.answer()
    history.request_history("ab")
    oracle.answer(sample(1, stamp=60))
    assert received == [5, 1]


def test_two_threads_deliver_in_order_and_who_is_closed_hears_nothing(oracle):
    received: list[int] = []

    def deliver(one: Any) -> None:
        received.append(one.number)
        if one.number == 1:
            history.accept(sample(2))  # as if it came while the first is being delivered
            received.append(-1)

    history = History(oracle.request, "0/kept/x", None, deliver)
    history.request_history("ab")
    oracle.answer(sample(1))
    assert received == [1, -1, 2]
    history.close()
    history.accept(sample(3))
    history.request_history("cd")
    assert (received, oracle.asked) == ([1, -1, 2], [])
