"""What of `ros2 topic` and `ros2 service` no transcript shows."""

import signal
import time

import pytest

from .commands import ros2

LATCHED = """
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("early")
qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(String, "latched", qos)
publisher.publish(String(data="first"))
rclpy.spin(node)
"""
LISTENER = """
import rclpy
from std_msgs.msg import Int8
rclpy.init()
node = rclpy.create_node("ear")
node.create_subscription(Int8, "numbers", lambda message: print(message.data, flush=True), 10)
rclpy.spin(node)
"""


@pytest.mark.slow
def test_what_was_latched_comes_late(env, beside, wait_for):
    beside(LATCHED)
    wait_for("/latched")
    words = ("--once", "--qos-durability", "transient_local", "/latched")
    assert ros2("topic", "echo", *words, env=env).out == "data: first\n---\n"


def test_values_that_no_message_can_hold_are_refused_before_anybody_is_waited_for(env):
    result = ros2("topic", "pub", "--once", "/new", "std_msgs/msg/Int8", "data: 300", env=env)
    assert (result.status, result.out) == (1, "")
    assert "must be an integer in [-128, 127], not 300" in result.err
    assert result.err.count("\n") == 1


@pytest.mark.slow
def test_messages_come_from_standard_input(env, beside, wait_for):
    listener = beside(LISTENER)
    wait_for("/numbers")
    sent = ros2("topic", "pub", "--stdin", "-1", "/numbers", "std_msgs/msg/Int8", env=env, stdin="data: 7\n")
    assert sent.status == 0
    assert listener.stdout.readline() == "7\n"


@pytest.mark.slow
def test_echo_gives_up_after_a_while(env, beside, wait_for):
    beside(LISTENER)
    wait_for("/numbers")
    result = ros2("topic", "echo", "--once", "--timeout", "0.5", "/numbers", env=env)
    assert (result.out, result.err.count("Traceback")) == ("", 0)


@pytest.mark.slow
def test_a_number_of_messages_at_a_rate(env, beside, wait_for):
    listener = beside(LISTENER)
    wait_for("/numbers")
    sent = ros2("topic", "pub", "-t", "3", "-r", "20", "-w", "1", "/numbers", "std_msgs/msg/Int8", "data: 5", env=env)
    assert sent.out.count("publishing #") == 3
    assert [listener.stdout.readline() for _ in range(3)] == ["5\n"] * 3


@pytest.mark.timing
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="nothing can be stopped here")
def test_a_stopped_program_holds_nobody_up_for_long(env, beside, wait_for):
    stopped = beside(LATCHED)
    wait_for("/latched")
    beside(LISTENER)
    wait_for("/numbers")
    stopped.send_signal(signal.SIGSTOP)
    begun = time.monotonic()
    result = ros2("node", "list", "--no-daemon", env=env)
    assert time.monotonic() - begun < 8.0
    assert (result.status, result.out, result.err) == (0, "/ear\n", "")
