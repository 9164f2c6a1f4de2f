"""Nodes of commands: the daemon's, one of their own, and the choice between them."""

import argparse

import pytest
import rclpy
from domain_coordinator import domain_id
from rclpy.impl.errors import NodeNameNonExistentError
from ros2cli.node.daemon import DaemonNode, is_daemon_running, shutdown_daemon, spawn_daemon
from ros2cli.node.direct import DirectNode
from ros2cli.node.network_aware import NetworkAwareNode
from ros2cli.node.strategy import NodeStrategy
from std_msgs.msg import String


@pytest.fixture
def domain(monkeypatch):
    """A domain in which nobody else is."""
    with domain_id() as number:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
        yield number


@pytest.fixture
def daemon(domain):
    """A daemon that knows a node which publishes."""
    with DirectNode(None, node_name="driver") as node:
        node.create_publisher(String, "speech", 10)
        assert spawn_daemon(None, timeout=10.0)
        with DaemonNode(None) as asked:
            yield asked
        shutdown_daemon(None, timeout=10.0)


# The functions of ros2cli's own daemon, which public tools call.
FUNCTIONS = {
    *("get_name", "get_namespace", "get_node_names_and_namespaces", "get_node_names_and_namespaces_with_enclaves"),
    *("get_topic_names_and_types", "get_service_names_and_types", "get_action_names_and_types"),
    *("get_publisher_names_and_types_by_node", "get_publishers_info_by_topic", "get_subscriptions_info_by_topic"),
    *("get_subscriber_names_and_types_by_node", "get_service_names_and_types_by_node"),
    *("get_client_names_and_types_by_node", "get_action_server_names_and_types_by_node"),
    *("get_action_client_names_and_types_by_node", "count_publishers", "count_subscribers", "count_clients"),
    *("count_services", "system.listMethods", "system.methodHelp", "system.methodSignature", "system.shutdown"),
}


@pytest.mark.slow
def test_the_daemon_answers_as_a_node(daemon):
    assert daemon.connected
    assert set(daemon.system.listMethods()) >= FUNCTIONS
    assert not any(name.startswith("system.") for name in daemon.methods)
    assert all(daemon.system.methodHelp(name) for name in FUNCTIONS)
    assert daemon.system.methodHelp("no_method") == ""
    assert ["driver", "/"] in daemon.get_node_names_and_namespaces()
    assert ["/speech", ["std_msgs/msg/String"]] in daemon.get_topic_names_and_types()
    assert not any("daemon" in service for service, _ in daemon.get_service_names_and_types())
    assert daemon.count_publishers("/speech") == 1
    (info,) = daemon.get_publishers_info_by_topic("/speech")
    assert (info.node_name, info.qos_profile.depth) == ("driver", 10)
    assert "daemon" in daemon.get_name()
    with pytest.raises(NodeNameNonExistentError, match="/pilot"):
        daemon.get_publisher_names_and_types_by_node("pilot", "/")
    with pytest.raises(AttributeError, match="create_publisher"):
        _ = daemon.create_publisher
    with NodeStrategy(None) as node:
        assert node.daemon_node is not None
        assert ["driver", "/"] in node.get_node_names_and_namespaces()
    assert NodeStrategy(argparse.Namespace(no_daemon=True)).daemon_node is None
    assert not spawn_daemon(None, timeout=10.0)
    assert shutdown_daemon(None, timeout=10.0)
    assert not is_daemon_running(None)
    with pytest.raises(ConnectionRefusedError, match="ros2 daemon start"):
        daemon.get_node_names()


def test_a_node_is_made_anew_when_the_network_changes(monkeypatch):
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    with NetworkAwareNode(argparse.Namespace()) as node:
        before = node.node
        assert node.get_node_names()
        assert node.node is before
        node.addresses_at_start = {}
        assert node.get_node_names()
        assert node.node is not before
    assert not rclpy.ok()


@pytest.mark.slow
def test_a_daemon_that_was_started_in_the_background_is_used_next(domain):
    try:
        with NodeStrategy(None) as node:
            assert node.daemon_node is None
        with NodeStrategy(None) as node:
            assert node.daemon_node is not None
    finally:
        shutdown_daemon(None, timeout=10.0)
