"""Processes that find each other whichever starts first, and go on whichever dies."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import Image
from std_msgs.msg import Int32

from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Qos, Reliability
from daidalos.transport.session import Session
from daidalos.transport.zenoh.config import shared_memory_usable
from transport.peers import Peer
from transport.test_sessions import Inbox, node_of, subscribe

TIMEOUT_S = 20.0
REDISCOVERY_S = 25.0
"""Processes that lost each other look for each other every five seconds; the library by itself does every thirty."""
SHORT_LEASE = "<CycloneDDS><Domain><Discovery><LeaseDuration>1s</LeaseDuration></Discovery></Domain></CycloneDDS>"


@pytest.fixture(autouse=True)
def _environment(middleware: str, domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Join the peers; DDS learns of a death when a lease runs out, here soon."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    monkeypatch.setenv("RMW_IMPLEMENTATION", middleware)
    monkeypatch.setenv("CYCLONEDDS_URI", SHORT_LEASE)


def names(session: Session) -> list[str]:
    return [node.name for node in session.graph.nodes()]


@pytest.mark.slow
def test_whichever_starts_first(new_session: Callable[[], Session]):
    with Peer("talk").ready() as first:
        session = new_session()
        inbox = subscribe(session, node_of(session, "me"), "/topic", Int32)
        assert len(inbox.wait(3, TIMEOUT_S)) >= 3
        with Peer("listen").ready() as second:
            second.wait_for("heard")
            first.kill()
            assert session.graph.wait_for(lambda: sorted(names(session)) == ["listener", "me"], TIMEOUT_S)
            publisher = session.create_publisher(node_of(session, "talker"), "/topic", Int32, Qos())
            assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
            deadline = time.monotonic() + TIMEOUT_S
            while not any("heard -5" in line for line in second.lines) and time.monotonic() < deadline:
                publisher.publish(Int32(data=-5))
                session.graph.wait_for(lambda: False, 0.05)
            second.wait_for("heard -5")


def _size(session: Session) -> tuple[int, int]:
    return len(session.graph.nodes()), len(session.graph.endpoints(EndpointKind.PUBLISHER))


@pytest.mark.slow
def test_a_large_graph_is_right_within_seconds(new_session: Callable[[], Session]):
    with Peer("crowd").ready(timeout_s=150.0):
        session = new_session()
        begin = time.monotonic()
        assert session.backend.settle(5.0)
        # What the other made last it may just be about to tell.
        left = begin + 5.0 - time.monotonic()
        assert session.graph.wait_for(lambda: _size(session) == (200, 3000), left), _size(session)
        with Peer("watch").ready() as watcher:
            watcher.wait_for("came node7")
    assert session.graph.wait_for(lambda: not session.graph.nodes() and not session.graph.endpoints(), TIMEOUT_S)


@pytest.mark.slow
def test_the_first_of_three_dies():
    with Peer("watch").ready() as first, Peer("listen").ready() as second, Peer("talk").ready() as third:
        first.wait_for("came talker")
        line = second.wait_for("heard")
        first.kill()
        second.wait_for("heard", len(second.lines))
        assert third.process.poll() is None
        assert line


@pytest.mark.slow
def test_who_is_killed_leaves_the_graph(new_session: Callable[[], Session]):
    session = new_session()
    with Peer("watch").ready() as watcher, Peer("talk").ready() as talker:
        line = watcher.wait_for("came talker")
        assert session.graph.wait_for(lambda: names(session) == ["talker"], TIMEOUT_S)
        talker.process.send_signal(signal.SIGKILL)
        watcher.wait_for("went talker", line)
        assert session.graph.wait_for(lambda: not names(session) and not session.graph.endpoints(), TIMEOUT_S)
        with Peer("talk").ready():
            watcher.wait_for("came talker", line)
            assert session.graph.wait_for(lambda: names(session) == ["talker"], TIMEOUT_S)


@pytest.mark.slow
def test_a_death_in_mid_message_harms_nobody(new_session: Callable[[], Session]):
    session = new_session()
    inbox = subscribe(session, node_of(session, "me"), "/topic", Image)
    with Peer("flood").ready() as flood:
        assert len(inbox.wait(2, TIMEOUT_S)) >= 2
        flood.process.send_signal(signal.SIGKILL)
        assert session.graph.wait_for(lambda: names(session) == ["me"], TIMEOUT_S)
    so_far = len(inbox.wait(10**6, 0.2))
    with Peer("flood").ready():
        assert len(inbox.wait(so_far + 2, TIMEOUT_S)) >= so_far + 2
    assert {len(message.data) for message, _ in inbox.taken} == {4_000_000}


@pytest.mark.slow
def test_a_service_that_dies_is_replaced(new_session: Callable[[], Session]):
    session = new_session()
    answers = Inbox()
    client = answers.entity = session.create_client(
        node_of(session, "me"), "/add", AddTwoInts, Qos(), lambda: answers.ready()
    )
    for round_number in (1, 2):
        with Peer("serve").ready():
            assert session.graph.wait_for(lambda: session.server_is_ready(client), TIMEOUT_S)
            client.send(AddTwoInts.Request(a=round_number, b=1))
            assert answers.wait(round_number, TIMEOUT_S)[-1][0].sum == round_number + 1
        assert session.graph.wait_for(lambda: not session.server_is_ready(client), TIMEOUT_S)


@pytest.mark.slow
@pytest.mark.parametrize("overlap", [False, True])
def test_a_request_whose_server_died_is_answered_by_the_next(new_session: Callable[[], Session], overlap: bool):
    session = new_session()
    answers = Inbox()
    client = answers.entity = session.create_client(
        node_of(session, "me"), "/add", AddTwoInts, Qos(), lambda: answers.ready()
    )
    with Peer("serve").ready() as first:
        assert session.graph.wait_for(lambda: session.server_is_ready(client), TIMEOUT_S)
        client.send(AddTwoInts.Request(a=0, b=0))
        assert answers.wait(1, TIMEOUT_S)
        first.process.send_signal(signal.SIGSTOP)
        client.send(AddTwoInts.Request(a=1, b=2))
        if not overlap:
            first.process.kill()
        with Peer("serve").ready():
            first.process.kill()
            assert [message.sum for message, *_ in answers.wait(2, TIMEOUT_S)] == [0, 3]


@pytest.mark.timing
def test_a_stopped_process_does_not_stop_others(new_session: Callable[[], Session], middleware: str):
    session = new_session()
    node = node_of(session, "me")
    publisher = session.create_publisher(node, "/topic", Image, Qos())
    inbox = subscribe(session, node, "/other", Int32)
    with Peer("talk").ready(), Peer("listen").ready() as listener:
        numbers = session.create_publisher(node, "/topic", Int32, Qos())
        assert session.graph.wait_for(
            lambda: len(session.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/topic")) == 1, TIMEOUT_S
        )
        listener.process.send_signal(signal.SIGSTOP)
        begin = time.monotonic()
        for number in range(200_000):
            numbers.publish(Int32(data=number))
            if time.monotonic() - begin > 8.0:
                break
        assert number > 1000, f"{middleware}: {number} messages in 8 s"
        listener.process.send_signal(signal.SIGCONT)
        line = len(listener.lines)
        deadline = time.monotonic() + REDISCOVERY_S
        while not any("heard -7" in text for text in listener.lines[line:]) and time.monotonic() < deadline:
            numbers.publish(Int32(data=-7))
            session.graph.wait_for(lambda: False, 0.05)
        listener.wait_for("heard -7", line, REDISCOVERY_S)
    assert publisher.endpoint.name == "/topic"
    assert inbox.wait(1, 0.0) == []


@pytest.mark.slow
def test_acknowledgements_are_waited_for_where_there_are_any(new_session: Callable[[], Session], middleware: str):
    session = new_session()
    publisher = session.create_publisher(node_of(session, "me"), "/topic", Int32, Qos())
    second = 10**9
    with Peer("listen").ready() as listener:
        assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        publisher.publish(Int32(data=1))
        assert publisher.wait_for_acks(10 * second)
        listener.process.send_signal(signal.SIGSTOP)
        publisher.publish(Int32(data=2))
        assert publisher.wait_for_acks(second // 5) is (middleware == "rmw_zenoh_cpp")
        listener.process.send_signal(signal.SIGCONT)
        assert publisher.wait_for_acks(None)
    publisher.close()
    assert publisher.wait_for_acks(None)


@pytest.mark.timing
def test_best_effort_never_waits(new_session: Callable[[], Session]):
    session = new_session()
    qos = Qos(reliability=Reliability.BEST_EFFORT, depth=5)
    publisher = session.create_publisher(node_of(session, "me"), "/topic", Image, qos)
    with Peer("look").ready() as stopped:
        assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        stopped.process.send_signal(signal.SIGSTOP)
        image = Image(data=bytes(1_000_000))
        times = []
        for _ in range(60):
            begin = time.monotonic()
            publisher.publish(image)
            times.append(time.monotonic() - begin)
        assert sorted(times)[-2] < 0.2
        assert sum(times) < 3.0


@pytest.mark.skipif(sys.platform != "linux", reason="looks where Linux tells of a process's memory")
def test_large_messages_go_through_shared_memory(new_session: Callable[[], Session], middleware: str):
    if middleware != "rmw_zenoh_cpp" or not shared_memory_usable():
        pytest.skip("only zenoh has shared memory, where there is enough of it")
    session = new_session()
    inbox = subscribe(session, node_of(session, "me"), "/topic", Image)
    with Peer("flood").ready() as flood:
        assert len(inbox.wait(2, TIMEOUT_S)) >= 2
        assert "/dev/shm/" in Path(f"/proc/{flood.process.pid}/maps").read_text()
    assert len(inbox.taken[0][0].data) == 4_000_000
