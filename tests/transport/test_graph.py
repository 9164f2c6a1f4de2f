"""The graph: what is noted, found, told and waited for."""

from __future__ import annotations

import threading

import pytest

from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo, names_and_types
from daidalos.transport.qos import (
    INFINITE_NS,
    Durability,
    History,
    Liveliness,
    Policy,
    Qos,
    Reliability,
    incompatibilities,
)

NODE = NodeInfo("n1", "arm", "/cell")


def endpoint(number: int, kind: EndpointKind = EndpointKind.PUBLISHER, name: str = "/topic") -> EndpointInfo:
    return EndpointInfo(kind, NODE, name, f"pkg/msg/T{number}", "", Qos(), number.to_bytes(16, "little"))


def test_endpoints_are_found_by_kind_name_and_node():
    graph = Graph()
    graph.add_node(NODE)
    one, two = endpoint(1), endpoint(2, EndpointKind.SUBSCRIPTION)
    graph.add_endpoint("a", one)
    graph.add_endpoint("a", endpoint(3))  # the key is taken
    graph.add_endpoint("b", two)
    assert graph.endpoints() == [one, two]
    assert graph.endpoints(EndpointKind.SUBSCRIPTION) == [two]
    assert graph.endpoints(name="/other") == []
    assert graph.endpoints_of(NODE, EndpointKind.PUBLISHER) == [one]
    assert graph.find_nodes("arm", "/cell") == [NODE]
    assert NODE.full_name == "/cell/arm"
    graph.remove_endpoint("b")
    graph.remove_endpoint("b")
    assert graph.endpoints() == [one]


def test_listeners_hear_of_every_change_once():
    graph, received = Graph(), []
    stop = graph.listen(lambda added, what: received.append((added, what)))
    one = endpoint(1)
    for _ in range(2):
        graph.add_node(NODE)
        graph.add_endpoint("a", one)
    for _ in range(2):
        graph.remove_endpoint("a")
        graph.remove_node("n1")
    assert received == [(True, NODE), (True, one), (False, one), (False, NODE)]
    stop()
    graph.add_node(NODE)
    assert len(received) == 4


def test_who_waits_is_woken_by_a_change():
    graph = Graph()
    timer = threading.Timer(0.05, lambda: graph.add_node(NODE))
    timer.start()
    assert graph.wait_for(lambda: bool(graph.nodes()), 10.0)
    timer.join()
    assert not graph.wait_for(lambda: False, 0.01)


def test_names_are_grouped_with_their_types():
    found = names_and_types([endpoint(2), endpoint(1), endpoint(1, name="/a")])
    assert found == [("/a", ["pkg/msg/T1"]), ("/topic", ["pkg/msg/T1", "pkg/msg/T2"])]


@pytest.mark.parametrize(
    ("offered", "requested", "policies"),
    [
        ({}, {}, []),
        ({"reliability": Reliability.BEST_EFFORT}, {}, [Policy.RELIABILITY]),
        ({}, {"reliability": Reliability.BEST_EFFORT}, []),
        ({}, {"durability": Durability.TRANSIENT_LOCAL}, [Policy.DURABILITY]),
        ({"durability": Durability.TRANSIENT_LOCAL}, {}, []),
        ({}, {"deadline_ns": 10}, [Policy.DEADLINE]),
        ({"deadline_ns": 10}, {"deadline_ns": 10}, []),
        ({"deadline_ns": 11}, {"deadline_ns": 10}, [Policy.DEADLINE]),
        ({}, {"liveliness": Liveliness.MANUAL_BY_TOPIC}, [Policy.LIVELINESS]),
        ({"liveliness": Liveliness.MANUAL_BY_TOPIC}, {}, []),
        ({"liveliness_lease_ns": 11}, {"liveliness_lease_ns": 10}, [Policy.LIVELINESS]),
        ({"history": History.KEEP_ALL}, {"depth": 1}, []),
        (
            {"reliability": Reliability.BEST_EFFORT},
            {"durability": Durability.TRANSIENT_LOCAL},
            [Policy.RELIABILITY, Policy.DURABILITY],
        ),
    ],
)
def test_a_publisher_must_offer_what_a_subscription_requests(offered, requested, policies):
    assert incompatibilities(Qos(**offered), Qos(**requested)) == policies


def test_limits_of_queues():
    assert Qos(depth=0).limit == 1
    assert Qos(depth=7).limit == 7
    assert Qos(history=History.KEEP_ALL).limit is None
    assert Qos().deadline_ns == INFINITE_NS
