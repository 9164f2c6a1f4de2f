"""How the simulator's process begins and ends."""

from threading import Event

import numpy as np
import pytest
import rclpy
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock

from daidalos.nodes.gazebo_ros.gzserver import GzServer, Start
from daidalos.nodes.runner import UserError
from end_to_end.processes import ROS2, Command
from ros.graph import graph, node, spinning  # noqa: F401


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
