"""The node `mqtt_client` on a broker: bridges in both directions, types, latency, buffer, and lost brokers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import PointStamped
from mqtt_client_interfaces.srv import IsConnected, NewMqtt2RosBridge, NewRos2MqttBridge
from rcl_interfaces.msg import Log
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from std_msgs.msg import Bool, Float64, Header, Int32, String

from daidalos.common.errors import UserError
from daidalos.industry.lighting.embedded_broker import EmbeddedBroker
from daidalos.nodes.mqtt_client._buffer import Buffer, Outgoing
from daidalos.nodes.mqtt_client.mqtt_client import MqttClient
from mqtt_brokers import free_port, mosquitto

mqtt = pytest.importorskip("paho.mqtt.client")
pytest.importorskip("amqtt")
_OUT, _IN = "bridge.ros2mqtt", "bridge.mqtt2ros"


class Site:
    """The bridge, someone in the ROS graph, and someone on the broker."""

    def __init__(self, node: Node, port: int, **parameters: Any) -> None:
        values = {"broker.host": "127.0.0.1", "broker.port": port, **parameters}
        self.bridge = MqttClient(parameter_overrides=[Parameter(name, value=value) for name, value in values.items()])
        self.node = node
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.bridge)
        self._executor.add_node(node)
        self.client: Any = None

    def join(self, port: int, topic: str = "#") -> None:
        """Come to the broker and hear what is sent there."""
        self.heard: list[tuple[str, bytes, bool]] = []
        is_ready = threading.Event()
        self.client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        self.client.on_message = lambda client, data, one: self.heard.append((one.topic, one.payload, one.retain))
        self.client.on_connect = lambda client, *_: client.subscribe(topic, 1)
        self.client.on_subscribe = lambda *_: is_ready.set()
        self.client.connect("127.0.0.1", port)
        self.client.loop_start()
        assert is_ready.wait(20.0)

    def until(self, holds: Callable[[], Any], act: Callable[[], Any] = lambda: None) -> None:
        """Spin, and do something in each round, until a condition holds."""
        end = time.monotonic() + 30.0
        while not holds():
            assert time.monotonic() < end, "it did not become true"
            act()
            self._executor.spin_once(timeout_sec=0.02)

    def hear(self, kind: type[Any], topic: str) -> list[Any]:
        """Return the list in which the messages of a ROS topic will be."""
        found = list[Any]()
        self.node.create_subscription(kind, topic, found.append, 10)
        return found

    def call(self, kind: type[Any], name: str, **fields: Any) -> Any:
        """Return the answer of one of the bridge's services."""
        client = self.node.create_client(kind, f"/mqtt_client/{name}")
        self.until(client.service_is_ready)
        answer = client.call_async(kind.Request(**fields))
        self.until(answer.done)
        return answer.result()

    def is_connected(self) -> bool:
        """Return what the bridge's service says."""
        return bool(self.call(IsConnected, "is_connected").connected)

    def close(self) -> None:
        """Leave."""
        self.bridge.destroy_node()
        if self.client is not None:
            self.client.disconnect()
            self.client.loop_stop()


@pytest.fixture
def port() -> Iterator[int]:
    """Port of an embedded broker."""
    number = free_port()
    with EmbeddedBroker("127.0.0.1", number):
        yield number


@pytest.fixture
def site(node: Node, port: int) -> Iterator[Callable[..., Site]]:
    made = list[Site]()

    def make(**parameters: Any) -> Site:
        made.append(Site(node, port, **parameters))
        made[-1].join(port)
        return made[-1]

    yield make
    for one in made:
        one.close()


def bridged(**more: Any) -> dict[str, Any]:
    """Return the parameters of a way there and back, /ping to /pong."""
    return {
        f"{_OUT}.ros_topics": ["/ping"],
        f"{_OUT}./ping.mqtt_topic": "pingpong",
        f"{_IN}.mqtt_topics": ["pingpong"],
        f"{_IN}.pingpong.ros_topic": "/pong",
        **more,
    }


def test_any_type_there_and_back_with_latency(site: Callable[..., Site]) -> None:
    one = site(**bridged(**{f"{_OUT}./ping.inject_timestamp": True}))
    sender = one.node.create_publisher(PointStamped, "/ping", 10)
    back = one.hear(PointStamped, "/pong")
    latencies = one.hear(Float64, "/mqtt_client/latencies/pong")
    point = PointStamped()
    point.header.frame_id, point.point.x = "table", 0.5
    one.until(lambda: back and latencies, lambda: sender.publish(point))
    assert back[-1] == point
    assert 0.0 < latencies[-1].data < 20.0
    kinds = [(topic, payload) for topic, payload, _ in one.heard if topic == "mqtt_client/ros_msg_type/pingpong"]
    assert b"geometry_msgs/msg/PointStamped" in kinds[0][1]
    assert len(kinds) == 1
    payload = next(payload for topic, payload, _ in one.heard if topic == "pingpong")
    assert payload[12:] == serialize_message(point)


def test_single_values_change_their_type(site: Callable[..., Site]) -> None:
    one = site(**bridged(**{f"{_OUT}./ping.primitive": True, f"{_IN}.pingpong.primitive": True}))
    sender = one.node.create_publisher(Int32, "/ping", 10)
    numbers = one.hear(Int32, "/pong")
    one.until(lambda: numbers and one.heard, lambda: sender.publish(Int32(data=42)))
    assert numbers[0].data == 42
    assert ("pingpong", b"42") in [(topic, payload) for topic, payload, _ in one.heard]
    texts = one.hear(String, "/pong")
    one.until(lambda: texts, lambda: one.client.publish("pingpong", "hello"))
    assert texts[0].data == "hello"


def test_json_of_someone_without_ros(site: Callable[..., Site]) -> None:
    kind = "std_msgs/msg/Header"
    one = site(
        **bridged(
            **{f"{_OUT}./ping.json": True, f"{_OUT}./ping.ros_type": kind},
            **{f"{_IN}.pingpong.json": True, f"{_IN}.pingpong.ros_type": kind},
        )
    )
    found = one.hear(Header, "/pong")
    one.until(one.is_connected)
    text = '{"stamp":{"sec":123,"nanosec":456789},"frame_id":"mqtt"}'
    one.until(lambda: found, lambda: one.client.publish("pingpong", text))
    assert (found[0].frame_id, found[0].stamp.nanosec) == ("mqtt", 456789)
    sender = one.node.create_publisher(Header, "/ping", 10)
    wanted = ("pingpong", b'{"stamp":{"sec":0,"nanosec":0},"frame_id":"ros"}')
    one.until(
        lambda: wanted in [(topic, payload) for topic, payload, _ in one.heard],
        lambda: sender.publish(Header(frame_id="ros")),
    )


def test_nonsense_is_refused_and_the_bridge_goes_on(site: Callable[..., Site]) -> None:
    one = site(**bridged(**{f"{_IN}.pingpong.ros_type": "std_msgs/msg/Bool"}))
    found, log = one.hear(Bool, "/pong"), one.hear(Log, "/rosout")
    one.until(one.is_connected)
    one.until(
        lambda: any("is no Bool in CDR" in line.msg for line in log), lambda: one.client.publish("pingpong", b"no")
    )
    good = serialize_message(Bool(data=True))
    one.until(lambda: found, lambda: one.client.publish("pingpong", good))
    assert found[0].data is True
    one.until(
        lambda: any("is no RosMsgType" in line.msg for line in log),
        lambda: one.client.publish("mqtt_client/ros_msg_type/pingpong", b"\x00\x01\x00\x00\xff\xff\xff\xff"),
    )


def test_bridges_of_services(site: Callable[..., Site]) -> None:
    one = site()
    assert one.call(NewRos2MqttBridge, "new_ros2mqtt_bridge", ros_topic="/a", mqtt_topic="b", primitive=True).success
    assert one.call(
        NewMqtt2RosBridge, "new_mqtt2ros_bridge", ros_topic="/c", mqtt_topic="b", primitive=True, ros_latched=True
    ).success
    assert not one.call(NewMqtt2RosBridge, "new_mqtt2ros_bridge", ros_topic="/c").success
    assert not one.call(NewMqtt2RosBridge, "new_mqtt2ros_bridge", ros_topic="/c", mqtt_topic="d", mqtt_qos=7).success
    sender, found = one.node.create_publisher(Bool, "/a", 10), one.hear(Bool, "/c")
    one.until(lambda: found, lambda: sender.publish(Bool(data=True)))
    assert found[0].data is True


def test_lost_broker(node: Node, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    port = free_port()
    client = {"client.id": "cell", "client.buffer.size": 2, "client.last_will.topic": "cell/will"}
    parameters = bridged(**client, **{f"{_OUT}./ping.primitive": True, f"{_OUT}./ping.advanced.mqtt.qos": 1})
    one = Site(node, port, **parameters)
    sender = node.create_publisher(Int32, "/ping", 10)
    waiting = tmp_path / "buffer" / "cell.jsonl"
    one.until(waiting.exists, lambda: sender.publish(Int32(data=1)))
    one.until(lambda: len(waiting.read_text().splitlines()) == 2, lambda: sender.publish(Int32(data=2)))
    with mosquitto(port, tmp_path):
        one.join(port, "pingpong")
        one.until(lambda: len(one.heard) >= 2)
        assert not waiting.exists()
        assert one.heard[0][1] == b"1"
    one.until(lambda: not one.is_connected())
    one.client.loop_stop()
    with mosquitto(port, tmp_path):
        one.join(port, "pingpong")
        one.until(lambda: one.heard, lambda: sender.publish(Int32(data=5)))
    one.close()


def test_buffer_outlives_the_program(tmp_path: Path) -> None:
    file = tmp_path / "folder" / "cell.jsonl"
    message = Outgoing("a/b", b"\x00\xff", 1, False)
    assert Buffer(2, file).add(message)
    with file.open("a") as lines:
        lines.write('nonsense\n["x"]\n[1, "§", 0, 0]\n')
    again = Buffer(2, file)
    assert again.add(message._replace(qos=0))
    assert not again.add(message)
    assert again.take() == [message, message._replace(qos=0)]
    assert not file.exists()
    assert not Buffer(0, file).add(message)


@pytest.mark.parametrize(
    ("parameters", "problem"),
    [
        ({"client.clean_session": False}, "needs a 'client.id'"),
        ({"client.buffer.size": 3}, "needs a 'client.id'"),
        ({"broker.port": 0}, "at least 1"),
        ({"broker.tls.enabled": True, "broker.tls.ca_certificate": "no.pem"}, "no.pem', which does not exist"),
        (bridged(**{f"{_OUT}./ping.json": True}), "'bridge.ros2mqtt./ping.ros_type'"),
        (bridged(**{f"{_IN}.pingpong.advanced.ros.qos.durability": "auto"}), "must be one of system_default"),
    ],
)
@pytest.mark.usefixtures("graph")
def test_parameters_that_are_refused(parameters: dict[str, Any], problem: str) -> None:
    given: list[Parameter] = [Parameter(name, value=value) for name, value in parameters.items()]
    with pytest.raises((UserError, ValueError), match=problem):
        MqttClient(parameter_overrides=given)


def test_wrong_password_is_named(node: Node, tmp_path: Path) -> None:
    port = free_port()
    with mosquitto(port, tmp_path, "allow_anonymous false"):
        one = Site(node, port, **bridged(**{"broker.user": "cell", "broker.pass": "wrong"}))
        log = one.hear(Log, "/rosout")
        one.until(lambda: any("refuses the connection" in line.msg for line in log))
        assert not one.is_connected()
        one.close()


def test_a_bridge_without_its_target_is_left_out(site: Callable[..., Site]) -> None:
    one = site(**{f"{_OUT}.ros_topics": ["/ping"]})
    assert one.bridge.get_parameter(f"{_OUT}./ping.mqtt_topic").value == ""
    assert rclpy.ok()
