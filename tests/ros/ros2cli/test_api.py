"""The functions behind `ros2 topic`, `node`, `service`, `param`, `pkg` and `run` that other packages import."""

import argparse
import contextlib
import sys

import pytest
import rclpy
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.action import ActionClient, ActionServer
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2node import api as nodes
from ros2param import api as params
from ros2pkg import api as packages
from ros2run import api as runs
from ros2service import api as services
from ros2topic import api as topics
from std_msgs.msg import Int32, String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

from ros.graph import after, spinning


@pytest.fixture
def robot(graph):
    """A node with one of everything."""
    robot = rclpy.create_node("driver", namespace="robot")
    robot.create_publisher(String, "speech", 10)
    robot.create_publisher(String, "_secret", 10)
    robot.create_subscription(Int32, "numbers", lambda message: None, 10)
    robot.create_service(Trigger, "reset", lambda request, response: response)
    robot.create_client(Trigger, "/other/reset")
    robot.declare_parameter("speed", 1.5)
    robot.declare_parameter("arm.reach", 2)
    return robot


def test_topics(node, robot):
    found = dict(topics.get_topic_names_and_types(node=node))
    assert found["/robot/speech"] == ["std_msgs/msg/String"]
    assert "/robot/_secret" not in found
    assert "/robot/_secret" in topics.get_topic_names(node=node, include_hidden_topics=True)
    assert topics.get_msg_class(node, "/robot/numbers") is Int32
    assert topics.get_msg_class(node, "/robot/_secret") is None
    assert topics.get_msg_class(node, "/robot/_secret", include_hidden_topics=True) is String


def test_a_topic_that_comes_later_or_never(node, capsys):
    assert topics.get_msg_class(node, "later") is None
    assert "topic [/later] does not appear to be published yet" in capsys.readouterr().out
    timer = after(0.05, lambda: node.create_publisher(String, "later", 10))
    assert topics.get_msg_class(node, "later", blocking=True) is String
    timer.join()


def test_a_topic_with_two_types(node):
    node.create_publisher(String, "both", 10)
    node.create_subscription(Int32, "both", lambda message: None, 10)
    with pytest.raises(RuntimeError, match=r"more than one type: \[std_msgs/msg/Int32, std_msgs/msg/String\]"):
        topics.get_msg_class(node, "both")


def test_qualities_of_service():
    profile = topics.qos_profile_from_short_keys("sensor_data", durability="transient_local", depth=3)
    assert profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert (profile.durability, profile.depth) == (DurabilityPolicy.TRANSIENT_LOCAL, 3)
    own = QoSProfile(depth=7)
    assert topics.profile_configure_short_keys(own, reliability="best_effort", liveliness_lease_duration_s=2) is own
    assert (own.reliability, own.depth) == (ReliabilityPolicy.BEST_EFFORT, 7)
    assert own.liveliness_lease_duration.nanoseconds == 2_000_000_000
    parser = argparse.ArgumentParser()
    topics.add_qos_arguments(parser, "subscribe", "sensor_data")
    assert parser.parse_args(["--qos-depth", "4"]).qos_depth == 4
    assert "to subscribe with" in " ".join(parser.format_help().split())


@pytest.mark.parametrize(
    ("read", "good", "value", "bad"),
    [
        (topics.positive_int, "3", 3, ["0", "-1", "1.5", "x"]),
        (topics.unsigned_int, "0", 0, ["-1", "x"]),
        (topics.positive_float, "0.5", 0.5, ["0", "-1", "x"]),
    ],
)
def test_numbers_on_the_command_line(read, good, value, bad):
    assert read(good) == value
    for text in bad:
        with pytest.raises(argparse.ArgumentTypeError, match=f"not '{text}'"):
            read(text)


def test_completion_that_needs_no_graph():
    assert "std_msgs/msg/String" in topics.message_type_completer(prefix="")
    assert "std_srvs/srv/Trigger" in services.service_type_completer()
    chosen = argparse.Namespace(kind="std_msgs/msg/Int32", package="turtlesim")
    assert topics.TopicMessagePrototypeCompleter(topic_type_key="kind")("", chosen) == ["{data: 0}"]
    assert "turtlesim_node" in runs.ExecutableNameCompleter(package_name_key="package")("", chosen)
    assert topics.TopicTypeCompleter()("", chosen) == topics.message_type_completer()


def test_completion_by_the_graph(node, robot, monkeypatch):
    monkeypatch.setattr("ros2cli.graph.NodeStrategy", lambda args: contextlib.nullcontext(node))
    chosen = argparse.Namespace(topic="/robot/speech", service="/robot/reset", other="/none", hidden=True)
    names = topics.TopicNameCompleter(include_hidden_topics_key="hidden")("", chosen)
    assert {"/robot/speech", "/robot/_secret"} <= set(names)
    assert "/robot/_secret" not in topics.TopicNameCompleter()("", chosen)
    assert topics.TopicTypeCompleter(topic_name_key="topic")("", chosen) == ["std_msgs/msg/String"]
    assert topics.TopicTypeCompleter(topic_name_key="other")("", chosen) == topics.message_type_completer()
    assert "/robot/reset" in services.ServiceNameCompleter()("", chosen)
    assert services.ServiceTypeCompleter(service_name_key="service")("", chosen) == ["std_srvs/srv/Trigger"]
    assert "/robot/driver" in nodes.NodeNameCompleter(include_hidden_nodes_key="hidden")("", chosen)


def test_services(node, robot):
    assert ("/robot/reset", ["std_srvs/srv/Trigger"]) in services.get_service_names_and_types(node=node)
    assert "/robot/reset" in services.get_service_names(node=node)
    assert services.get_service_class(node, "/robot/reset") is Trigger
    assert services.get_service_class(node, "/robot/none") is None


def test_nodes(node, robot):
    rclpy.create_node("_hidden")
    found = nodes.get_node_names(node=node)
    assert nodes.NodeName("driver", "/robot", "/robot/driver") in found
    assert nodes.NodeName("tested", "/", "/tested") in found
    assert "/_hidden" not in [one.full_name for one in found]
    assert "/_hidden" in [one.full_name for one in nodes.get_node_names(node=node, include_hidden_nodes=True)]
    assert nodes.wait_for_node(node, "robot/driver")
    assert not nodes.wait_for_node(node, "/nobody", timeout=0.05)
    assert not nodes.has_duplicates(one.full_name for one in found)
    assert nodes.has_duplicates(["a", "b", "a"])


def test_names_of_nodes():
    assert nodes.parse_node_name("/robot/arm/driver") == ("driver", "/robot/arm", "/robot/arm/driver")
    assert nodes.parse_node_name("driver") == ("driver", "/", "/driver")
    assert (nodes.get_absolute_node_name("a"), nodes.get_absolute_node_name("/a")) == ("/a", "/a")
    assert nodes.get_absolute_node_name("") is None


def test_what_a_node_has(node, robot):
    server = ActionServer(robot, Fibonacci, "count", lambda goal: None)
    client = ActionClient(robot, Fibonacci, "/other/count")
    name = {"node": node, "remote_node_name": "/robot/driver"}
    topic = nodes.TopicInfo("/robot/speech", ["std_msgs/msg/String"])
    assert topic in nodes.get_publisher_info(**name)
    assert "/robot/_secret" not in [one.name for one in nodes.get_publisher_info(**name)]
    assert "/robot/_secret" in [one.name for one in nodes.get_publisher_info(**name, include_hidden=True)]
    assert "/robot/numbers" in [one.name for one in nodes.get_subscriber_info(**name)]
    assert ("/robot/reset", ["std_srvs/srv/Trigger"]) in nodes.get_service_server_info(**name)
    assert [one.name for one in nodes.get_service_client_info(**name)] == ["/other/reset"]
    assert nodes.get_action_server_info(**name) == [("/robot/count", ["test_msgs/action/Fibonacci"])]
    assert nodes.get_action_client_info(**name) == [("/other/count", ["test_msgs/action/Fibonacci"])]
    server.destroy()
    client.destroy()


def test_parameters(node, robot, tmp_path, capsys):
    name = {"node": node, "node_name": "/robot/driver"}
    double = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=3.5)
    with spinning(robot):
        assert {"speed", "arm.reach"} <= set(params.call_list_parameters(**name).result.names)
        assert list(params.call_list_parameters(**name, prefixes=["arm"]).result.names) == ["arm.reach"]
        response = params.call_get_parameters(**name, parameter_names=["speed", "arm.reach"])
        assert [params.get_value(parameter_value=value) for value in response.values] == [1.5, 2]
        response = params.call_set_parameters(**name, parameters=[ParameterMessage(name="speed", value=double)])
        assert [result.successful for result in response.results] == [True]
        response = params.call_describe_parameters(**name, parameter_names=["speed"])
        assert params.get_parameter_type_string(response.descriptors[0].type) == "double"
        file = tmp_path / "parameters.yaml"
        file.write_text("/robot/driver: {ros__parameters: {speed: 4.5}}\n/**: {ros__parameters: {arm: {reach: 9}}}\n")
        params.load_parameter_file(**name, parameter_file=str(file), use_wildcard=True)
        assert "Set parameter speed successful" in capsys.readouterr().out
        with pytest.raises(RuntimeError, match=r"missing\.yaml: No such file"):
            params.load_parameter_file(**name, parameter_file=str(tmp_path / "missing.yaml"), use_wildcard=True)
    assert (robot.get_parameter("speed").value, robot.get_parameter("arm.reach").value) == (4.5, 9)


def test_a_node_that_is_not_there(node, monkeypatch):
    monkeypatch.setattr("ros2cli.services.call.__kwdefaults__", {"ready_s": 0.05, "answer_s": None})
    with pytest.raises(RuntimeError, match="Wait for service '/nobody/list_parameters' timed out"):
        params.call_list_parameters(node=node, node_name="/nobody")


def test_packages_and_executables(tmp_path):
    assert "turtlesim" in packages.get_package_names() == packages.package_name_completer(prefix="t")
    assert packages.get_prefix_path("turtlesim") is not None
    assert packages.get_prefix_path("no_such_package") is None
    path = runs.get_executable_path(package_name="turtlesim", executable_name="turtlesim_node")
    assert path in runs.get_executable_paths(package_name="turtlesim")
    assert runs.get_executable_path(package_name="turtlesim", executable_name="none") is None
    for call in (
        lambda: runs.get_executable_paths(package_name="no_such_package"),
        lambda: runs.get_executable_path(package_name="no_such_package", executable_name="none"),
    ):
        with pytest.raises(packages.PackageNotFound, match="Package 'no_such_package' not found"):
            call()
    script = tmp_path / "script"
    script.write_text(f"#!{sys.executable}\nimport sys\nsys.exit(len(sys.argv))\n")
    script.chmod(0o755)
    assert runs.run_executable(path=str(script), argv=["a", "b"]) == 3
    assert runs.run_executable(path=str(script), argv=["a"], prefix=f"{sys.executable} -S") == 2


def test_an_executable_of_ours_is_run_by_its_file(capfd):
    path = runs.get_executable_path(package_name="joy", executable_name="joy_enumerate_devices")
    assert runs.run_executable(path=path, argv=[]) == 0
    assert capfd.readouterr().out
