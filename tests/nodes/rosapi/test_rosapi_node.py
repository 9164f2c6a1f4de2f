"""Services of rosapi, asked as a client of rosbridge asks them."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosbridge_library.internal.services import ServiceCaller
from std_msgs.msg import String

from daidalos.nodes.rosapi.rosapi_node import RosapiNode
from ros.graph import graph, node, spinning  # noqa: F401

Ask = Callable[..., dict[str, Any]]


@pytest.fixture
def ask(node: Node) -> Iterator[Ask]:  # noqa: F811
    made = RosapiNode(
        context=node.context, parameter_overrides=[Parameter("params_glob", value="[/*:speed, /*:use_*, speed]")]
    )
    node.declare_parameter("speed", 2.5)
    node.declare_parameter("secret", "s")
    node.create_publisher(String, "/words", 1)

    def call(service: str, /, **args: Any) -> dict[str, Any]:
        ended: list[Any] = []
        came = threading.Event()

        def end(result: Any) -> None:
            ended.append(result)
            came.set()

        ServiceCaller(f"/rosapi/{service}", args, end, end, node).start()
        assert came.wait(60.0)
        assert isinstance(ended[0], dict), ended[0]
        return ended[0]

    with spinning(node), spinning(made):
        yield call
        made.destroy_node()


def test_the_graph_is_told(ask: Ask, node: Node) -> None:  # noqa: F811
    me = f"/{node.get_name()}"
    topics = ask("topics")
    assert dict(zip(topics["topics"], topics["types"], strict=True))["/words"] == "std_msgs/msg/String"
    assert ask("topic_type", topic="/words") == {"type": "std_msgs/msg/String"}
    assert ask("topic_type", topic="/none") == {"type": ""}
    assert ask("topics_for_type", type="std_msgs/msg/String") == {"topics": ["/words"]}
    assert ask("publishers", topic="/words") == {"publishers": [me]}
    assert ask("subscribers", topic="/words") == {"subscribers": []}
    assert me in ask("nodes")["nodes"]
    details = ask("node_details", node=me)
    assert "/words" in details["publishing"]
    assert f"{me}/get_parameters" in details["services"]
    assert ask("service_type", service="/rosapi/topics") == {"type": "rosapi_msgs/srv/Topics"}
    assert ask("service_node", service="/rosapi/topics") == {"node": "/rosapi"}
    assert ask("service_providers", service="rosapi_msgs/srv/Topics") == {"providers": ["/rosapi"]}
    assert "/rosapi/topics" in ask("services")["services"]
    assert ask("services_for_type", type="rosapi_msgs/srv/Topics") == {"services": ["/rosapi/topics"]}
    assert ask("action_servers") == {"action_servers": []}
    assert ask("get_ros_version")["version"] == 2
    assert ask("get_time")["time"]["sec"] > 0


def test_definitions_are_told(ask: Ask) -> None:
    found = {one["type"]: one for one in ask("message_details", type="sensor_msgs/Imu")["typedefs"]}
    imu = found["sensor_msgs/Imu"]
    fields = dict(zip(imu["fieldnames"], zip(imu["fieldtypes"], imu["fieldarraylen"], strict=True), strict=True))
    assert fields["orientation"] == ("geometry_msgs/Quaternion", -1)
    assert fields["orientation_covariance"] == ("double", 9)
    assert set(found) >= {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Quaternion"}
    status = ask("message_details", type="action_msgs/GoalStatus")["typedefs"][0]
    assert dict(zip(status["constnames"], status["constvalues"], strict=True))["STATUS_SUCCEEDED"] == "4"
    request = ask("service_request_details", type="std_srvs/SetBool")["typedefs"][0]
    assert (request["fieldnames"], request["fieldtypes"], request["examples"]) == (["data"], ["boolean"], ["False"])
    assert ask("service_response_details", type="std_srvs/SetBool")["typedefs"][0]["fieldnames"] == [
        "success",
        "message",
    ]
    assert ask("service_request_details", type="none/None") == {"typedefs": []}
    assert ask("message_details", type="os/path") == {"typedefs": []}
    texts = ask("topics_and_raw_types")
    words = texts["typedefs_full_text"][texts["topics"].index("/words")]
    assert "string data" in words


def test_parameters_are_read_and_set_where_the_patterns_allow(ask: Ask, node: Node) -> None:  # noqa: F811
    me = f"/{node.get_name()}"
    names = ask("get_param_names")["names"]
    assert f"{me}:speed" in names
    assert f"{me}:secret" not in names
    assert json.loads(ask("get_param", name=f"{me}:speed")["value"]) == 2.5
    ask("set_param", name=f"{me}:speed", value="4.0")
    assert node.get_parameter("speed").value == 4.0
    assert ask("has_param", name=f"{me}:speed") == {"exists": True}
    assert ask("has_param", name=f"{me}:secret") == {"exists": False}
    assert json.loads(ask("get_param", name=f"{me}:secret", default_value='"d"')["value"]) == "d"
    assert json.loads(ask("get_param", name="malformed", default_value="7")["value"]) == 7
    ask("set_param", name=f"{me}:secret", value="x")
    assert node.get_parameter("secret").value == "s"
