"""How the simulator's process begins and ends."""

from threading import Event

import numpy as np
import pytest
import rclpy
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

from daidalos.common.pose3 import Pose
from daidalos.description.sdf import parse_model
from daidalos.nodes.gazebo_ros.gzserver import GzServer, Start
from daidalos.nodes.runner import UserError
from end_to_end.processes import ROS2, Command
from ros.graph import graph, node, spinning  # noqa: F401

INERTIAL = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
WHEELED = f"""<sdf version="1.9"><model name="r"><link name="base">{INERTIAL}</link>
  {
    "".join(
        f'<link name="{side}">{INERTIAL}</link><joint name="{side}_joint" type="revolute"><parent>base</parent>'
        f"<child>{side}</child><axis><xyz>0 1 0</xyz></axis></joint>"
        for side in ("left", "right")
    )
}
  <plugin name="p" filename="libgazebo_ros_diff_drive.so"><left_joint>left_joint</left_joint>
  <right_joint>right_joint</right_joint></plugin></model></sdf>"""
EYE = """<sdf version="1.9"><model name="eye"><static>true</static><link name="l"><sensor name="s" type="camera">
  <topic>/image</topic><update_rate>30</update_rate><camera><image><width>32</width><height>24</height></image></camera>
  </sensor></link></model></sdf>"""


def test_it_ends_after_so_many_steps(graph):  # noqa: F811
    ended = Event()
    server = GzServer(Start(update_rate=0.0, steps=30_000), ended.set)
    try:
        assert ended.wait(20.0)
        assert server._paced.simulation.time_ns == 30_000_000_000
        assert server._paced.paused
    finally:
        server.destroy_node()


@pytest.mark.parametrize(("rate", "period_ns"), [(250.0, 4_000_000), (20.0, 50_000_000)])
def test_the_clock_is_told_as_often_as_wanted(node, rate, period_ns):  # noqa: F811
    told, enough = [], Event()

    def hear(clock):
        told.append(clock.clock.sec * 1_000_000_000 + clock.clock.nanosec)
        if len(told) == 5:
            enough.set()

    node.create_subscription(Clock, "/clock", hear, 10)
    server = GzServer(Start(), parameter_overrides=[Parameter("publish_rate", value=rate)])
    try:
        with spinning(node):
            assert enough.wait(10.0)
    finally:
        server.destroy_node()
    assert np.diff(told[1:5]).tolist() == [period_ns] * 3  # the first comes at once


def test_a_rate_that_can_not_be_is_refused(graph):  # noqa: F811
    with pytest.raises(UserError, match="publish_rate"):
        GzServer(parameter_overrides=[Parameter("publish_rate", value=0.0)])


def test_two_simulators_in_one_graph_are_pointed_out(graph, capfd):  # noqa: F811
    server, other = GzServer(Start(paused=True)), rclpy.create_node("other")
    try:
        server._publish_performance()
        assert "[WARN]" not in capfd.readouterr().err
        clock = other.create_publisher(Clock, "/clock", 1)
        assert server.handle.graph.wait_for(lambda: server.count_publishers("/clock") == 2, 10.0)
        for _ in range(2):
            server._publish_performance()
        assert capfd.readouterr().err.count("another simulator") == 1
        other.destroy_publisher(clock)
    finally:
        server.destroy_node()
        other.destroy_node()


@pytest.mark.slow
def test_gazebos_launch_arguments_reach_it(domain, tmp_path):
    parameters = tmp_path / "gazebo.yaml"
    parameters.write_text("gazebo:\n  ros__parameters:\n    real_time_factor: 0.0\n")
    launch = ("launch", "gazebo_ros", "gazebo.launch.py", "gui:=false", "server_required:=true")
    # 500 seconds of an empty world pass in time only when the parameter arrives.
    more = ("iters:=500000", f"extra_gazebo_args:=--ros-args --params-file {parameters}")
    with Command(*ROS2, *launch, *more, domain=domain) as command:
        command.wait_for_line("simulating an empty world")
        command.wait_for_line("was required: shutting down")
    assert "finished cleanly" in command.text


def test_only_what_is_listened_to_becomes_messages(node):  # noqa: F811
    converted = []
    server = GzServer(Start(paused=True))
    try:
        server._host.insert(parse_model(WHEELED), "r", Pose())
        connections, paced = server._connections, server._paced
        for topic, (publisher, convert) in connections._outgoing.items():
            counted = lambda sample, topic=topic, convert=convert: converted.append(topic) or convert(sample)  # noqa: E731
            connections._outgoing[topic] = (publisher, counted)
        paced.step(100)
        assert converted == []
        node.create_subscription(Odometry, "/odom", lambda message: None, 10)
        assert server.handle.graph.wait_for(lambda: connections.has_subscribers("/odom"), 10.0)
        paced.step(100)
        assert set(converted) == {"/odom"}
    finally:
        server.destroy_node()


def test_the_renderer_is_loaded_when_somebody_looks(node):  # noqa: F811
    seen = Event()
    server = GzServer(Start(paused=True))
    try:
        server._host.insert(parse_model(EYE), "eye", Pose())
        server._paced.step(50)
        assert server._connections._renderer_ready is None
        node.create_subscription(Image, "/image", lambda message: seen.set(), 10)
        server._paced.set_paused(False)
        with spinning(node):
            assert seen.wait(120.0)  # the first time on a machine it is compiled
    finally:
        server.destroy_node()
