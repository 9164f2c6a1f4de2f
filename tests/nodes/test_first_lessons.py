"""The demonstrations and the smallest examples, run as a course does."""

from __future__ import annotations

import contextlib

import pytest

from nodes.terminal import Terminal, until_node

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("talker", "said", "listener", "received"),
    [
        (
            ("demo_nodes_py", "talker"),
            'Publishing: "Hello World: 0"',
            ("demo_nodes_py", "listener"),
            r"I heard: \[Hello",
        ),
        (
            ("demo_nodes_cpp", "talker"),
            "Publishing: 'Hello World: 1'",
            ("demo_nodes_cpp", "listener"),
            r"I heard: \[Hello",
        ),
        (
            ("demo_nodes_py", "talker"),
            "Hello World",
            ("demo_nodes_py", "listener_serialized"),
            "I heard: .*Hello",
        ),
        (
            ("demo_nodes_py", "talker_qos"),
            "Best effort talker",
            ("demo_nodes_py", "listener_qos"),
            "Best effort listener",
        ),
        (
            ("demo_nodes_py", "talker_qos", "--reliable"),
            "Reliable talker",
            ("demo_nodes_py", "listener_qos", "--reliable"),
            r"I heard: \[Hello",
        ),
        (
            ("examples_rclpy_minimal_publisher", "publisher_member_function"),
            r'\[minimal_publisher\]: Publishing: "Hello World: 0"',
            ("examples_rclpy_minimal_subscriber", "subscriber_member_function"),
            r'\[minimal_subscriber\]: I heard: "Hello World: \d+"',
        ),
        (
            ("examples_rclpy_minimal_publisher", "publisher_old_school"),
            'Publishing: "Hello World: 0"',
            ("examples_rclpy_minimal_subscriber", "subscriber_lambda"),
            "I heard: ",
        ),
    ],
)
def test_talker_and_listener(
    talker: tuple[str, ...], said: str, listener: tuple[str, ...], received: str, domain: int
) -> None:
    with Terminal("run", *talker, domain=domain) as one, Terminal("run", *listener, domain=domain) as other:
        one.wait_for(said)
        other.wait_for(received)
        assert other.interrupt() == 0
        assert one.interrupt() == 0


@pytest.mark.parametrize(
    ("server", "client", "result"),
    [
        (
            ("demo_nodes_py", "add_two_ints_server"),
            ("demo_nodes_py", "add_two_ints_client"),
            "Result of add_two_ints: 5",
        ),
        (
            ("demo_nodes_cpp", "add_two_ints_server"),
            ("demo_nodes_cpp", "add_two_ints_client_async"),
            "Result of add_two_ints: 5",
        ),
        (
            ("examples_rclpy_minimal_service", "service_member_function"),
            ("examples_rclpy_minimal_client", "client_async_member_function"),
            r"Result of add_two_ints: for 41 \+ 1 = 42",
        ),
    ],
)
def test_service_and_client(server: tuple[str, ...], client: tuple[str, ...], result: str, domain: int) -> None:
    with Terminal("run", *client, domain=domain) as asker, Terminal("run", *server, domain=domain) as adder:
        asker.wait_for(result)
        assert asker.wait() == 0
        adder.wait_for("Incoming request")
        adder.wait_for(r"a: \d+ b: \d")
        assert adder.interrupt() == 0


@pytest.mark.parametrize(
    ("server", "client"),
    [
        (("action_tutorials_py", "fibonacci_action_server"), ("action_tutorials_py", "fibonacci_action_client")),
        (("examples_rclpy_minimal_action_server", "server"), ("examples_rclpy_minimal_action_client", "client")),
    ],
)
def test_action(server: tuple[str, ...], client: tuple[str, ...], domain: int) -> None:
    with Terminal("run", *server, domain=domain) as one, Terminal("run", *client, domain=domain) as other:
        other.wait_for(r"Goal accepted :\)")
        other.wait_for(r"Received feedback: array\('i', \[0, 1, 1, 2, 3\]\)")
        other.wait_for(r"Result: array\('i', \[0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55\]\)")
        assert other.wait() == 0
        one.wait_for("Executing goal...")
        assert one.interrupt() == 0


def test_action_that_is_cancelled(domain: int) -> None:
    package = "examples_rclpy_minimal_action"
    with (
        Terminal("run", f"{package}_server", "server_queue_goals", domain=domain) as server,
        Terminal("run", f"{package}_client", "client_cancel", domain=domain) as client,
    ):
        client.wait_for("Goal successfully canceled")
        assert client.wait() == 0
        server.wait_for("Received cancel request")
        server.wait_for("Goal canceled")
        assert server.interrupt() == 0


def test_a_new_goal_ends_the_one_before(domain: int) -> None:
    package = "examples_rclpy_minimal_action"
    with contextlib.ExitStack() as stack:
        server = stack.enter_context(Terminal("run", f"{package}_server", "server_single_goal", domain=domain))
        first = stack.enter_context(Terminal("run", f"{package}_client", "client", domain=domain))
        first.wait_for("Received feedback")
        stack.enter_context(Terminal("run", f"{package}_client", "client", domain=domain))
        first.wait_for("Goal failed with status: 6")
        server.wait_for("Aborting previous goal")
        assert server.interrupt() == 0


def test_parameters(domain: int) -> None:
    with (
        Terminal("run", "demo_nodes_cpp", "parameter_blackboard", domain=domain) as board,
        Terminal("run", "demo_nodes_py", "async_param_client", domain=domain) as client,
    ):
        board.wait_for(
            "Parameter blackboard node named '/parameter_blackboard' ready, and serving '.' parameters already!"
        )
        client.wait_for("  - string_parameter: Hello World")
        client.wait_for("  string_parameter: successful: True", 2)
        assert client.wait() == 0
        assert board.interrupt() == 0


def test_a_parameter_that_sets_another(domain: int) -> None:
    with Terminal("run", "demo_nodes_py", "set_parameters_callback", domain=domain) as node:
        until_node("^/set_param_callback_node$", domain=domain)
        with Terminal("param", "set", "/set_param_callback_node", "param1", "10.0", domain=domain) as command:
            command.wait_for("Set parameter successful")
        node.wait_for("param1 is now 10.0")
        node.wait_for("param2 is now 4.0")
        assert node.interrupt() == 0


def test_introspection(domain: int) -> None:
    with (
        Terminal("run", "demo_nodes_py", "introspection_service", domain=domain) as server,
        Terminal("run", "demo_nodes_py", "introspection_client", domain=domain) as client,
        Terminal("service", "echo", "/add_two_ints", "example_interfaces/srv/AddTwoInts", domain=domain) as echo,
    ):
        client.wait_for("Result of add_two_ints: 5")
        words = ("param", "set", "/introspection_service", "service_configure_introspection", "contents")
        with Terminal(*words, domain=domain) as command:
            command.wait_for("Set parameter successful")
        echo.wait_for("event_type: REQUEST_RECEIVED")
        echo.wait_for("sum: 5")
        for program in (echo, client, server):
            program.interrupt()
