"""The program that runs controllers by its own clock."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from daidalos.nodes.controller_manager.ros2_control_node import Ros2ControlNode
from daidalos.nodes.runner import UserError
from daidalos.samples.fields import time_message
from ros.graph import graph  # noqa: F401

URDF = """<robot name="r"><link name="a"/><link name="b"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
  <ros2_control name="h" type="system"><hardware><plugin>{}</plugin></hardware>
  <joint name="j"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control></robot>"""
MOCK = URDF.format("mock_components/GenericSystem")
TIMEOUT_S = 20.0


class Counting(Ros2ControlNode):
    """Notes its cycles."""

    def __init__(self, **parameters: object) -> None:
        self.instants: list[int] = []
        super().__init__(parameter_overrides=[Parameter(name, value=value) for name, value in parameters.items()])

    def cycle(self, now_ns: int) -> list:  # type: ignore[type-arg]
        self.instants.append(now_ns)
        return super().cycle(now_ns)


@contextmanager
def spun(*nodes: rclpy.node.Node) -> Iterator[None]:
    executor = MultiThreadedExecutor(2)
    for node in nodes:
        executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        yield
    finally:
        executor.shutdown()
        thread.join()
        for node in nodes:
            node.destroy_node()


def wait_for(done: object) -> None:
    """Wait until something is so; fail when that takes too long."""
    assert callable(done)
    pause, end = threading.Event(), time.monotonic() + TIMEOUT_S
    while not done():
        assert time.monotonic() < end, "it did not happen"
        pause.wait(0.005)


def test_it_waits_for_the_description(graph: Context) -> None:  # noqa: F811
    node, user = Counting(), rclpy.create_node("user")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = user.create_publisher(String, "/robot_description", latched)
    with spun(node, user):
        assert node.manager is None
        publisher.publish(String(data=MOCK))
        wait_for(lambda: len(node.instants) > 3)
        assert node.manager is not None
        assert node.manager.components["h"].state == "active"


@pytest.mark.slow
@pytest.mark.parametrize("rate", [100, 300, 1000])
def test_simulated_time_is_followed_exactly(graph: Context, rate: int) -> None:  # noqa: F811
    node = Counting(use_sim_time=True, update_rate=rate, robot_description=MOCK)
    user = rclpy.create_node("user")
    clock = user.create_publisher(Clock, "/clock", 100)
    with spun(node, user):
        for step in range(1, 201):  # in steps of 10 ms, as a simulator tells the time
            before = len(node.instants)
            clock.publish(Clock(clock=time_message(step * 10_000_000)))
            wait_for(lambda step=step: node.get_clock().now().nanoseconds == step * 10_000_000)
            if rate >= 100 and step > 1:
                wait_for(lambda before=before: len(node.instants) > before)
        last = 2_000_000_000
        wait_for(lambda: node.instants[-1] > last - 2e9 / rate)
        instants = np.array(node.instants)
        periods = np.diff(instants)
        assert np.all(np.abs(periods - 1e9 / rate) <= 1.0)
        expected = (last - instants[0]) * rate / 1e9
        assert abs(len(instants) - expected) <= 1.0


def test_a_clock_that_goes_back_is_followed(graph: Context) -> None:  # noqa: F811
    node = Counting(use_sim_time=True, update_rate=100, robot_description=MOCK)
    user = rclpy.create_node("user")
    clock = user.create_publisher(Clock, "/clock", 100)
    with spun(node, user):
        for stamp in (50_000_000_000, 50_010_000_000, 50_020_000_000, 1_000_000, 11_000_000, 21_000_000, 31_000_000):
            before = len(node.instants)
            clock.publish(Clock(clock=time_message(stamp)))
            wait_for(lambda stamp=stamp: node.get_clock().now().nanoseconds == stamp)
            if stamp not in (50_000_000_000, 1_000_000):
                wait_for(lambda before=before: len(node.instants) > before)
        assert min(node.instants) < 1_000_000_000
        assert node.instants[-1] <= 31_000_000


@pytest.mark.slow
def test_the_wall_clock_keeps_the_rate_as_far_as_the_machine_does(graph: Context) -> None:  # noqa: F811
    node = Counting(update_rate=100, robot_description=MOCK)
    with spun(node):
        wait_for(lambda: len(node.instants) >= 60)
        spans = np.diff(node.instants[10:60])
        assert np.median(spans) == pytest.approx(10_000_000, rel=0.1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (URDF.format("gazebo_ros2_control/GazeboSystem"), "GazeboSystem' is the simulator's"),
        ("<robot name='r'><link name='a'/></robot>", "has no <ros2_control> element"),
        ("<robot", "robot_description"),
    ],
)
def test_what_can_not_be_run_is_said(graph: Context, text: str, message: str) -> None:  # noqa: F811
    with pytest.raises(UserError, match=message):
        Counting(robot_description=text)


def test_mock_hardware_takes_the_place_of_a_plugin_in_c_plus_plus(graph: Context) -> None:  # noqa: F811
    warnings: list[str] = []

    class Warned(Counting):
        def warn(self, line: str) -> None:
            warnings.append(line)

    node = Warned(robot_description=URDF.format("my_robot/Missing"))
    assert warnings == [
        "robot_description:3: 'h': there is no Python class for the hardware plugin 'my_robot/Missing'; "
        "'mock_components/GenericSystem' takes its place and no device is driven"
    ]
    assert node.manager is not None
    hardware = node.manager.components["h"].hardware
    assert hardware.info.plugin == "mock_components/GenericSystem"
    hardware.commands["j/position"] = 0.5
    with spun(node):
        wait_for(lambda: hardware.states["j/position"] == 0.5)


def test_a_published_description_that_can_not_be_run_ends_the_program(
    graph: Context,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ended = threading.Event()
    monkeypatch.setattr("daidalos.nodes.controller_manager.ros2_control_node.fail", ended.set)
    node, user = Counting(), rclpy.create_node("user")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = user.create_publisher(String, "/robot_description", latched)
    with spun(node, user):
        publisher.publish(String(data="<robot name='r'><link name='a'/></robot>"))
        assert ended.wait(TIMEOUT_S)


def test_hardware_of_the_users_own_is_found(
    graph: Context,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (tmp_path / "my_own_robot.py").write_text(
        "from daidalos.control.contracts import Hardware\n"
        "class Robot(Hardware):\n"
        "    def read(self, now_ns, period):\n"
        "        self.states['j/position'] = 0.25\n",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(tmp_path)
    node = Counting(robot_description=URDF.format("my_own_robot/Robot"))
    assert node.manager is not None
    hardware = node.manager.components["h"].hardware
    with spun(node):
        wait_for(lambda: hardware.states["j/position"] == 0.25)
