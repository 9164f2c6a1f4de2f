"""The DDS backend against a program that uses another encoder and nothing of ours."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

from daidalos.transport.environment import Environment, EnvironmentVariableError
from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Durability, History, Qos
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from transport.peers import Peer
from transport.test_sessions import Inbox, node_of, subscribe

pytest.importorskip("cyclonedds")

PARTNER = Path(__file__).with_name("partner.py")
TIMEOUT_S = 20.0
LOCAL = (
    "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General><Discovery>"
    '<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers>'
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><LeaseDuration>1s</LeaseDuration>"
    "</Discovery></Domain></CycloneDDS>"
)


@pytest.fixture
def session(domain: int) -> Iterator[Session]:
    session = Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
    yield session
    session.close()


def partner(role: str, domain: int) -> Peer:
    return Peer(role, script=PARTNER, ROS_DOMAIN_ID=str(domain), CYCLONEDDS_URI=LOCAL)


@pytest.mark.slow
def test_topics_cross(session, domain):
    node = node_of(session, "me")
    publisher = session.create_publisher(node, "/ping", String, Qos())
    inbox = subscribe(session, node, "/pong", String)
    with partner("echo", domain).ready():
        assert session.graph.wait_for(
            lambda: bool(session.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/ping")), TIMEOUT_S
        )
        assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        stranger = session.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/ping")[0]
        assert stranger.node.name == "_NODE_NAME_UNKNOWN_"
        assert session.graph.wait_for(
            lambda: bool(session.graph.endpoints(EndpointKind.PUBLISHER, name="/pong")), TIMEOUT_S
        )
        for text in ("one", "two", "drei", ""):
            publisher.publish(String(data=text))
        answers = [message.data for message, _ in inbox.wait(4, TIMEOUT_S)]
        assert answers == ["one back", "two back", "drei back", " back"]
    assert session.graph.wait_for(lambda: not publisher.has_subscribers, TIMEOUT_S)


@pytest.mark.slow
def test_a_request_and_its_reply_are_those_of_rmw_cyclonedds(session, domain):
    requests = Inbox()
    service = requests.entity = session.create_service(
        node_of(session, "server"), "/add", AddTwoInts, Qos(), lambda: requests.ready()
    )
    script = [sys.executable, "-P", str(PARTNER), "call"]
    with partner("nodes", domain).ready() as watcher:
        watcher.wait_for("/ server")
        with subprocess.Popen(
            script, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=_environment(domain)
        ) as process:
            try:
                assert process.stdout.readline() == "ready\n"
                assert session.graph.wait_for(
                    lambda: bool(session.graph.endpoints(EndpointKind.CLIENT, name="/add")), TIMEOUT_S
                )
                process.stdin.write("\n")
                process.stdin.flush()
                request, identity, *_ = requests.wait(1, TIMEOUT_S)[0]
                assert (request.a, request.b, identity.sequence) == (3, 4, 7)
                service.reply(identity, AddTwoInts.Response(sum=7))
                assert process.stdout.readline() == "123456789abcdef 7 7\n"
            finally:
                process.kill()


def _environment(domain: int) -> dict[str, str]:
    import os

    return os.environ | {"ROS_DOMAIN_ID": str(domain), "CYCLONEDDS_URI": LOCAL}


@pytest.mark.slow
def test_others_are_told_of_nodes_and_what_is_theirs(session, domain):
    with partner("nodes", domain).ready() as watcher:
        node, remove = session.create_node("arm", "/cell", "/welding")
        watcher.wait_for("/cell arm")
        publisher = session.create_publisher(node, "/topic", String, Qos())
        watcher.wait_for(publisher.endpoint.gid.hex())
        service = session.create_service(node, "/add", AddTwoInts, Qos())
        line = watcher.wait_for(service.endpoint.gid.hex())
        _, _, participant, *gids = watcher.lines[line - 1].split()
        assert len(gids) == 3  # a writer; the reader and the writer of the service
        assert {gid[:24] for gid in gids} == {participant[:24]}
        assert participant.endswith("000001c1")
        remove()


@pytest.mark.slow
def test_kept_samples_are_limited_by_the_depth_that_was_asked_for(session, domain):
    node = node_of(session, "me")
    qos = Qos(durability=Durability.TRANSIENT_LOCAL, depth=2)
    publisher = session.create_publisher(node, "/topic", String, qos)
    for number in range(100):
        publisher.publish(String(data=str(number)))
    other = Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
    try:
        inbox = subscribe(
            other, node_of(other, "late"), "/topic", String,
            Qos(durability=Durability.TRANSIENT_LOCAL, history=History.KEEP_ALL),
        )  # fmt: skip
        assert [message.data for message, _ in inbox.wait(3, 1.0)] == ["98", "99"]
    finally:
        other.close()


@pytest.mark.slow
def test_two_domains_do_not_meet(session, domain):
    other = Session(make_backend(Environment((domain + 1) % 230, middleware="rmw_cyclonedds_cpp")))
    try:
        node_of(session, "here")
        assert not other.graph.wait_for(lambda: bool(other.graph.nodes()), 0.5)
    finally:
        other.close()


def test_a_configuration_that_is_none_is_an_error_in_words(domain, monkeypatch):
    monkeypatch.setenv("CYCLONEDDS_URI", "<CycloneDDS><Nonsense/></CycloneDDS>")
    with pytest.raises(EnvironmentVariableError, match="CYCLONEDDS_URI"):
        Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
    monkeypatch.delenv("CYCLONEDDS_URI")
    Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp"))).close()


def test_who_lacks_the_extra_is_told_the_command_that_adds_it(domain):
    program = (
        "import sys, importlib.util as u; find = u.find_spec\n"
        "u.find_spec = lambda name, *rest: None if name == 'cyclonedds' else find(name, *rest)\n"
        "import rclpy\n"
        "try:\n    rclpy.init()\n    rclpy.create_node('x')\n"
        "except Exception as error:\n    print(error)\n"
    )
    environment = _environment(domain) | {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=60)
    assert "pip install 'daidalos[dds]'" in done.stdout, done


def test_what_a_node_over_dds_loads_is_small():
    heavy = {"urllib.request", "http", "numpy"}
    code = f"import sys, daidalos.transport.cyclonedds.backend; print(*{heavy} & set(sys.modules))"
    loaded = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    assert loaded.stdout == "\n"
