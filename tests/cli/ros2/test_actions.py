"""`ros2 action`: servers, goals, feedback, and a goal that is given up."""

import signal
import subprocess

import pytest

from .commands import ROS2, ros2

SERVER = """
import rclpy, time
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
rclpy.init()
node = rclpy.create_node("server", namespace="/lab")


def execute(goal):
    sequence = [0, 1]
    while len(sequence) <= goal.request.order:
        if goal.is_cancel_requested:
            goal.canceled()
            print("canceled", flush=True)
            return Fibonacci.Result(sequence=sequence)
        sequence.append(sequence[-1] + sequence[-2])
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        time.sleep(0.02)
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)


server = ActionServer(
    node,
    Fibonacci,
    "fibonacci",
    execute,
    callback_group=ReentrantCallbackGroup(),
    cancel_callback=lambda goal: CancelResponse.ACCEPT,
)
rclpy.spin(node, MultiThreadedExecutor(3))
"""
TYPE = "example_interfaces/action/Fibonacci"


@pytest.fixture
def server(beside, wait_for):
    process = beside(SERVER)
    wait_for("/lab/fibonacci/_action/feedback")
    wait_for("/lab/fibonacci/_action/send_goal")
    return process


@pytest.mark.slow
def test_an_action_is_named_with_its_server_and_found_by_its_type(env, server):
    told = "Action: /lab/fibonacci\nAction clients: 0\nAction servers: 1\n    /lab/server"
    assert ros2("action", "info", "/lab/fibonacci", env=env).out == f"{told}\n"
    assert ros2("action", "info", "-t", "/lab/fibonacci", env=env).out == f"{told} [{TYPE}]\n"
    assert ros2("action", "find", TYPE, env=env).out == "/lab/fibonacci\n"
    assert ros2("action", "find", "-c", TYPE, env=env).out == "1\n"
    assert ros2("action", "type", "/lab/fibonacci", env=env).out == f"{TYPE}\n"


@pytest.mark.slow
def test_a_goal_succeeds(env, server):
    told = ros2("action", "send_goal", "-f", "/lab/fibonacci", TYPE, "order: 3", env=env).out
    assert "Goal accepted with ID: " in told
    assert told.count("Feedback:\n") == 2
    assert told.endswith("Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\nGoal finished with status: SUCCEEDED\n")


@pytest.mark.slow
def test_ctrl_c_cancels_the_goal(env, server):
    command = [*ROS2, "action", "send_goal", "-f", "/lab/fibonacci", TYPE, "order: 1000"]
    process = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not process.stdout.readline().startswith("Feedback"):
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=30)
    assert "Traceback" not in told
    assert process.returncode == 2
    assert server.stdout.readline() == "canceled\n"


@pytest.mark.slow
def test_an_action_that_is_not_there_is_waited_for_with_a_hint(env, server):
    command = [*ROS2, "action", "send_goal", "/lab/fibonaci", TYPE]
    process = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr.readline() == "Did you mean '/lab/fibonacci'?\n"
        assert process.stdout.readline() == "Waiting for an action server to become available...\n"
        assert process.poll() is None
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
