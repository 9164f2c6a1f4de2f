"""Nodes: their names, what they make, what they tell of the graph, and their end."""

import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any
from unittest.mock import Mock

import pytest
import rclpy
from rcl_interfaces.srv import GetParameters
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.exceptions import (
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)
from rclpy.expand_topic_name import expand_topic_name
from rclpy.impl.errors import InvalidHandle, RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
    qos_policy_name_from_kind,
)
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from rclpy.utilities import get_available_rmw_implementations, remove_ros_args, timeout_sec_to_nsec
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name
from rclpy.validate_topic_name import validate_topic_name
from std_msgs.msg import String
from std_srvs.srv import Empty

from ros.rclpy.waiting import executor_of, run_ready

MAKERS: dict[str, tuple[Callable[[Node, str], Any], type[Exception]]] = {
    "publisher": (lambda node, name: node.create_publisher(String, name, 1), InvalidTopicNameException),
    "subscription": (lambda node, name: node.create_subscription(String, name, print, 1), InvalidTopicNameException),
    "client": (lambda node, name: node.create_client(Empty, name), InvalidServiceNameException),
    "service": (lambda node, name: node.create_service(Empty, name, print), InvalidServiceNameException),
}


@pytest.mark.parametrize("kind", MAKERS)
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("chatter?", "must not contain characters"),
        ("/chatter/42", "must not start with a number"),
        ("chatter/{planet}", "unknown substitution"),
    ],
)
def test_bad_names_are_refused(node: Node, kind: str, name: str, words: str) -> None:
    make, error = MAKERS[kind]
    with pytest.raises(error, match=words) as raised:
        make(node, name)
    assert isinstance(raised.value, ValueError)
    assert node.get_topic_names_and_types()


@pytest.mark.parametrize(
    ("name", "namespace", "arguments", "full"),
    [
        ("topic", None, [], "/topic"),
        ("topic", "my/ns", [], "/my/ns/topic"),
        ("/topic", "ns", [], "/topic"),
        ("~/topic", "ns", [], "/ns/tested/topic"),
        ("{node}/topic", "ns", [], "/ns/tested/topic"),
        ("topic", "ns", ["-r", "topic:=other"], "/ns/other"),
        ("topic", "ns", ["-r", "topic:=deep/other"], "/ns/deep/other"),
        ("deep/topic", "ns", ["-r", "deep/topic:=other"], "/ns/other"),
        ("/a/b", None, ["-r", "/a/b:=/c/d"], "/c/d"),
        ("topic", "ns", ["-r", "__ns:=/there", "-r", "__node:=renamed"], "/there/topic"),
    ],
)
@pytest.mark.parametrize("kind", MAKERS)
def test_names_are_made_full_and_remapped(
    graph: Context, kind: str, name: str, namespace: str | None, arguments: list[str], full: str
) -> None:
    with Node("tested", namespace=namespace, cli_args=["--ros-args", *arguments]) as node:
        entity = MAKERS[kind][0](node, name)
        found = entity.topic_name if "client" not in kind and "service" not in kind else entity.service_name
        assert found == full
        assert entity.logger_name == node.get_fully_qualified_name().strip("/").replace("/", ".")


@pytest.mark.parametrize("depth", [-1, "ten", None])
def test_what_is_no_profile_is_refused(node: Node, depth: Any) -> None:
    with pytest.raises((TypeError, ValueError), match=r"QoSProfile or int|greater than or equal to zero"):
        node.create_publisher(String, "topic", depth)


def test_arguments_that_cannot_be_read_are_named(graph: Context) -> None:
    with pytest.raises(RCLInvalidROSArgsError, match=r"Failed to parse ROS arguments:.*not-a-remap"):
        Node("tested", cli_args=["--ros-args", "-r", "not-a-remap"])
    with pytest.raises(UnknownROSArgsError, match=r"Found unknown ROS arguments:.*\['--my-flag'\]"):
        Node("tested", cli_args=["--ros-args", "--my-flag"])
    with pytest.raises(UnicodeEncodeError):
        rclpy.init(context=Context(), args=["program", "Ragnar\udcc3\udcb6k"])


def test_a_class_that_forgot_its_nodes_init_is_told(node: Node) -> None:
    class Forgetful(Node):
        def __init__(self) -> None:
            self.create_publisher(String, "chatter", 10)

    with pytest.raises(AttributeError, match=r"'Forgetful' is not a node yet: its __init__ has to call super\(\)"):
        Forgetful()
    with pytest.raises(AttributeError, match="'Node' object has no attribute 'get_nam'"):
        node.get_nam()  # type: ignore[attr-defined]


def test_questions_about_the_graph_need_names(node: Node) -> None:
    for ask in (
        node.get_publishers_info_by_topic,
        node.get_subscriptions_info_by_topic,
        node.count_publishers,
        node.count_subscribers,
        node.count_clients,
        node.count_services,
    ):
        with pytest.raises(TypeError):
            ask(1)  # type: ignore[arg-type]
        with pytest.raises(ValueError, match="is invalid"):
            ask("13")


def test_endpoints_are_described_as_they_are(node: Node) -> None:
    profile = QoSProfile(
        depth=10,
        history=HistoryPolicy.KEEP_ALL,
        deadline=Duration(seconds=1, nanoseconds=12345),
        lifespan=Duration(seconds=20, nanoseconds=9887665),
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=5, nanoseconds=23456),
    )
    node.create_publisher(String, "topic", profile)
    (info,) = node.get_publishers_info_by_topic("topic")
    assert (info.node_name, info.node_namespace, info.topic_type) == ("tested", "/", "std_msgs/msg/String")
    assert info.endpoint_type == TopicEndpointTypeEnum.PUBLISHER
    assert info.qos_profile == profile
    assert str(info.topic_type_hash).startswith("RIHS01_")
    assert node.get_subscriptions_info_by_topic("topic") == []


def test_an_endpoint_of_which_nothing_is_known() -> None:
    info = TopicEndpointInfo()
    for line in ("Node name: ", "Endpoint type: INVALID", "  Reliability: UNKNOWN", "  Lifespan: 0 nanoseconds"):
        assert line in str(info).split("\n")
    info.node_name = "someone"
    assert info == TopicEndpointInfo(node_name="someone")
    with pytest.raises(AssertionError):
        TopicEndpointInfo(colour="red")


def test_an_executor_may_be_anything_that_takes_nodes(graph: Context) -> None:
    first, second = Mock(), Mock()
    first.add_node.return_value = second.add_node.return_value = True
    node = Node("tested")
    assert node.executor is None
    node.executor = first
    assert node.executor is first
    node.executor = second
    assert node.executor is second
    first.add_node.assert_called_once_with(node)
    first.remove_node.assert_called_once_with(node)
    node.executor = None
    assert node.executor is None
    second.remove_node.assert_called_once_with(node)


def test_destroying_ends_everything_once(graph: Context) -> None:
    node, watcher = Node("tested"), Node("watcher")
    executor = executor_of(node)
    for make, _ in MAKERS.values():
        make(node, "name")
    node.create_timer(0.0, lambda: None)
    node.destroy_node()
    assert executor.get_nodes() == []
    run_ready(executor)
    assert watcher.get_node_names() == ["watcher"]
    assert watcher.count_publishers("name") == watcher.count_clients("name") == 0
    assert not [*node.publishers, *node.subscriptions, *node.clients, *node.services, *node.timers, *node.waitables]
    node.destroy_node()
    for use in (node.get_name, lambda: node.create_publisher(String, "name", 1)):
        with pytest.raises(InvalidHandle):
            use()


@pytest.mark.parametrize("kind", MAKERS)
def test_an_interrupted_creation_leaves_nothing_to_destroy(
    graph: Context, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    node, watcher = Node("tested"), Node("watcher")
    monkeypatch.setattr(node.handle.session, f"create_{kind}", Mock(side_effect=KeyboardInterrupt))
    try:
        MAKERS[kind][0](node, "name")
    except KeyboardInterrupt:  # whose traceback keeps the handle alive
        node.destroy_node()
    assert watcher.get_node_names() == ["watcher"]


def test_what_is_in_use_is_destroyed_when_it_is_not(node: Node) -> None:
    publisher = node.create_publisher(String, "topic", 1)
    with publisher.handle:
        assert node.destroy_publisher(publisher)
        assert node.count_publishers("topic") == 1
    assert node.count_publishers("topic") == 0
    assert not node.destroy_publisher(publisher)
    with pytest.raises(InvalidHandle):
        publisher.publish(String())


@pytest.mark.parametrize(
    ("validate", "name", "words"),
    [
        (validate_node_name, "", "must not be empty"),
        (validate_node_name, "/name", "must not contain characters"),
        (validate_node_name, "2name", "must not start with a number"),
        (validate_namespace, "", "must not be empty"),
        (validate_namespace, "ns", "must be absolute"),
        (validate_namespace, "/ns/", "must not end with"),
        (validate_namespace, "//ns", "repeated"),
        (validate_namespace, "/a/2b", "token"),
        (validate_full_topic_name, "topic", "must be absolute"),
        (validate_full_topic_name, "/topic?", "must not contain characters"),
        (validate_topic_name, "", "must not be empty"),
        (validate_topic_name, "a/~/b", "tilde"),
        (validate_topic_name, "a/{b", "unbalanced"),
        (validate_topic_name, "a//b", "repeated"),
        (lambda name: expand_topic_name("topic", name, "/ns"), "bad?", "node name"),
        (lambda name: expand_topic_name("topic", "node", name), "bad", "namespace"),
        (lambda name: expand_topic_name(name, "node", "/ns"), "bad?", "topic name"),
    ],
)
def test_rules_for_names(validate: Callable[[str], Any], name: str, words: str) -> None:
    with pytest.raises(NameValidationException, match=words):
        validate(name)


def test_good_names_are_good() -> None:
    assert validate_node_name("node_1")
    assert validate_namespace("/a/b")
    assert validate_full_topic_name("/a/b")
    assert validate_topic_name("~/{node}/b")
    assert expand_topic_name("~/b", "node", "/ns") == "/ns/node/b"


def test_profiles_have_names_and_can_be_compared() -> None:
    assert HistoryPolicy.short_keys() == ["system_default", "keep_last", "keep_all", "unknown"]
    assert HistoryPolicy.get_from_short_key("KEEP_all") == HistoryPolicy.KEEP_ALL
    assert QoSPresetProfiles.get_from_short_key("sensor_data").reliability == ReliabilityPolicy.BEST_EFFORT
    assert qos_policy_name_from_kind(2) == "DURABILITY"
    assert QoSProfile(**_rclpy.rmw_qos_profile_t.predefined("qos_profile_default").to_dict()) == QoSProfile(depth=10)
    assert QoSProfile(depth=1) != QoSProfile(depth=1, deadline=Duration(seconds=2))
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    compatible, reason = qos_check_compatible(best_effort, QoSProfile(depth=1))
    assert compatible == _rclpy.QoSCompatibility.ERROR
    assert "reliable subscription" in reason


def test_the_best_available_profile_suits_who_is_there(node: Node) -> None:
    best = QoSPresetProfiles.BEST_AVAILABLE.value
    node.create_publisher(String, "lax", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "latched", latched)
    found = {}
    for topic in ("lax", "latched", "new"):
        node.create_subscription(String, topic, print, best)
        (info,) = node.get_subscriptions_info_by_topic(topic)
        found[topic] = (info.qos_profile.reliability.name, info.qos_profile.durability.name)
    assert found["lax"] == ("BEST_EFFORT", "VOLATILE")
    assert found["latched"] == ("RELIABLE", "TRANSIENT_LOCAL")
    node.create_publisher(String, "offered", best)
    (info,) = node.get_publishers_info_by_topic("offered")
    assert (info.qos_profile.reliability.name, info.qos_profile.durability.name) == ("RELIABLE", "TRANSIENT_LOCAL")


def test_arguments_of_ros_are_told_from_others() -> None:
    given = ["program", "-d", "--ros-args", "-r", "__ns:=/x", "--", "--mine"]
    assert remove_ros_args(given) == ["program", "-d", "--mine"]
    with pytest.raises(RuntimeError):
        remove_ros_args([])
    assert timeout_sec_to_nsec(1.5) == 1_500_000_000
    assert timeout_sec_to_nsec(None) < 0


def test_taking_by_hand(node: Node) -> None:
    subscription = node.create_subscription(String, "topic", print, 10)
    called = Mock()
    subscription.handle.set_on_new_message_callback(called)
    publisher = node.create_publisher(String, "topic", 10)
    publisher.publish(String(data="one"))
    called.assert_called_once_with(1)
    message, info = subscription.handle.take_message(String, False)
    assert (message.data, info["source_timestamp"] > 0) == ("one", True)
    assert subscription.handle.take_message(String, False) is None
    subscription.handle.clear_on_new_message_callback()
    publisher.publish(String())
    called.assert_called_once()

    client = node.create_client(GetParameters, "/tested/get_parameters")
    assert client.wait_for_service(0)
    called.reset_mock()
    client.handle.set_on_new_response_callback(called)
    client.call_async(GetParameters.Request())
    run_ready(executor_of(node))
    called.assert_called_once_with(1)


@pytest.mark.parametrize("statement", ["import rclpy; rclpy.executors", "from rclpy.qos_event import QoSEventHandler"])
def test_names_that_programs_use_are_there(statement: str) -> None:
    subprocess.run([sys.executable, "-c", statement], check=True)


def test_what_is_no_module_is_missing() -> None:
    with pytest.raises(AttributeError, match="no_module"):
        _ = rclpy.no_module


def test_middlewares_that_are_named_can_be_used() -> None:
    available = get_available_rmw_implementations()
    assert "rmw_zenoh_cpp" in available
    assert ("rmw_cyclonedds_cpp" in available) == (find_spec("cyclonedds") is not None)
    assert "rmw_daidalos_inprocess" not in available
