"""Nodes in one process under a clock that the test steps, and a robot that the test plays.

A conftest takes the fixture over: `from nodes.stepped import stage`.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
import yaml
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from daidalos.common.kernels import warm_up
from daidalos.nodes.conversions import transform_stamped
from daidalos.samples.fields import time_message

TIMEOUT_S = 30.0
"""How long [s] of real time anything may take that is expected to happen."""

STEP_S = 0.05
"""Simulated time [s] of a step."""

_CALLBACKS_A_STEP = 50
"""At least so many callbacks that are ready run in a step, however slow the machine is."""

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Robot:
    """A robot on a plane: it obeys ``cmd_vel`` exactly and publishes ``odom`` and its transforms.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Its pose (x [m], y [m], yaw [rad]) in odom, which lies on map.
    commands : list of ndarray
        The velocities (x, y, yaw) that it was sent.
    """

    def __init__(self, node: Node) -> None:
        self.pose = np.zeros(3)
        self.commands: list[np.ndarray] = []
        self.is_localized = True
        self._velocity = np.zeros(3)
        self._node = node
        self._transforms = node.create_publisher(TFMessage, "/tf", 100)
        self._odometry = node.create_publisher(Odometry, "odom", 10)
        node.create_subscription(Twist, "cmd_vel", self._on_command, 10)

    def _on_command(self, twist: Twist) -> None:
        self._velocity = np.array([twist.linear.x, twist.linear.y, twist.angular.z])
        self.commands.append(self._velocity)

    @property
    def is_standing(self) -> bool:
        """Whether the last command was to stand."""
        return not self._velocity.any()

    def step(self, seconds: float, stamp: Any) -> None:
        """Move for a while, then publish where it is."""
        x, y, turn = self._velocity * seconds
        middle = self.pose[2] + 0.5 * turn
        cosine, sine = math.cos(middle), math.sin(middle)
        self.pose = self.pose + np.array([cosine * x - sine * y, sine * x + cosine * y, turn])
        transforms = [transform_stamped(self.pose, "odom", "base_link", stamp)]
        if self.is_localized:
            transforms.append(transform_stamped(np.zeros(3), "map", "odom", stamp))
        self._transforms.publish(TFMessage(transforms=transforms))
        odometry = Odometry()
        odometry.header.stamp = stamp
        odometry.twist.twist.linear.x, odometry.twist.twist.linear.y = self._velocity[:2].tolist()
        odometry.twist.twist.angular.z = float(self._velocity[2])
        self._odometry.publish(odometry)


class Stage:
    """Nodes that the test steps together.

    Attributes
    ----------
    node : Node
        By which the test takes part in the graph.
    robot : Robot or None
        What moves; nothing does before `add_robot`.
    """

    def __init__(self) -> None:
        self.node = rclpy.create_node("test")
        self.robot: Robot | None = None
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._nodes = [self.node]
        self._clock = self.node.create_publisher(Clock, "/clock", 10)
        self._now_ns = 100_000_000_000
        self.step()

    def add(self, node: Any) -> Any:
        """Spin a node with the others from now on, and destroy it at the end."""
        self._executor.add_node(node)
        self._nodes.append(node)
        return node

    def suspend(self, node: Any) -> None:
        """Spin a node no more; its services are there, but do not answer."""
        self._executor.remove_node(node)

    def remove(self, node: Any) -> None:
        """Destroy a node."""
        self.suspend(node)
        self._nodes.remove(node)
        node.destroy_node()

    def add_robot(self) -> Robot:
        """Return a robot that the test plays."""
        self.robot = Robot(self.node)
        self.step()
        return self.robot

    def destroy(self) -> None:
        """Destroy the nodes."""
        for node in self._nodes:
            node.destroy_node()

    @property
    def stamp(self) -> Any:
        """The simulated time."""
        return time_message(self._now_ns)

    @property
    def now(self) -> float:
        """The simulated time [s]."""
        return 1e-9 * self._now_ns

    def step(self, seconds: float = STEP_S) -> None:
        """Advance the clock, and run what is due."""
        self._now_ns += round(1e9 * seconds)
        self._clock.publish(Clock(clock=self.stamp))
        if self.robot is not None:
            self.robot.step(seconds, self.stamp)
        for _ in range(_CALLBACKS_A_STEP):
            self._executor.spin_once(timeout_sec=0.0)
        self._executor.spin_until_future_complete(Future(), 0.005)  # what comes from other threads

    def step_for(self, seconds: float) -> None:
        """Step until so much simulated time has passed."""
        for _ in range(round(seconds / STEP_S)):
            self.step()

    def step_until(self, condition: Callable[[], bool]) -> None:
        """Step until a condition holds; fail when it does not within `TIMEOUT_S` of real time."""
        deadline = time.monotonic() + TIMEOUT_S
        while not condition():
            assert time.monotonic() < deadline, f"it did not happen within {TIMEOUT_S} s"
            self.step()

    def result(self, future: Future) -> Any:
        """Return a future's result, stepping until it is done."""
        self.step_until(future.done)
        return future.result()

    def send(self, action: Any, name: str, feedback: Callable[[Any], None] | None = None, /, **goal: Any) -> Any:
        """Return the handle of a goal that is sent to an action server."""
        client = ActionClient(self.node, action, name)
        self.step_until(client.server_is_ready)
        return self.result(client.send_goal_async(action.Goal(**goal), feedback))

    def end(self, handle: Any) -> tuple[int, Any]:
        """Return the status and the result of a goal, stepping until it has ended."""
        answer = self.result(handle.get_result_async())
        return answer.status, answer.result

    def call(self, kind: Any, name: str, /, **request: Any) -> Any:
        """Return the response of a service."""
        client = self.node.create_client(kind, name)
        self.step_until(client.service_is_ready)
        return self.result(client.call_async(kind.Request(**request)))

    def collect(self, kind: Any, topic: str, qos: Any = 10) -> list[Any]:
        """Return a list to which each message of a topic is added."""
        messages: list[Any] = []
        self.node.create_subscription(kind, topic, messages.append, qos)
        return messages

    def publish(self, topic: str, message: Any, qos: Any = 10) -> None:
        """Publish one message."""
        self.node.create_publisher(type(message), topic, qos).publish(message)


@pytest.fixture(scope="session")
def compiled() -> None:
    """Compile the kernels of navigation, so that no test waits for them; the first time on a machine takes minutes."""
    warm_up("daidalos.navigation")


@pytest.fixture
def stage(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Callable[[dict[str, Any]], Stage]]:
    """Return a function that sets the stage, given the parameters of its nodes by their full names."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    stages: list[Stage] = []

    def set_stage(parameters: dict[str, Any]) -> Stage:
        parameters = {"/**": {"use_sim_time": True}} | parameters
        file = tmp_path / "parameters.yaml"
        file.write_text(yaml.safe_dump({name: {"ros__parameters": values} for name, values in parameters.items()}))
        rclpy.init(args=["--ros-args", "--params-file", str(file)])
        stages.append(Stage())
        return stages[-1]

    context = rclpy.get_default_context()
    try:
        yield set_stage
    finally:
        for stage in stages:
            stage.destroy()
        rclpy.try_shutdown()
        context.destroy()
