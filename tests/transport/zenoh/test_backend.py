"""The zenoh backend against a bare zenoh session that speaks rmw_zenoh's format by hand, and its configuration."""

from __future__ import annotations

import gc
import json
import shutil
import statistics
import struct
import subprocess
import threading
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import zenoh
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

from daidalos.transport.environment import DiscoveryRange, Environment, EnvironmentVariableError
from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Durability, Qos
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from daidalos.transport.zenoh import config as configuration
from daidalos.transport.zenoh.keys import gid_of
from daidalos.transport.zenoh.router import Router
from transport.peers import Peer
from transport.test_sessions import Inbox, node_of, subscribe

TIMEOUT_S = 20.0
TEXT = "std_msgs::msg::dds_::String_/RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD = (
    "example_interfaces::srv::dds_::AddTwoInts_/RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
)


def token(session: zenoh.Session, domain: int, kind: str, name: str, what: str) -> str:
    return f"@ros2_lv/{domain}/{session.zid()}/0/7/{kind}/%/%/robot/{name.replace('/', '%')}/{what}/::,10:,:,:,,"


def attachment(sequence: int, gid: bytes) -> bytes:
    return struct.pack("<qqB", sequence, time.time_ns(), 16) + gid


def test_a_publisher_that_writes_by_hand(session, stranger, domain):
    inbox = subscribe(session, node_of(session, "me"), "/chatter", String)
    mine = token(stranger, domain, "MP", "/chatter", TEXT)
    held = [
        stranger.liveliness().declare_token(f"@ros2_lv/{domain}/{stranger.zid()}/0/0/NN/%/%/robot"),
        stranger.liveliness().declare_token(mine),
    ]
    publisher = stranger.declare_publisher(f"{domain}/chatter/{TEXT}")
    matched = threading.Event()
    held.append(publisher.declare_matching_listener(lambda status: matched.set() if status.matching else None))
    assert session.graph.wait_for(
        lambda: bool(session.graph.endpoints(EndpointKind.PUBLISHER, name="/chatter")), TIMEOUT_S
    )
    assert publisher.matching_status.matching or matched.wait(TIMEOUT_S)
    publisher.put(b"\0\1\0\0\6\0\0\0hello\0", attachment=attachment(1, gid_of(mine)))
    message, item = inbox.wait(1, TIMEOUT_S)[0]
    assert message.data == "hello"
    info = inbox.entity.info(item)
    assert (info.gid, info.sequence) == (gid_of(mine), 1)
    assert [one.node.name for one in session.graph.endpoints() if one.gid == info.gid] == ["robot"]
    publisher.put(b"\0\1\0\0\6\0\0\0again\0")  # not even an attachment
    assert inbox.wait(2, TIMEOUT_S)[1][0].data == "again"
    assert held


def test_a_subscriber_that_reads_by_hand(session, stranger, domain):
    arrived: list[zenoh.Sample] = []
    news = threading.Event()
    subscriber = stranger.declare_subscriber(
        f"{domain}/chatter/{TEXT}", lambda sample: (arrived.append(sample), news.set())
    )
    held = stranger.liveliness().declare_token(token(stranger, domain, "MS", "/chatter", TEXT))
    publisher = session.create_publisher(node_of(session, "me"), "/chatter", String, Qos())
    assert session.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
    publisher.publish(String(data="hello"))
    assert news.wait(TIMEOUT_S)
    assert arrived[0].payload.to_bytes() == b"\0\1\0\0\6\0\0\0hello\0"
    sequence, stamp, length, gid = struct.unpack("<qqB16s", arrived[0].attachment.to_bytes())
    assert (sequence, length, gid) == (1, 16, publisher.endpoint.gid)
    assert abs(stamp - time.time_ns()) < 60 * 10**9
    tokens = [str(reply.ok.key_expr) for reply in stranger.liveliness().get(f"@ros2_lv/{domain}/**")]
    assert gid_of(next(one for one in tokens if "/MP/" in one)) == publisher.endpoint.gid
    assert held
    subscriber.undeclare()


def test_a_client_that_asks_by_hand(session, stranger, domain):
    requests = Inbox()
    service = requests.entity = session.create_service(
        node_of(session, "me"), "/add", AddTwoInts, Qos(), lambda: requests.ready()
    )
    gid = bytes(range(16))
    answers: list[Any] = []
    done = threading.Event()
    key = f"{domain}/add/{ADD}"
    deadline = time.monotonic() + TIMEOUT_S
    querier = stranger.declare_querier(key, target=zenoh.QueryTarget.ALL_COMPLETE)
    while not querier.matching_status.matching and time.monotonic() < deadline:
        session.graph.wait_for(lambda: False, 0.01)
    querier.get(
        lambda reply: (answers.append(reply), done.set()),
        payload=b"\0\1\0\0" + struct.pack("<qq", 3, 4),
        attachment=attachment(5, gid),
    )
    request, identity, *_ = requests.wait(1, TIMEOUT_S)[0]
    assert (request.a, request.b, identity.client, identity.sequence) == (3, 4, gid, 5)
    service.reply(identity, AddTwoInts.Response(sum=7))
    assert done.wait(TIMEOUT_S)
    assert answers[0].ok.payload.to_bytes() == b"\0\1\0\0" + struct.pack("<q", 7)
    sequence, _, _, client = struct.unpack("<qqB16s", answers[0].ok.attachment.to_bytes())
    assert (sequence, client) == (5, gid)


def test_tokens_that_are_none_of_ros_harm_nobody(session, stranger, domain):
    held = [
        stranger.liveliness().declare_token(f"@ros2_lv/{domain}{rest}")
        for rest in ("", "/x", "/a/b/c/NN/%/%/x", "/a/x/y/MP/%/%/x/%t/q/w/e", "/a/1/2/MP/%/%/x")
    ]
    held.append(stranger.liveliness().declare_token(f"@ros2_lv/{domain}/{stranger.zid()}/0/0/NN/%/%/robot"))
    assert session.graph.wait_for(lambda: [one.name for one in session.graph.nodes()] == ["robot"], TIMEOUT_S)
    held.pop().undeclare()
    assert session.graph.wait_for(lambda: not session.graph.nodes(), TIMEOUT_S)


GARBAGE = (
    b"",
    b"\0",
    b"\0\1\0\0",
    b"\0\1\0\0\xff\xff\xff\xff",
    b"\0\1\0\0\6\0\0\0\xff\xfe\xfd\xfc\xfb\0",
    b"x" * 100_000,
)
ATTACHMENTS = (None, b"", b"\0", bytes(33), b"\xff" * 33, b"x" * 10_000)


def test_garbage_of_a_peer_is_lost_alone(session, stranger, domain):
    inbox = subscribe(session, node_of(session, "me"), "/chatter", String)
    mine = token(stranger, domain, "MP", "/chatter", TEXT)
    held = stranger.liveliness().declare_token(mine)
    publisher = stranger.declare_publisher(f"{domain}/chatter/{TEXT}")
    matched = threading.Event()
    listener = publisher.declare_matching_listener(lambda status: matched.set() if status.matching else None)
    assert publisher.matching_status.matching or matched.wait(TIMEOUT_S)
    for payload in GARBAGE:
        for extra in ATTACHMENTS:
            publisher.put(payload, attachment=extra)
    for extra in ATTACHMENTS:
        list(stranger.get(f"{domain}/chatter/{TEXT}", payload=b"x", attachment=extra, timeout=0.1))
    deadline = time.monotonic() + TIMEOUT_S
    received: list[str] = []
    while "hello" not in received:
        assert time.monotonic() < deadline
        publisher.put(b"\0\1\0\0\6\0\0\0hello\0", attachment=attachment(1, gid_of(mine)))
        received += [message.data for message, _ in inbox.wait(len(inbox.taken) + 1, 0.5)]
    assert held
    assert listener


def test_a_path_that_is_too_long_for_a_socket_is_no_obstacle(domain, tmp_path, monkeypatch):
    folder = tmp_path / ("long" * 20)
    folder.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
    one, other = (Session(make_backend(Environment(domain))) for _ in range(2))
    try:
        node_of(one, "here")
        assert other.graph.wait_for(lambda: bool(other.graph.nodes()), TIMEOUT_S)
    finally:
        one.close()
        other.close()
    left = {path.name for path in (folder / "daidalos" / "zenoh" / str(domain)).iterdir()}
    assert left == {"registry.lock"}


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="looks where Linux lists open files")
def test_sessions_that_were_closed_keep_no_files_open(domain):
    def open_files() -> int:
        return len(list(Path("/proc/self/fd").iterdir()))

    counts = []
    for _ in range(4):
        session = Session(make_backend(Environment(domain)))
        node, leave = session.create_node("me", "/")
        session.create_publisher(node, "/kept", String, Qos(durability=Durability.TRANSIENT_LOCAL))
        session.close()
        del session, leave
        gc.collect()
        counts.append(open_files())
    # What other tests left behind may close meanwhile, but only once.
    assert statistics.median(after - before for before, after in pairwise(counts)) == 0


def settings_of(environment: Environment, **variables: str) -> Callable[[str], Any]:
    config = configuration.session_config(environment, "ab" * 16, ["unixsock-stream/a"], ["unixsock-stream/b"])
    return lambda key: json.loads(config.get_json(key))


def test_by_default_nothing_listens_to_the_network_nor_to_other_users():
    get = settings_of(Environment())
    assert get("listen/endpoints") == ["unixsock-stream/a"]
    assert get("connect/endpoints") == ["unixsock-stream/b", "tcp/localhost:7447"]
    assert get("scouting/multicast/enabled") is False


def test_the_subnet_is_looked_at_when_that_is_asked_for():
    get = settings_of(Environment(discovery=DiscoveryRange.SUBNET))
    assert get("listen/endpoints")[1].startswith("tcp/[::]:0")
    assert get("scouting/multicast/enabled") is True


def test_off_means_nobody():
    get = settings_of(Environment(discovery=DiscoveryRange.OFF, static_peers=("10.0.0.1",)))
    assert get("connect/endpoints") == []
    assert get("scouting/gossip/enabled") is False


@pytest.mark.parametrize(
    ("peer", "endpoint"),
    [
        ("10.0.0.1", "tcp/10.0.0.1:7447"),
        ("robot.local:7500", "tcp/robot.local:7500"),
        ("[fe80::1]:7500", "tcp/[fe80::1]:7500"),
        ("[fe80::1]", "tcp/[fe80::1]:7447"),
        ("tls/robot:7447", "tls/robot:7447"),
    ],
)
def test_static_peers(peer, endpoint):
    assert endpoint in settings_of(Environment(static_peers=(peer,)))("connect/endpoints")


def test_overrides_come_last(monkeypatch):
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", 'mode="client";connect/endpoints=["tcp/10.0.0.9:7447"]')
    get = settings_of(Environment())
    assert (get("mode"), get("connect/endpoints")) == ("client", ["tcp/10.0.0.9:7447"])
    for text in ("nonsense", "no/such/key=1", "mode=peer"):
        monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", text)
        with pytest.raises(EnvironmentVariableError, match=r"ZENOH_CONFIG_OVERRIDE: .*expected key=value"):
            settings_of(Environment())


def test_a_file_rules(tmp_path, monkeypatch):
    file = tmp_path / "session.json5"
    file.write_text(
        '{mode: "client", connect: {endpoints: ["tcp/10.0.0.9:7447"]}, transport: {shared_memory: {enabled: false}}}'
    )
    monkeypatch.setenv("ZENOH_SESSION_CONFIG_URI", str(file))
    get = settings_of(Environment())
    assert (get("mode"), get("connect/endpoints")) == ("client", ["tcp/10.0.0.9:7447"])
    assert get("transport/shared_memory/enabled") is False
    assert get("timestamping/enabled") is True
    for text, words in (("{mode:", "expected"), (None, "No such file")):
        file.write_text(text) if text else file.unlink()
        with pytest.raises(EnvironmentVariableError, match=f"ZENOH_SESSION_CONFIG_URI is .*{words}") as caught:
            settings_of(Environment())
        assert "\n" not in str(caught.value)


def router_at(port: int, monkeypatch: pytest.MonkeyPatch) -> Router:
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f'listen/endpoints=["tcp/127.0.0.1:{port}"]')
    try:
        return Router()
    finally:
        monkeypatch.delenv("ZENOH_CONFIG_OVERRIDE")


def free_port() -> int:
    import socket

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.mark.slow
def test_a_router_joins_who_would_not_meet_and_may_come_late(domain, tmp_path, monkeypatch):
    port = free_port()
    sessions = []
    for name in ("one", "two"):
        folder = tmp_path / name  # as on two machines: no registry in common
        folder.mkdir()
        monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
        sessions.append(Session(make_backend(Environment(domain, static_peers=(f"127.0.0.1:{port}",)))))
    one, two = sessions
    try:
        inbox = subscribe(one, node_of(one, "listener"), "/chatter", String)
        publisher = two.create_publisher(node_of(two, "talker"), "/chatter", String, Qos())
        router = router_at(port, monkeypatch)
        assert two.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        publisher.publish(String(data="hello"))
        assert inbox.wait(1, TIMEOUT_S)[0][0].data == "hello"
        router.close()
    finally:
        one.close()
        two.close()


@pytest.mark.slow
def test_a_port_that_is_taken_is_an_error_in_words(monkeypatch):
    port = free_port()
    router = router_at(port, monkeypatch)
    try:
        with pytest.raises(EnvironmentVariableError, match=f"cannot start: .*{port}.*in use"):
            router_at(port, monkeypatch)
    finally:
        router.close()


def certificates(folder: Path) -> None:
    """Make an authority, and a key and certificate for localhost."""

    def openssl(*words: str) -> None:
        subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)

    key = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes")
    openssl("req", "-x509", *key, "-keyout", "ca.key", "-out", "ca.pem", "-subj", "/CN=lab", "-days", "2")
    for who in ("robot", "thief"):
        openssl("req", *key, "-keyout", f"{who}.key", "-out", f"{who}.csr", "-subj", f"/CN={who}")
        (folder / "names").write_text("subjectAltName=DNS:localhost,IP:127.0.0.1\n")
        signer = ("-CA", "ca.pem", "-CAkey", "ca.key") if who == "robot" else ("-signkey", "thief.key")
        openssl("x509", "-req", "-in", f"{who}.csr", *signer, "-out", f"{who}.pem", "-days", "2", "-extfile", "names")


def tls_file(folder: Path, who: str, mode: str, endpoint: str) -> Path:
    """Write a configuration file by which only holders of the authority's certificates meet."""
    place = "listen" if mode == "router" else "connect"
    file = folder / f"{who}-{mode}.json5"
    file.write_text(json.dumps({
        "mode": mode,
        place: {"endpoints": [endpoint]},
        "scouting": {"multicast": {"enabled": False}},
        "transport": {"link": {"tls": {
            "root_ca_certificate": str(folder / "ca.pem"),
            "listen_private_key": str(folder / f"{who}.key"),
            "listen_certificate": str(folder / f"{who}.pem"),
            "connect_private_key": str(folder / f"{who}.key"),
            "connect_certificate": str(folder / f"{who}.pem"),
            "enable_mtls": True,
        }}},
    }))  # fmt: skip
    return file


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("openssl") is None, reason="there is no openssl to make certificates with")
def test_with_tls_only_those_with_a_certificate_meet(domain, tmp_path, monkeypatch):
    certificates(tmp_path)
    endpoint = f"tls/localhost:{free_port()}"
    monkeypatch.setenv("ZENOH_ROUTER_CONFIG_URI", str(tls_file(tmp_path, "robot", "router", endpoint)))
    router = Router()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    trusted = str(tls_file(tmp_path, "robot", "client", endpoint))
    monkeypatch.setenv("ZENOH_SESSION_CONFIG_URI", trusted)
    session = Session(make_backend(Environment(domain)))
    try:
        publisher = session.create_publisher(node_of(session, "talker"), "/topic", String, Qos())
        with Peer("watch").ready() as watcher:
            watcher.wait_for("came talker")
        thief = str(tls_file(tmp_path, "thief", "client", endpoint))
        with Peer("watch", ZENOH_SESSION_CONFIG_URI=thief) as other:
            other.wait_for("zenoh cannot open a session")
            assert not any("came" in line for line in other.lines)
        assert publisher.endpoint.name == "/topic"
    finally:
        session.close()
        router.close()
