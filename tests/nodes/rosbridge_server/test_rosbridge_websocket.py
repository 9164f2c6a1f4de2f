"""Clients of the rosbridge protocol, over real WebSockets: topics, services, actions, and what is refused."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import sys
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import aiohttp
import pytest
from PIL import Image
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosbridge_library.internal.publishers import manager as publishers
from std_msgs.msg import String

from daidalos.nodes.rosbridge_server.rosbridge_websocket import RosbridgeWebsocket
from ros.graph import graph, node, spinning  # noqa: F401

LIMIT_S = 60.0
Talk = Callable[..., Awaitable[None]]


class Client:
    """A client that waits for messages."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self._waiting: list[Any] = []

    async def say(self, op: str, **fields: Any) -> None:
        await self.socket.send_json({"op": op, **fields})

    async def expect(self, op: str | None = None, **fields: Any) -> Any:
        """Return the first message with these fields; other ones wait."""
        async with asyncio.timeout(LIMIT_S):
            while True:
                for message in self._waiting:
                    wanted = {**fields, **({} if op is None else {"op": op})}
                    if isinstance(message, dict) and wanted.items() <= message.items():
                        self._waiting.remove(message)
                        return message
                self._waiting.append(await self.receive())

    async def receive(self) -> Any:
        async with asyncio.timeout(LIMIT_S):
            message = await self.socket.receive()
        if message.type is aiohttp.WSMsgType.TEXT:
            return json.loads(message.data)
        if message.type is aiohttp.WSMsgType.BINARY:
            return message.data
        raise ConnectionError(f"closed: {self.socket.close_code} {message.extra}")

    async def sync(self) -> None:
        """Return once what was said before is done."""
        await self.say("call_service", service="/no_such_service", id="sync")
        await self.expect("service_response", id="sync")


@pytest.fixture
def server(node: Node) -> Iterator[RosbridgeWebsocket]:  # noqa: F811
    made = RosbridgeWebsocket(
        context=node.context,
        parameter_overrides=[Parameter("port", value=0), Parameter("unregister_timeout", value=0.0)],
    )
    with spinning(node), spinning(made):
        yield made
        made.destroy_node()


def talk(server: RosbridgeWebsocket, conversation: Talk, clients: int = 1, **connection: Any) -> None:
    async def run() -> None:
        async with aiohttp.ClientSession() as session:
            opened = [await session.ws_connect(server.server.address, **connection) for _ in range(clients)]
            await conversation(*map(Client, opened))
            for one in opened:
                await one.close()

    asyncio.run(run())


def test_messages_reach_the_graph_and_come_back(server: RosbridgeWebsocket) -> None:
    async def conversation(client: Client) -> None:
        await client.say("advertise", topic="/chat", type="std_msgs/String")
        await client.say("subscribe", topic="/chat", type="std_msgs/msg/String")
        await client.say("publish", topic="/chat", msg={"data": "hello"})
        assert await client.expect("publish") == {"op": "publish", "topic": "/chat", "msg": {"data": "hello"}}
        await client.say("unsubscribe", topic="/chat")
        await client.sync()
        assert not server.count_subscribers("/chat")

    talk(server, conversation)


def test_messages_come_in_the_form_that_was_asked_for(server: RosbridgeWebsocket) -> None:
    async def conversation(client: Client) -> None:
        for compression in ("cbor", "cbor-raw", "png"):
            topic = f"/{compression[-3:]}"
            await client.say("advertise", topic=topic, type="std_msgs/Float32MultiArray")
            await client.say("subscribe", topic=topic, compression=compression)
            await client.say("publish", topic=topic, msg={"data": [1.0]})
            frame = await client.receive()
            if compression == "cbor":
                assert frame.startswith(b"\xa3bop\x67publish")
                assert b"\xd8\x55\x44\x00\x00\x80\x3f" in frame
            elif compression == "cbor-raw":
                assert b"ebytes" in frame
                assert b"\x00\x01\x00\x00" in frame
            else:
                assert frame["op"] == "png"
                pixels = Image.open(io.BytesIO(base64.b64decode(frame["data"]))).tobytes()
                assert json.loads(pixels)["msg"]["data"] == [1.0]

    talk(server, conversation)


def test_a_publisher_that_came_later_with_less_is_heard(server: RosbridgeWebsocket, node: Node) -> None:  # noqa: F811
    async def conversation(client: Client) -> None:
        await client.say("subscribe", topic="/late", type="std_msgs/String")
        await client.sync()
        publisher = node.create_publisher(
            String, "/late", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        )
        answer = asyncio.create_task(client.expect("publish"))
        while not answer.done():
            publisher.publish(String(data="heard"))
            await asyncio.sleep(0.05)
        assert (await answer)["msg"] == {"data": "heard"}

    talk(server, conversation)


@pytest.mark.slow
def test_one_client_serves_what_another_one_calls(server: RosbridgeWebsocket) -> None:
    async def conversation(serving: Client, calling: Client) -> None:
        await serving.say("advertise_service", service="/flip", type="std_srvs/SetBool")
        await serving.sync()
        await calling.say("call_service", service="/flip", args=[True], id="a")
        request = await serving.expect("call_service")
        assert request["args"] == {"data": True}
        await calling.say("service_response", service="/flip", id=request["id"], values={"success": False}, result=True)
        await calling.sync()  # not its service
        await serving.say(
            "service_response",
            service="/flip",
            id=request["id"],
            values={"success": True, "message": "ok"},
            result=True,
        )
        response = await calling.expect("service_response", id="a")
        assert (response["result"], response["values"]) == (True, {"success": True, "message": "ok"})

        await calling.say("call_service", service="/flip", args={"data": True}, id="b", timeout=0.2)
        await serving.expect("call_service")
        await serving.say("unadvertise_service", service="/flip")
        assert "Timeout" in (await calling.expect("service_response", id="b", result=False))["values"]
        await serving.sync()
        await calling.say("call_service", service="/flip", id="c")
        assert "does not exist" in (await calling.expect("service_response", id="c", result=False))["values"]

    talk(server, conversation, clients=2)


def test_one_client_carries_out_the_goals_of_another_one(server: RosbridgeWebsocket) -> None:
    async def conversation(acting: Client, asking: Client) -> None:
        kind = "example_interfaces/Fibonacci"
        await acting.say("advertise_action", action="/fib", type=kind)
        await acting.sync()
        await asking.say("send_action_goal", action="/fib", action_type=kind, args={"order": 3}, id="1", feedback=True)
        goal = await acting.expect("send_action_goal")
        assert goal["args"] == {"order": 3}
        await acting.say("action_feedback", action="/fib", id=goal["id"], values={"sequence": [0, 1]})
        assert (await asking.expect("action_feedback", id="1"))["values"] == {"sequence": [0, 1]}
        await acting.say(
            "action_result", action="/fib", id=goal["id"], values={"sequence": [0, 1, 1]}, status=4, result=True
        )
        result = await asking.expect("action_result", id="1")
        assert (result["status"], result["values"], result["result"]) == (4, {"sequence": [0, 1, 1]}, True)

        await asking.say("send_action_goal", action="/fib", action_type=kind, args=[5], id="2")
        goal = await acting.expect("send_action_goal")
        await asking.say("cancel_action_goal", action="/fib", id="2")
        await acting.expect("cancel_action_goal", id=goal["id"])
        await acting.say("action_result", action="/fib", id=goal["id"], values={}, status=5, result=True)
        assert (await asking.expect("action_result", id="2"))["status"] == 5

        await asking.say("send_action_goal", action="/fib", action_type=kind, args=[5], id="3")
        await acting.expect("send_action_goal")
        await acting.say("unadvertise_action", action="/fib")
        assert (await asking.expect("action_result", id="3"))["status"] == 6

    talk(server, conversation, clients=2)


def test_messages_in_pieces_and_pictures_are_put_together(server: RosbridgeWebsocket) -> None:
    async def conversation(client: Client) -> None:
        inner = json.dumps({"op": "call_service", "service": "/none", "id": "inner"})
        for num in (1, 0):
            piece = inner[:10] if num == 0 else inner[10:]
            await client.say("fragment", id="f", num=num, total=2, data=piece)
        await client.expect("service_response", id="inner")
        padded = inner.encode().ljust(90, b"\n")
        picture = io.BytesIO()
        Image.frombytes("RGB", (6, 5), padded).save(picture, "png")
        await client.say("png", data=base64.b64encode(picture.getvalue()).decode())
        await client.expect("service_response", id="inner")
        await client.say("call_service", service="/" + "x" * 300, id="long", fragment_size=100)
        pieces = [await client.expect("fragment", num=num) for num in range(4)]
        text = "".join(piece["data"] for piece in pieces)
        while len(text) and not text.endswith("}"):
            text += (await client.expect("fragment"))["data"]
        assert json.loads(text)["id"] == "long"

    talk(server, conversation)


def test_faults_are_told_to_who_asks_for_them_and_end_nothing(server: RosbridgeWebsocket) -> None:
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"op": "fly"}, "expected one of: .*subscribe"),
        ({"topic": "/a"}, "no field 'op'"),
        ({"op": ["publish"]}, "expected one of"),
        ({"op": "subscribe"}, "Expected a topic field"),
        ({"op": "subscribe", "topic": 3}, "topic to be str"),
        ({"op": "subscribe", "topic": "/nobody"}, "not yet advertised"),
        ({"op": "subscribe", "topic": "/a", "type": "std_msgs/Strin"}, "Strin"),
        ({"op": "subscribe", "topic": "/a b", "type": "std_msgs/String"}, "invalid"),
        ({"op": "subscribe", "topic": "/a", "type": "std_msgs/String", "compression": "zip"}, "png"),
        ({"op": "advertise", "topic": "/a", "type": "antigravity/String"}, "no package 'antigravity'"),
        ({"op": "publish", "topic": "/known", "msg": {"dat": 1}}, "does not have a field dat"),
        ({"op": "publish", "topic": "/known", "msg": {"data": 1}}, "requires a string"),
        ({"op": "fragment", "id": 1, "num": 5, "total": 2, "data": ""}, "piece 5 of 2"),
        ({"op": "png", "data": "AAAA"}, "png: "),
        ({"op": "unadvertise_service", "service": "/rosapi/topics"}, "has not been advertised"),
        ({"op": "cancel_action_goal", "action": "/a", "id": "9"}, "no goal"),
        ({"op": "set_level", "level": "loud"}, "info, warning, error, none"),
    ]

    async def conversation(client: Client) -> None:
        await client.say("nothing is told so far")
        await client.say("set_level", level="error")
        await client.say("advertise", topic="/known", type="std_msgs/String")
        for message, reason in wrong:
            await client.socket.send_json(message)
            status = await client.expect()
            assert (status["op"], status["level"]) == ("status", "error")
            with pytest.raises(AssertionError, match=reason):
                raise AssertionError(status["msg"])
        for text in ("{", "[1]", "[" * 100_000):
            await client.socket.send_str(text)
            assert "JSON" in (await client.expect("status"))["msg"]
        assert "antigravity" not in sys.modules

    talk(server, conversation)


def test_who_leaves_takes_everything_along(server: RosbridgeWebsocket) -> None:
    async def conversation(client: Client) -> None:
        await client.say("advertise", topic="/gone", type="std_msgs/String")
        await client.say("subscribe", topic="/gone", queue_length=3, throttle_rate=10)
        await client.say("advertise_service", service="/gone_service", type="std_srvs/Empty")
        await client.say("advertise_action", action="/gone_action", type="example_interfaces/Fibonacci")
        await client.sync()

    def held() -> list[str]:
        topics = [name for name, _ in server.get_topic_names_and_types() if "gone" in name]
        services = [name for name, _ in server.get_service_names_and_types() if "gone" in name]
        return topics + services + [name for name in publishers._publishers if "gone" in name]

    async def wait() -> None:
        async with asyncio.timeout(LIMIT_S):
            while held():
                await asyncio.sleep(0.02)

    talk(server, conversation)
    asyncio.run(wait())


def test_pages_of_other_servers_are_refused_and_named_in_the_log(
    server: RosbridgeWebsocket, capfd: pytest.CaptureFixture[str]
) -> None:
    async def conversation(client: Client) -> None:
        raise AssertionError("connected")

    with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
        talk(server, conversation, headers={"Origin": "http://localhost:8000"})
    assert "'allowed_origins', now without 'http://localhost:8000'" in capfd.readouterr().err


def test_a_page_that_was_named_may_connect(node: Node) -> None:  # noqa: F811
    settings = {"port": 0, "allowed_origins": ["http://localhost:8000"], "topics_glob": "[/yes, /also/*]"}
    made = RosbridgeWebsocket(
        context=node.context, parameter_overrides=[Parameter(name, value=value) for name, value in settings.items()]
    )

    async def conversation(client: Client) -> None:
        await client.say("set_level", level="error")
        await client.say("subscribe", topic="/no", type="std_msgs/String")
        assert "matches none" in (await client.expect("status"))["msg"]
        await client.say("advertise", topic="/also/this", type="std_msgs/String")
        await client.sync()
        assert made.count_publishers("/also/this") == 1

    with spinning(made):
        talk(made, conversation, headers={"Origin": "http://localhost:8000"})
        made.destroy_node()


def test_a_used_port_is_tried_again(node: Node, server: RosbridgeWebsocket, capfd: pytest.CaptureFixture[str]) -> None:  # noqa: F811
    port = server.server.port
    overrides = [Parameter("port", value=port), Parameter("retry_startup_delay", value=0.05)]
    second = RosbridgeWebsocket(context=node.context, parameter_overrides=overrides)
    assert f"port {port} is used" in capfd.readouterr().err
    server.server.stop()

    async def conversation(client: Client) -> None:
        await client.sync()

    async def wait() -> None:
        async with asyncio.timeout(LIMIT_S):
            while not second.has_parameter("actual_port"):
                await asyncio.sleep(0.02)

    with spinning(second):
        asyncio.run(wait())
        talk(second, conversation)
        second.destroy_node()
