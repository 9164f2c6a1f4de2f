"""Asking another node's buffer: a client against the server, and against servers that misbehave."""

import threading
import time
from collections.abc import Iterator

import pytest
import rclpy
from rclpy.action import ActionServer
from rclpy.action.server import GoalResponse
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_ros import (
    Buffer,
    BufferClient,
    BufferServer,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from ros.graph import after, spinning
from ros.transforms import LATEST, SECOND, at, transform, translation

LONG = Duration(seconds=30)
SHORT = Duration(seconds=0.05)


@pytest.fixture
def buffer(graph: object) -> Iterator[Buffer]:
    """The buffer of a server that runs."""
    node = rclpy.create_node("server")
    buffer = Buffer(node=node)
    server = BufferServer(buffer, node, "lookup")
    with spinning(node):
        yield buffer
    server.destroy()
    node.destroy_node()


@pytest.fixture
def client(node: Node) -> Iterator[BufferClient]:
    client = BufferClient(node, "lookup", timeout_padding=2.0)
    yield client
    client.destroy()


def test_what_is_there(buffer: Buffer, client: BufferClient) -> None:
    sent = transform("a", "b", SECOND, (1.0, 2.0, 3.0))
    buffer.set_transform(sent, "me")
    assert client.lookup_transform("a", "b", at(1)) == sent
    assert client.can_transform("a", "b", LATEST) is True
    assert client.can_transform("a", "b", at(5)) is False


def test_what_comes_while_the_server_waits(buffer: Buffer, client: BufferClient) -> None:
    sent = transform("a", "b", SECOND)
    after(0.1, lambda: buffer.set_transform(sent, "me"))
    assert client.lookup_transform("a", "b", LATEST, LONG) == sent
    assert buffer._watchers == ()


def test_two_times(buffer: Buffer, client: BufferClient) -> None:
    for time_s in (1, 2, 3):
        buffer.set_transform(transform("world", "car", time_s * SECOND, (float(time_s), 0.0, 0.0)), "me")
    found = client.lookup_transform_full("car", at(3), "car", at(1), "world")
    assert translation(found) == [-2.0, 0.0, 0.0]
    assert client.can_transform_full("car", at(3), "car", at(1), "world") is True
    assert client.can_transform_full("car", at(9), "car", at(1), "world", SHORT) is False


@pytest.mark.parametrize(
    ("target", "source", "time_s", "kind", "words"),
    [
        ("no", "b", 1, LookupException, '"no" passed to lookupTransform argument target_frame does not exist. '),
        ("a", "y", 1, ConnectivityException, "not part of the same tree"),
        ("a", "b", 9, ExtrapolationException, "extrapolation at time 9.000000"),
        ("", "b", 1, InvalidArgumentException, "cannot be empty"),
    ],
)
def test_the_server_s_errors_are_the_client_s(
    buffer: Buffer, client: BufferClient, target: str, source: str, time_s: int, kind: type[Exception], words: str
) -> None:
    buffer.set_transform(transform("a", "b", SECOND), "me")
    buffer.set_transform(transform("x", "y", SECOND), "me")
    with pytest.raises(kind) as caught:
        client.lookup_transform(target, source, at(time_s), SHORT)
    assert words in str(caught.value)
    assert buffer._watchers == ()


def test_many_clients_wait_at_once(buffer: Buffer, graph: object) -> None:
    found: list[object] = []
    nodes = [rclpy.create_node(f"client{number}") for number in range(5)]
    threads = [
        threading.Thread(
            target=lambda node=node: found.append(BufferClient(node, "lookup").lookup_transform("a", "b", LATEST, LONG))
        )
        for node in nodes
    ]
    for thread in threads:
        thread.start()
    while len(buffer._watchers) < len(threads):
        time.sleep(0.001)
    sent = transform("a", "b", SECOND)
    buffer.set_transform(sent, "me")
    for thread in threads:
        thread.join(10.0)
    assert found == [sent] * len(threads)


def test_a_callback_of_a_single_thread_may_ask(buffer: Buffer, node: Node, client: BufferClient) -> None:
    sent = transform("a", "b", SECOND)
    buffer.set_transform(sent, "me")
    found: list[object] = []
    node.create_timer(0.001, lambda: found.append(client.lookup_transform("a", "b", LATEST, LONG)))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_once(timeout_sec=10.0)
    assert found == [sent]


def test_no_server(node: Node) -> None:
    client = BufferClient(node, "nobody")
    with pytest.raises(TimeoutException, match="The BufferServer is not ready"):
        client.lookup_transform("a", "b", LATEST, LONG)
    assert client.can_transform("a", "b", LATEST) is False


def test_a_message_as_time_still_works(buffer: Buffer, client: BufferClient) -> None:
    sent = transform("a", "b", SECOND)
    buffer.set_transform(sent, "me")
    with pytest.warns(DeprecationWarning, match=r"rclpy\.time\.Time"):
        assert client.lookup_transform("a", "b", at(1).to_msg()) == sent
    with pytest.raises(TypeError, match=r"Must pass a rclpy\.time\.Time object"):
        client.lookup_transform("a", "b", 1.0)


# Servers of another make


class OtherServer:
    """Answers what it is told to."""

    def __init__(self, answer: LookupTransform.Result | None, accepts: bool = True) -> None:
        self.node = rclpy.create_node("other")
        self.answer = answer
        self.go_on = threading.Event()
        self.goals: list[LookupTransform.Goal] = []
        response = GoalResponse.ACCEPT if accepts else GoalResponse.REJECT
        self.server = ActionServer(
            self.node, LookupTransform, "lookup", self.execute, goal_callback=lambda goal: response
        )

    def execute(self, goal_handle: object) -> LookupTransform.Result:
        self.goals.append(goal_handle.request)
        if self.answer is None:
            self.go_on.wait(20.0)
        goal_handle.succeed()
        return self.answer or LookupTransform.Result()


@pytest.mark.parametrize(
    ("error", "kind"),
    [
        (TF2Error.LOOKUP_ERROR, LookupException),
        (TF2Error.CONNECTIVITY_ERROR, ConnectivityException),
        (TF2Error.EXTRAPOLATION_ERROR, ExtrapolationException),
        (TF2Error.INVALID_ARGUMENT_ERROR, InvalidArgumentException),
        (TF2Error.TIMEOUT_ERROR, TimeoutException),
        (TF2Error.TRANSFORM_ERROR, TransformException),
        (99, TransformException),
    ],
)
def test_every_error_has_its_exception(graph: object, client: BufferClient, error: int, kind: type[Exception]) -> None:
    server = OtherServer(LookupTransform.Result(error=TF2Error(error=error, error_string="so it is")))
    with spinning(server.node), pytest.raises(kind, match="so it is") as caught:
        client.lookup_transform("a", "b", LATEST)
    assert type(caught.value) is kind


def test_what_is_asked(graph: object, client: BufferClient) -> None:
    server = OtherServer(LookupTransform.Result(transform=transform("a", "b", 7)))
    with spinning(server.node):
        client.lookup_transform("a", "b", at(1.5), Duration(seconds=2.5))
        client.lookup_transform_full("a", at(1), "b", at(2), "f")
    simple, full = server.goals
    assert (simple.target_frame, simple.source_frame, simple.advanced) == ("a", "b", False)
    assert (simple.source_time, simple.timeout) == (at(1.5).to_msg(), Duration(seconds=2.5).to_msg())
    assert (full.target_time, full.source_time, full.fixed_frame, full.advanced) == (
        at(1).to_msg(),
        at(2).to_msg(),
        "f",
        True,
    )


def test_a_server_that_refuses(graph: object, client: BufferClient) -> None:
    server = OtherServer(LookupTransform.Result(), accepts=False)
    with spinning(server.node), pytest.raises(TimeoutException, match="accepted status"):
        client.lookup_transform("a", "b", LATEST)


@pytest.mark.slow
def test_a_server_that_never_answers(node: Node) -> None:
    server = OtherServer(None)
    client = BufferClient(node, "lookup", timeout_padding=Duration(seconds=0.1))
    executor = MultiThreadedExecutor(2)
    executor.add_node(server.node)
    thread = threading.Thread(target=lambda: executor.spin_until_future_complete(rclpy.task.Future(), 15.0))
    thread.start()
    start = time.monotonic()
    with pytest.raises(TimeoutException, match="did not come back in the specified time"):
        client.lookup_transform("a", "b", LATEST)
    assert time.monotonic() - start < 10.0
    server.go_on.set()
    executor.shutdown()
    thread.join()


def test_a_server_that_is_not_spun(graph: object, node: Node) -> None:
    OtherServer(LookupTransform.Result())
    client = BufferClient(node, "lookup", timeout_padding=Duration(seconds=0.1))
    with pytest.raises(TimeoutException, match="did not come back in the specified time"):
        client.lookup_transform("a", "b", LATEST, SHORT)
