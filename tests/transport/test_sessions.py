"""Sessions that meet over a middleware: topics, services, the graph; alike over each."""

from __future__ import annotations

import threading
import time
from array import array
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import pytest
from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import Image
from std_msgs.msg import Int32, String
from test_msgs.msg import WStrings

from daidalos.interfaces.codec import CdrError, codec_of
from daidalos.transport.environment import Environment
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo, names_and_types
from daidalos.transport.qos import Durability, History, Qos, Reliability, incompatibilities
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from daidalos.transport.subscription import Subscription

TIMEOUT_S = 10.0
LATCHED = Qos(durability=Durability.TRANSIENT_LOCAL, depth=3)
_KEPT: WeakKeyDictionary[Session, list[Callable[[], None]]] = WeakKeyDictionary()
BEST_EFFORT = Qos(reliability=Reliability.BEST_EFFORT, depth=5)


class Inbox:
    """Collects what a subscription, service or client gets ready."""

    def __init__(self) -> None:
        self._news = threading.Condition()
        self.entity: Any = None
        self.taken: list[Any] = []
        self._arrived = 0

    def ready(self) -> None:
        with self._news:
            self._arrived += 1
            self._news.notify_all()

    def wait_untaken(self, count: int) -> bool:
        """Wait until `count` items have arrived, and take none."""
        with self._news:
            return self._news.wait_for(lambda: self._arrived >= count, TIMEOUT_S)

    def wait(self, count: int, timeout_s: float = TIMEOUT_S) -> list[Any]:
        """Return at least `count` items, or what came until time ran out."""
        deadline = time.monotonic() + timeout_s
        while True:
            while (item := self.entity.take()) is not None:
                self.taken.append(item)
            if len(self.taken) >= count or (left := deadline - time.monotonic()) <= 0:
                return self.taken
            with self._news:
                if not len(self.entity):
                    self._news.wait(left)


def node_of(session: Session, name: str, namespace: str = "/") -> NodeInfo:
    node, remove = session.create_node(name, namespace)
    _KEPT.setdefault(session, []).append(remove)  # a node leaves when nobody refers to it any more
    return node


def subscribe(session: Session, node: NodeInfo, topic: str, kind: Any, qos: Qos = Qos()) -> Inbox:  # noqa: B008
    inbox = Inbox()
    inbox.entity = session.create_subscription(node, topic, kind, qos, inbox.ready)
    return inbox


def meet(session: Session, count: int, *kinds: EndpointKind, name: str) -> list[EndpointInfo]:
    """Wait until a session knows so many endpoints of a name."""
    assert session.graph.wait_for(lambda: len(session.graph.endpoints(*kinds, name=name)) == count, TIMEOUT_S)
    return session.graph.endpoints(*kinds, name=name)


@pytest.fixture
def two(new_session: Callable[[], Session]) -> tuple[Session, Session]:
    return new_session(), new_session()


def connected(two: tuple[Session, Session], kind: Any, qos: Qos = Qos()) -> tuple[Any, Inbox]:  # noqa: B008
    """Make a publisher in one session that is matched with a subscription in the other."""
    here, there = two
    inbox = subscribe(there, node_of(there, "listener"), "/topic", kind, qos)
    publisher = here.create_publisher(node_of(here, "talker"), "/topic", kind, qos)
    meet(here, 1, EndpointKind.SUBSCRIPTION, name="/topic")
    meet(there, 1, EndpointKind.PUBLISHER, name="/topic")
    return publisher, inbox


def test_messages_arrive_in_order_with_what_is_known_of_them(two):
    publisher, inbox = connected(two, String)
    before = time.time_ns()
    for number in range(10):
        publisher.publish(String(data=f"message {number}"))
    assert [message.data for message, _ in inbox.wait(10)] == [f"message {number}" for number in range(10)]
    subscription: Subscription = inbox.entity
    info = subscription.info(inbox.taken[0][1])
    assert info.gid == publisher.endpoint.gid
    assert before <= info.source_ns <= info.received_ns <= time.time_ns()


def test_serialised_messages_are_sent_as_they_are(two):
    publisher, inbox = connected(two, String)
    data = codec_of(String).encode(String(data="raw"))
    publisher.publish(data)
    assert inbox.wait(1)[0][0] == String(data="raw")
    publisher.publish(String(data="raw"))
    deadline = time.monotonic() + TIMEOUT_S
    while (taken := inbox.entity.take_raw()) is None:
        assert time.monotonic() < deadline
        threading.Event().wait(0.01)
    assert taken[0].rstrip(b"\0") == data.rstrip(b"\0")


def test_bytes_that_are_no_message_are_passed_over(two, caplog):
    publisher, inbox = connected(two, String)
    publisher.publish(b"\0\1\0\0\xff\xff\xff\xff")
    publisher.publish(String(data="after"))
    assert [message.data for message, _ in inbox.wait(1)] == ["after"]
    assert "dropped a message on '/topic'" in caplog.text
    with pytest.raises(TypeError, match=r"Expected .*String.*, got .*int"):
        publisher.publish(5)
    message = String()
    message._data = 7
    with pytest.raises(CdrError, match="'data'"):
        publisher.publish(message)


def test_a_large_message_arrives_whole(two):
    publisher, inbox = connected(two, Image)
    data = np.random.default_rng(1).integers(0, 256, 6_000_001, np.uint8)
    publisher.publish(Image(width=7, data=data))
    image = inbox.wait(1)[0][0]
    assert image.width == 7
    assert image.data == array("B", data.tobytes())


def test_wide_strings_cross(two):
    publisher, inbox = connected(two, WStrings)
    publisher.publish(WStrings(wstring_value="Ωμέγα"))
    assert inbox.wait(1)[0][0].wstring_value == "Ωμέγα"


@pytest.mark.slow
def test_reliable_loses_nothing_that_the_depth_allows(two):
    count = 20_000
    publisher, inbox = connected(two, Int32, Qos(depth=count))
    sender = threading.Thread(target=lambda: [publisher.publish(Int32(data=number)) for number in range(count)])
    sender.start()
    received = inbox.wait(count, 60.0)
    sender.join()
    assert [message.data for message, _ in received] == list(range(count))


def test_keep_last_keeps_the_last(two):
    publisher, inbox = connected(two, Int32, Qos(depth=3))
    for number in range(50):
        publisher.publish(Int32(data=number))
    assert inbox.wait_untaken(50)
    assert [message.data for message, _ in inbox.wait(3)] == [47, 48, 49]


def test_latecomers_get_what_is_kept_for_them(two):
    here, there = two
    publisher = here.create_publisher(node_of(here, "talker"), "/map", Int32, LATCHED)
    for number in range(5):
        publisher.publish(Int32(data=number))
    late = subscribe(there, node_of(there, "late"), "/map", Int32, LATCHED)
    assert [message.data for message, _ in late.wait(3)] == [2, 3, 4]
    volatile = subscribe(there, node_of(there, "volatile"), "/map", Int32)
    meet(here, 2, EndpointKind.SUBSCRIPTION, name="/map")
    publisher.publish(Int32(data=5))
    assert [message.data for message, _ in late.wait(4)] == [2, 3, 4, 5]
    assert [message.data for message, _ in volatile.wait(1)] == [5]


def test_best_effort_does_not_serve_who_asks_for_reliable(two):
    here, there = two
    node = node_of(there, "listener")
    strict = subscribe(there, node, "/topic", Int32)
    lax = subscribe(there, node, "/topic", Int32, BEST_EFFORT)
    publisher = here.create_publisher(node_of(here, "talker"), "/topic", Int32, BEST_EFFORT)
    meet(here, 2, EndpointKind.SUBSCRIPTION, name="/topic")
    meet(there, 1, EndpointKind.PUBLISHER, name="/topic")
    publisher.publish(Int32(data=1))
    assert [message.data for message, _ in lax.wait(1)] == [1]
    assert strict.wait(1, 0.2) == []
    assert [one.qos for one in here.matching_endpoints(publisher.endpoint)] == [BEST_EFFORT]


def test_topics_of_one_name_and_two_types_do_not_mix(two):
    here, there = two
    texts = subscribe(there, node_of(there, "texts"), "/topic", String)
    numbers = subscribe(there, node_of(there, "numbers"), "/topic", Int32)
    publisher = here.create_publisher(node_of(here, "talker"), "/topic", Int32, Qos())
    meet(here, 2, EndpointKind.SUBSCRIPTION, name="/topic")
    publisher.publish(Int32(data=1))
    assert len(numbers.wait(1)) == 1
    assert texts.wait(1, 0.2) == []


def test_within_a_session_a_snapshot_is_delivered_once_and_without_the_wire(new_session):
    session = new_session()
    node = node_of(session, "both")
    inbox = subscribe(session, node, "/topic", Image)
    publisher = session.create_publisher(node, "/topic", Image, Qos())
    image = Image(data=b"abc")
    publisher.publish(image)
    image.data[0] = 0
    taken = inbox.wait(2, 0.3)
    assert [bytes(message.data) for message, _ in taken] == [b"abc"]
    assert taken[0][0] is not image
    taken[0][0].data[0] = 9
    publisher.publish(image)
    assert bytes(inbox.wait(2)[1][0].data) == b"\0bc"


def test_a_service_answers_each_client(two):
    here, there = two
    requests = Inbox()
    service = requests.entity = here.create_service(node_of(here, "server"), "/add", AddTwoInts, Qos(), requests.ready)
    inboxes = []
    for number in range(3):
        inbox = Inbox()
        session = (here, there, there)[number]
        node = node_of(session, f"client{number}")
        inbox.entity = session.create_client(node, "/add", AddTwoInts, Qos(), inbox.ready)
        assert session.graph.wait_for(lambda s=session, i=inbox: s.server_is_ready(i.entity), TIMEOUT_S)
        inboxes.append(inbox)
    meet(here, 3, EndpointKind.CLIENT, name="/add")
    sent = [inbox.entity.send(AddTwoInts.Request(a=number, b=10)) for number, inbox in enumerate(inboxes)]
    clients = set()
    for request, identity, stamp, received in requests.wait(3):
        assert 0 < stamp <= received
        clients.add(identity.client)
        service.reply(identity, AddTwoInts.Response(sum=request.a + request.b))
    assert len(clients) == 3
    for number, inbox in enumerate(inboxes):
        response, sequence, *_ = inbox.wait(1)[0]
        assert (response.sum, sequence) == (10 + number, sent[number])
        assert len(inbox.wait(2, 0.05)) == 1


def test_a_service_goes_and_comes_back(two):
    here, there = two
    node = node_of(here, "server")
    service = here.create_service(node, "/add", AddTwoInts, Qos())
    client = there.create_client(node_of(there, "client"), "/add", AddTwoInts, Qos())
    assert there.graph.wait_for(lambda: there.server_is_ready(client), TIMEOUT_S)
    service.close()
    assert there.graph.wait_for(lambda: not there.server_is_ready(client), TIMEOUT_S)
    requests, answers = Inbox(), Inbox()
    requests.entity = here.create_service(node, "/add", AddTwoInts, Qos(), requests.ready)
    assert there.graph.wait_for(lambda: there.server_is_ready(client), TIMEOUT_S)
    answers.entity, client.on_ready = client, answers.ready
    client.send(AddTwoInts.Request(a=1))
    _, identity, *_ = requests.wait(1)[0]
    requests.entity.reply(identity, AddTwoInts.Response(sum=1))
    assert answers.wait(1)[0][0].sum == 1


@pytest.mark.timing
def test_a_client_that_left_is_not_waited_for(two):
    here, there = two
    requests = Inbox()
    service = requests.entity = here.create_service(node_of(here, "server"), "/add", AddTwoInts, Qos(), requests.ready)
    client = there.create_client(node_of(there, "client"), "/add", AddTwoInts, Qos())
    assert there.graph.wait_for(lambda: there.server_is_ready(client), TIMEOUT_S)
    client.send(AddTwoInts.Request(a=1))
    _, identity, *_ = requests.wait(1)[0]
    client.close()
    meet(here, 0, EndpointKind.CLIENT, name="/add")
    begin = time.monotonic()
    service.reply(identity, AddTwoInts.Response(sum=1))
    assert time.monotonic() - begin < 2.0


def test_the_graph_is_the_same_from_both_sides(two):
    here, there = two
    node, remove = here.create_node("arm", "/cell", "/welding")
    qos = Qos(Reliability.RELIABLE, Durability.TRANSIENT_LOCAL, History.KEEP_LAST, 7, 10**9, 2 * 10**9)
    publisher = here.create_publisher(node, "/cell/state", String, qos)
    service = here.create_service(node, "/cell/add", AddTwoInts, Qos())
    found = meet(there, 1, EndpointKind.PUBLISHER, name="/cell/state")[0]
    mine = publisher.endpoint
    assert (found.name, found.type_name, found.type_hash, found.gid) == (
        mine.name, mine.type_name, mine.type_hash, mine.gid
    )  # fmt: skip
    assert found.qos == qos
    assert (found.node.full_name, found.node.enclave) == ("/cell/arm", "/welding")
    meet(there, 1, EndpointKind.SERVICE, name="/cell/add")
    # A link that is new may tell of endpoints before it tells of their node.
    assert there.graph.wait_for(lambda: [one.full_name for one in there.graph.nodes()] == ["/cell/arm"], TIMEOUT_S)
    of_node = there.graph.endpoints_of(there.graph.nodes()[0])
    assert names_and_types(of_node) == [
        ("/cell/add", ["example_interfaces/srv/AddTwoInts"]), ("/cell/state", ["std_msgs/msg/String"])
    ]  # fmt: skip
    publisher.close()
    service.close()
    meet(there, 0, name="/cell/state")
    remove()
    assert there.graph.wait_for(lambda: not there.graph.nodes() and not there.graph.endpoints(), TIMEOUT_S)


def test_two_nodes_of_one_name_are_two(two):
    here, there = two
    removes = [here.create_node("twin", "/")[1], here.create_node("twin", "/")[1]]
    assert there.graph.wait_for(lambda: len(there.graph.nodes()) == 2, TIMEOUT_S)
    removes[0]()
    assert there.graph.wait_for(lambda: len(there.graph.nodes()) == 1, TIMEOUT_S)


def test_a_session_that_closes_is_gone(two):
    here, there = two
    here.create_publisher(node_of(here, "talker"), "/topic", String, Qos())
    meet(there, 1, EndpointKind.PUBLISHER, name="/topic")
    here.close()
    assert there.graph.wait_for(lambda: not there.graph.nodes() and not there.graph.endpoints(), TIMEOUT_S)


@pytest.mark.slow
def test_a_newcomer_knows_all_when_it_has_settled(new_session):
    first = new_session()
    node = node_of(first, "many")
    for number in range(50):
        first.create_publisher(node, f"/topic{number}", String, Qos())
    second = new_session()
    assert second.backend.settle(TIMEOUT_S)
    assert len(second.graph.endpoints(EndpointKind.PUBLISHER)) == 50
    assert [one.name for one in second.graph.nodes()] == ["many"]


def test_entities_come_and_go_without_a_trace(two):
    here, there = two
    node, other = node_of(here, "node"), node_of(there, "other")
    threads = threading.active_count()
    for _ in range(20):
        members = [
            here.create_publisher(node, "/topic", String, Qos()),
            there.create_subscription(other, "/topic", String, Qos()),
            here.create_service(node, "/add", AddTwoInts, Qos()),
            there.create_client(other, "/add", AddTwoInts, Qos()),
        ]
        for member in members:
            member.close()
    assert there.graph.wait_for(lambda: not there.graph.endpoints(), TIMEOUT_S)
    assert here.graph.wait_for(lambda: not here.graph.endpoints(), TIMEOUT_S)
    assert threading.active_count() <= threads
    publisher, inbox = connected(two, String)
    publisher.publish(String(data="still here"))
    assert inbox.wait(1)[0][0].data == "still here"


@pytest.mark.slow
def test_closing_while_others_publish_harms_nobody(two):
    here, there = two
    node = node_of(here, "talker")
    inbox = subscribe(there, node_of(there, "listener"), "/topic", Int32)
    for _ in range(10):
        publisher = here.create_publisher(node, "/topic", Int32, Qos())
        assert here.graph.wait_for(lambda p=publisher: p.has_subscribers, TIMEOUT_S)
        stop = threading.Event()

        def publish(publisher: Any = publisher, stop: threading.Event = stop) -> None:
            while not stop.is_set():
                publisher.publish(Int32(data=1))

        threads = [threading.Thread(target=publish) for _ in range(3)]
        for thread in threads:
            thread.start()
        inbox.wait(len(inbox.taken) + 5)
        publisher.close()
        stop.set()
        for thread in threads:
            thread.join(TIMEOUT_S)
            assert not thread.is_alive()


def test_what_a_further_endpoint_of_a_topic_costs_does_not_grow(domain, monkeypatch):
    compared = []

    def count(offered: Qos, requested: Qos) -> list[Any]:
        compared.append(None)
        return incompatibilities(offered, requested)

    monkeypatch.setattr("daidalos.transport.session.incompatibilities", count)
    session = Session(make_backend(Environment(domain, middleware="rmw_daidalos_inprocess")))
    node = node_of(session, "crowd")
    told: list[EndpointInfo] = []
    publisher = session.create_publisher(node, "/topic", Int32, Qos())
    for _ in range(100):
        session.watch("/topic", lambda added, endpoint: told.append(endpoint), EndpointKind.PUBLISHER)
    made = [session.create_subscription(node, "/topic", Int32, Qos()) for _ in range(100)]
    assert len(compared) <= 3 * len(made)
    assert {endpoint.kind for endpoint in told} == {EndpointKind.PUBLISHER}
    publisher.publish(Int32(data=1))
    made.pop().close()
    publisher.publish(Int32(data=2))
    assert [len(one) for one in made] == [2] * 99
    session.close()
