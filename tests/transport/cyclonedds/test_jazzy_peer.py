"""The DDS backend beside a process that behaves as ROS 2 Jazzy's middleware."""

from __future__ import annotations

import logging
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from sensor_msgs.msg import Image
from std_msgs.msg import Int32, String

from daidalos.transport.environment import DiscoveryRange, Environment
from daidalos.transport.graph import EndpointKind
from daidalos.transport.publisher import Publisher
from daidalos.transport.qos import Qos
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from transport.cyclonedds.test_backend import LOCAL, TIMEOUT_S
from transport.peers import Peer
from transport.test_sessions import node_of

pytest.importorskip("cyclonedds")

SCRIPT = Path(__file__).with_name("jazzy_peer.py")
IMAGE_BYTES = 16_000_000


@pytest.fixture
def session(domain: int) -> Iterator[Session]:
    session = Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
    yield session
    session.close()


# What ROS 2 configures for its default range, SUBNET: others are found by multicast alone.
SUBNET = (
    "<CycloneDDS><Domain><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex></Discovery></Domain></CycloneDDS>"
)


def peer(role: str, domain: int, uri: str = LOCAL) -> Peer:
    return Peer(role, script=SCRIPT, ROS_DOMAIN_ID=str(domain), CYCLONEDDS_URI=uri)


@pytest.mark.slow
def test_large_messages_within_the_depth_all_arrive(session, domain):
    node = node_of(session, "camera")
    publisher = session.create_publisher(node, "/image", Image, Qos(depth=5))
    with peer("images", domain).ready() as subscriber:
        assert session.graph.wait_for(
            lambda: bool(session.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/image")), TIMEOUT_S
        )
        for number in range(5):
            publisher.publish(Image(data=bytes(IMAGE_BYTES + number)))
        line = 0
        for _ in range(5):
            line = subscriber.wait_for("got", line)
        assert len({text for text in subscriber.lines if "got" in text}) >= 2  # lengths are padded to four bytes
        assert publisher.wait_for_acks(int(TIMEOUT_S * 1e9))


@pytest.mark.slow
def test_a_subscriber_that_stops_costs_messages_that_are_counted_and_named(session, domain, caplog):
    node = node_of(session, "camera")
    publisher = session.create_publisher(node, "/image", Image, Qos(depth=2))
    with peer("images", domain).ready() as subscriber:
        assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        os.kill(subscriber.process.pid, signal.SIGSTOP)
        with caplog.at_level(logging.WARNING):
            for _ in range(20):
                publisher.publish(Image(data=bytes(1_000_000)))
        assert "on '/image'" in caplog.text
        assert "depth of the publisher is 2" in caplog.text
        os.kill(subscriber.process.pid, signal.SIGCONT)
        subscriber.wait_for("got")


def test_a_message_published_as_soon_as_dds_has_matched_arrives(session, domain):
    publisher = session.create_publisher(node_of(session, "talker"), "/text", String, Qos())
    with peer("texts", domain).ready() as subscriber:
        assert session.graph.wait_for(lambda: publisher.wire_has_readers, TIMEOUT_S)
        publisher.publish(String(data="early"))
        subscriber.wait_for("got")
        assert not session.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/text")


@pytest.mark.slow
def test_settling_waits_for_a_participant_that_has_not_listed_its_nodes(domain):
    with peer("slow_node", domain).ready():
        session = Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
        try:
            assert session.backend.settle(TIMEOUT_S)
            assert [node.name for node in session.graph.nodes()] == ["slow"]
        finally:
            session.close()


@pytest.mark.slow
@pytest.mark.parametrize("reach", [DiscoveryRange.LOCALHOST, DiscoveryRange.SUBNET])
def test_a_program_of_ros_2s_default_range_hears_us_whoever_starts_first(domain, reach):
    with peer("texts", domain, SUBNET).ready() as earlier:
        session = Session(make_backend(Environment(domain, reach, middleware="rmw_cyclonedds_cpp")))
        try:
            publisher = session.create_publisher(node_of(session, "talker"), "/text", String, Qos())
            with peer("texts", domain, SUBNET).ready() as later:
                for listener in (earlier, later):
                    publish_until_heard(session, publisher, listener)
        finally:
            session.close()


@pytest.mark.slow
def test_our_own_program_of_the_wider_range_hears_one_of_the_narrower(domain, session):
    publisher = session.create_publisher(node_of(session, "talker"), "/topic", Int32, Qos())
    wider = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}
    with Peer("listen", ROS_DOMAIN_ID=str(domain), **wider).ready() as listener:
        assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        publisher.publish(Int32(data=1))
        listener.wait_for("heard 1")


def publish_until_heard(session: Session, publisher: Publisher, listener: Peer) -> None:
    """Publish until a peer has got a text; whether one peer more is matched cannot be asked."""
    deadline = time.monotonic() + TIMEOUT_S
    while not any("got" in line for line in listener.lines):
        assert time.monotonic() < deadline, "nothing was heard"
        publisher.publish(String(data="again"))
        session.graph.wait_for(lambda: False, 0.05)
