"""The components that lessons load into a container."""

import threading

import pytest
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.node import Node

from daidalos.nodes.composition import dlopen_composition
from daidalos.nodes.composition._components import Client
from daidalos.nodes.extensions import components, find_component
from daidalos.nodes.runner import UserError
from nodes.terminal import Terminal
from ros.graph import graph, node, spinning  # noqa: F401

TIMEOUT_S = 20.0


def test_they_are_found_by_their_names() -> None:
    names = components("composition")
    assert names == [f"composition::{name}" for name in ("Client", "Listener", "NodeLikeListener", "Server", "Talker")]
    assert [find_component("composition", name).__name__ for name in names] == [
        "Client",
        "Listener",
        "NodeLikeListener",
        "Server",
        "Talker",
    ]


def said(watcher: Node, text: str) -> threading.Event:
    """Return an event that is set when a text is logged."""
    event = threading.Event()
    watcher.create_subscription(Log, "/rosout", lambda log: event.set() if text in log.msg else None, 10)
    return event


@pytest.mark.slow
@pytest.mark.parametrize(
    ("first", "second", "text"),
    [("Talker", "Listener", "I heard: [Hello World: 1]"), ("Client", "Server", "Got result: [5]")],
)
def test_two_of_them_talk_to_each_other(node: Node, first: str, second: str, text: str) -> None:  # noqa: F811
    event = said(node, text)
    nodes = [find_component("composition", f"composition::{name}")() for name in (second, first)]
    with spinning(node, *nodes):
        assert event.wait(TIMEOUT_S)


def test_a_client_waits_for_somebody_who_adds(graph: Context) -> None:  # noqa: F811
    client = Client()
    texts: list[str] = []
    client.get_logger().info = texts.append  # type: ignore[assignment, method-assign]
    client.ask()
    assert texts == ["Service not available, waiting again..."]


@pytest.mark.parametrize(
    ("path", "component"),
    [
        ("/opt/lib/libtalker_component.so", "Talker"),
        ("libnode_like_listener_component.dylib", "NodeLikeListener"),
        ("server_component.dll", "Server"),
    ],
)
def test_a_library_of_ros_2_stands_for_its_component(path: str, component: str) -> None:
    assert dlopen_composition._component(path) == component


def test_an_unknown_library_is_named_with_what_is_near() -> None:
    with pytest.raises(UserError, match=r"no library 'libtalkr_component.so'; did you mean 'libtalker_component.so'"):
        dlopen_composition._component("lib/libtalkr_component.so")


@pytest.mark.slow
def test_the_demonstration_launches_two_components_in_one_container(domain: int) -> None:
    with Terminal("launch", "composition", "composition_demo.launch.py", domain=domain) as launched:
        launched.wait_for(r"I heard: \[Hello World: 1\]")
