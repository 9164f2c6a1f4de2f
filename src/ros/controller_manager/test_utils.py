"""Checks for tests of robots: whether nodes and controllers run, and whether joint states are published."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

import rclpy
from launch_testing_ros import WaitForTopics
from rclpy.node import Node
from sensor_msgs.msg import JointState

from controller_manager.controller_manager_services import list_controllers

_PAUSE_S = 0.1


def check_node_running(node: Node, node_name: str, timeout: float = 5.0) -> None:
    """Fail where no node of that name comes within a time [s]."""

    def there() -> bool:
        return node_name in node.get_node_names() or node_name in node.get_fully_qualified_node_names()

    assert _comes(node, there, timeout), f"node '{node_name}' was not there within {timeout:g} s"


def check_controllers_running(
    node: Node, cnames: Iterable[str], namespace: str = "", state: str = "active", timeout: float = 10.0
) -> None:
    """Fail where controllers do not come to a state within a time [s].

    Parameters
    ----------
    node : Node
    cnames : iterable of str
        Controllers.
    namespace : str
        Of their manager.
    state : str
    timeout : float
    """
    manager = "/".join(["", *filter(None, namespace.split("/")), "controller_manager"])
    wanted = set(cnames)
    states: dict[str, str] = {}

    def there() -> bool:
        found = list_controllers(node, manager, timeout, timeout).controller
        states.update({one.name: one.state for one in found})
        return all(states.get(name) == state for name in wanted)

    came = _comes(node, there, timeout)
    others = [f"{name} is {states.get(name, 'not loaded')}" for name in sorted(wanted) if states.get(name) != state]
    assert came, f"{manager}: not all are {state}: {', '.join(others)}"


def check_if_js_published(topic: str, joint_names: Iterable[str]) -> None:
    """Fail where no joint states with just these joints come on a topic within 15 s."""
    wanted = set(joint_names)
    waiting = WaitForTopics([(topic, JointState)], timeout=15.0)
    try:
        assert waiting.wait(), f"nothing came on topic '{topic}'"
        names = waiting.received_messages(topic)[0].name
        assert len(names) == len(wanted), f"{topic} has the joints {', '.join(names)}"
        assert set(names) == wanted, f"{topic} has the joints {', '.join(names)}"
    finally:
        waiting.shutdown()


def _comes(node: Node, there: Callable[[], bool], timeout: float) -> bool:
    """Check a condition until it holds, or until a time has passed."""
    end = time.monotonic() + timeout
    while not there():
        if time.monotonic() > end:
            return False
        rclpy.spin_once(node, timeout_sec=_PAUSE_S)
    return True
