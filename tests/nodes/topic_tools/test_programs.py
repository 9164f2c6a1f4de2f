"""The tools for topics, run as programs."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import pytest

from nodes.stepped_terminal import Terminal, Terminals

pytestmark = [pytest.mark.slow, pytest.mark.scenario(timeout=300, record=False)]


@contextlib.contextmanager
def publishing(topic: str, rate: float, text: str, terminal: Terminals) -> Iterator[Terminal]:
    words = ("topic", "pub", "-r", str(rate), topic, "std_msgs/msg/String", f"{{data: {text}}}")
    with terminal(*words) as program:
        program.wait_for("publishing #2")
        yield program


@contextlib.contextmanager
def tool(*words: str, terminal: Terminals) -> Iterator[Terminal]:
    with terminal("run", "topic_tools", *words) as program:
        yield program
        assert program.interrupt() == 0


def rate_of(topic: str, terminal: Terminals) -> float:
    with terminal("topic", "hz", topic) as hz:
        line = hz.wait_for("average rate: ", 2)[1]
        hz.interrupt()
    return float(line.split()[2])


def first_of(topic: str, terminal: Terminals, kind: str = "std_msgs/msg/String") -> str:
    with terminal("topic", "echo", "--once", topic, kind) as echo:
        assert echo.wait(30) == 0
        return echo.lines[0]


def test_relay(terminal: Terminals) -> None:
    with publishing("/chatter", 10, "hello", terminal), tool("relay", "/chatter", terminal=terminal):
        assert first_of("/chatter_relay", terminal) == "data: hello"


def test_relay_by_parameters_and_lazily(terminal: Terminals) -> None:
    parameters = ("input_topic:=/chatter", "output_topic:=/out", "lazy:=true")
    words = [word for parameter in parameters for word in ("-p", parameter)]
    with publishing("/chatter", 10, "hello", terminal), tool("relay", "--ros-args", *words, terminal=terminal):
        assert first_of("/out", terminal) == "data: hello"
        with terminal("topic", "info", "/chatter") as info:
            info.wait_for("Subscription count: 0")  # nobody listens any more


def test_throttle_messages(terminal: Terminals) -> None:
    with (
        publishing("/chatter", 50, "hello", terminal),
        tool("throttle", "messages", "/chatter", "10", "/few", terminal=terminal),
    ):
        assert rate_of("/few", terminal) == pytest.approx(10.0, rel=0.01)


def test_throttle_bytes(terminal: Terminals) -> None:
    words = ("throttle", "bytes", "/chatter", "140", "1.0")  # a message has 14 bytes
    with publishing("/chatter", 50, "hello", terminal), tool(*words, terminal=terminal):
        assert first_of("/chatter_throttle", terminal) == "data: hello"


def test_drop(terminal: Terminals) -> None:
    with publishing("/chatter", 30, "hello", terminal), tool("drop", "/chatter", "2", "3", terminal=terminal):
        assert rate_of("/chatter_drop", terminal) == pytest.approx(10.0, rel=0.01)


def test_delay(terminal: Terminals) -> None:
    with (
        terminal("topic", "echo", "/chatter_delay", "std_msgs/msg/String") as echo,
        tool("delay", "/chatter", "1.5", terminal=terminal),
        publishing("/chatter", 2, "late", terminal) as publisher,
    ):
        echo.wait_for("data: late")
        assert "publishing #3" in publisher.text  # that was a second after the first
        echo.interrupt()


def test_mux(terminal: Terminals) -> None:
    with (
        publishing("/a", 10, "from_a", terminal),
        publishing("/b", 10, "from_b", terminal),
        tool("mux", "/out", "/a", terminal=terminal) as mux,
    ):
        assert first_of("/out", terminal) == "data: from_a"
        call(terminal, "/mux/add", "MuxAdd", "{topic: /b}", "success=True")
        call(terminal, "/mux/list", "MuxList", "{}", "'/a', '/b'")
        call(terminal, "/mux/select", "MuxSelect", "{topic: /b}", "prev_topic='/a', success=True")
        mux.wait_for("selected /b")
        assert first_of("/out", terminal) == "data: from_b"
        assert first_of("/mux/selected", terminal) == "data: /b"
        call(terminal, "/mux/delete", "MuxDelete", "{topic: /b}", "success=False")
        call(terminal, "/mux/select", "MuxSelect", "{topic: /c}", "success=False")


def test_demux(terminal: Terminals) -> None:
    with publishing("/in", 10, "hello", terminal), tool("demux", "/in", "/a", "/b", terminal=terminal):
        assert first_of("/a", terminal) == "data: hello"
        call(terminal, "/demux/select", "DemuxSelect", "{topic: /b}", "prev_topic='/a', success=True")
        assert first_of("/b", terminal) == "data: hello"


def call(terminal: Terminals, service: str, kind: str, request: str, expected: str) -> None:
    with terminal("service", "call", service, f"topic_tools_interfaces/srv/{kind}", request) as command:
        command.wait_for(expected)


def test_relay_field(terminal: Terminals) -> None:
    fields = "{stamp: {sec: 7, nanosec: 0}, frame_id: m.data}"
    words = ("relay_field", "/chatter", "/header", "std_msgs/Header", fields, "--wait-for-start")
    with (
        tool(*words, terminal=terminal),
        publishing("/chatter", 10, "odom", terminal),
        terminal("topic", "echo", "--once", "/header", "std_msgs/msg/Header") as echo,
    ):
        echo.wait_for("sec: 7")
        echo.wait_for("frame_id: odom")


def test_transform(terminal: Terminals) -> None:
    words = ("transform", "/chatter", "--field", "data", "/length", "std_msgs/Float64", "numpy.sqrt(len(m))")
    with publishing("/chatter", 10, "four", terminal), tool(*words, "--import", "numpy", terminal=terminal):
        assert first_of("/length", terminal, "std_msgs/msg/Float64") == "data: 2.0"


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
def test_mistakes_are_named(words: tuple[str, ...], status: int, error: str, terminal: Terminals) -> None:
    with terminal("run", "topic_tools", *words) as program:
        assert program.wait(30) == status
        assert error in program.text


def test_a_mistake_in_an_expression_is_named(terminal: Terminals) -> None:
    words = ("run", "topic_tools", "transform", "/chatter", "/out", "std_msgs/Float64", "m.dat")
    with publishing("/chatter", 10, "hello", terminal), terminal(*words) as program:
        assert program.wait(30) == 2
        assert "the expression 'm.dat' cannot be evaluated: AttributeError" in program.text
