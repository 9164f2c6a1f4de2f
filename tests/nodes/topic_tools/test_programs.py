"""The tools for topics, run as programs."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import pytest

from nodes.terminal import Terminal

pytestmark = pytest.mark.slow


@contextlib.contextmanager
def publishing(topic: str, rate: float, text: str, domain: int) -> Iterator[Terminal]:
    words = ("topic", "pub", "-r", str(rate), topic, "std_msgs/msg/String", f"{{data: {text}}}")
    with Terminal(*words, domain=domain) as program:
        program.wait_for("publishing #2")
        yield program


@contextlib.contextmanager
def tool(*words: str, domain: int) -> Iterator[Terminal]:
    with Terminal("run", "topic_tools", *words, domain=domain) as program:
        yield program
        assert program.interrupt() == 0


def rate_of(topic: str, domain: int) -> float:
    with Terminal("topic", "hz", topic, domain=domain) as hz:
        line = hz.wait_for("average rate: ", 2)[1]
        hz.interrupt()
    return float(line.split()[2])


def first_of(topic: str, domain: int, kind: str = "std_msgs/msg/String") -> str:
    with Terminal("topic", "echo", "--once", topic, kind, domain=domain) as echo:
        assert echo.wait(30) == 0
        return echo.lines[0]


def test_relay(domain: int) -> None:
    with publishing("/chatter", 10, "hello", domain), tool("relay", "/chatter", domain=domain):
        assert first_of("/chatter_relay", domain) == "data: hello"


def test_relay_by_parameters_and_lazily(domain: int) -> None:
    parameters = ("input_topic:=/chatter", "output_topic:=/out", "lazy:=true")
    words = [word for parameter in parameters for word in ("-p", parameter)]
    with publishing("/chatter", 10, "hello", domain), tool("relay", "--ros-args", *words, domain=domain):
        assert first_of("/out", domain) == "data: hello"
        with Terminal("topic", "info", "/chatter", domain=domain) as info:
            info.wait_for("Subscription count: 0")  # nobody listens any more


def test_throttle_messages(domain: int) -> None:
    with (
        publishing("/chatter", 50, "hello", domain),
        tool("throttle", "messages", "/chatter", "10", "/few", domain=domain),
    ):
        assert rate_of("/few", domain) == pytest.approx(10.0, rel=0.15)


def test_throttle_bytes(domain: int) -> None:
    words = ("throttle", "bytes", "/chatter", "140", "1.0")  # a message has 14 bytes
    with publishing("/chatter", 50, "hello", domain), tool(*words, domain=domain):
        assert first_of("/chatter_throttle", domain) == "data: hello"


def test_drop(domain: int) -> None:
    with publishing("/chatter", 30, "hello", domain), tool("drop", "/chatter", "2", "3", domain=domain):
        assert rate_of("/chatter_drop", domain) == pytest.approx(10.0, rel=0.15)


def test_delay(domain: int) -> None:
    with (
        Terminal("topic", "echo", "/chatter_delay", "std_msgs/msg/String", domain=domain) as echo,
        tool("delay", "/chatter", "1.5", domain=domain),
        publishing("/chatter", 2, "late", domain) as publisher,
    ):
        echo.wait_for("data: late")
        assert "publishing #3" in publisher.text  # that was a second after the first
        echo.interrupt()


def test_mux(domain: int) -> None:
    with (
        publishing("/a", 10, "from_a", domain),
        publishing("/b", 10, "from_b", domain),
        tool("mux", "/out", "/a", domain=domain) as mux,
    ):
        assert first_of("/out", domain) == "data: from_a"
        call(domain, "/mux/add", "MuxAdd", "{topic: /b}", "success=True")
        call(domain, "/mux/list", "MuxList", "{}", "'/a', '/b'")
        call(domain, "/mux/select", "MuxSelect", "{topic: /b}", "prev_topic='/a', success=True")
        mux.wait_for("selected /b")
        assert first_of("/out", domain) == "data: from_b"
        assert first_of("/mux/selected", domain) == "data: /b"
        call(domain, "/mux/delete", "MuxDelete", "{topic: /b}", "success=False")
        call(domain, "/mux/select", "MuxSelect", "{topic: /c}", "success=False")


def test_demux(domain: int) -> None:
    with publishing("/in", 10, "hello", domain), tool("demux", "/in", "/a", "/b", domain=domain):
        assert first_of("/a", domain) == "data: hello"
        call(domain, "/demux/select", "DemuxSelect", "{topic: /b}", "prev_topic='/a', success=True")
        assert first_of("/b", domain) == "data: hello"


def call(domain: int, service: str, kind: str, request: str, expected: str) -> None:
    with Terminal("service", "call", service, f"topic_tools_interfaces/srv/{kind}", request, domain=domain) as command:
        command.wait_for(expected)


def test_relay_field(domain: int) -> None:
    fields = "{stamp: {sec: 7, nanosec: 0}, frame_id: m.data}"
    words = ("relay_field", "/chatter", "/header", "std_msgs/Header", fields, "--wait-for-start")
    with (
        tool(*words, domain=domain),
        publishing("/chatter", 10, "odom", domain),
        Terminal("topic", "echo", "--once", "/header", "std_msgs/msg/Header", domain=domain) as echo,
    ):
        echo.wait_for("sec: 7")
        echo.wait_for("frame_id: odom")


def test_transform(domain: int) -> None:
    words = ("transform", "/chatter", "--field", "data", "/length", "std_msgs/Float64", "numpy.sqrt(len(m))")
    with publishing("/chatter", 10, "four", domain), tool(*words, "--import", "numpy", domain=domain):
        assert first_of("/length", domain, "std_msgs/msg/Float64") == "data: 2.0"


@pytest.mark.parametrize(
    ("words", "status", "error"),
    [
        (("drop", "/chatter", "2"), 1, "usage: drop <intopic> <X> <Y> [outtopic]"),
        (("drop", "/chatter", "3", "2"), 2, "parameter 'x' of /drop must be at most 'y', got x = 3 and y = 2"),
        (("throttle", "words", "/chatter", "2"), 1, "usage: throttle messages"),
        (("relay",), 2, "parameter 'input_topic' of /relay must not be empty"),
        (("transform", "/nobody", "/out", "std_msgs/Float64"), 2, "nobody publishes /nobody"),
        (("transform", "/chatter", "/out", "std_msgs/Flat64"), 2, "the message type 'std_msgs/Flat64' is unknown"),
    ],
)
def test_mistakes_are_named(words: tuple[str, ...], status: int, error: str, domain: int) -> None:
    with Terminal("run", "topic_tools", *words, domain=domain) as program:
        assert program.wait(30) == status
        assert error in program.text


def test_a_mistake_in_an_expression_is_named(domain: int) -> None:
    words = ("run", "topic_tools", "transform", "/chatter", "/out", "std_msgs/Float64", "m.dat")
    with publishing("/chatter", 10, "hello", domain), Terminal(*words, domain=domain) as program:
        assert program.wait(30) == 2
        assert "the expression 'm.dat' cannot be evaluated: AttributeError" in program.text
