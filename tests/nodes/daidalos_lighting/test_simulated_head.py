"""The simulated head and the tour of the demonstration: Art-Net in, joints and markers out."""

from __future__ import annotations

import math
import socket
from collections.abc import Iterator
from typing import Any

import pytest
from geometry_msgs.msg import PointStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import LaserScan
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

from daidalos.common.errors import UserError
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.look import Look
from daidalos.industry.lighting.show import Show
from daidalos.nodes.daidalos_lighting.simulated_head import SimulatedHead
from daidalos.nodes.daidalos_lighting.tour import Tour


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


@pytest.fixture
def port() -> int:
    return free_port()


@pytest.fixture
def simulated(node: Node, port: int) -> Iterator[SimulatedHead]:
    one = SimulatedHead(parameter_overrides=[Parameter("port", value=port)])
    yield one
    one.destroy_node()


def test_levels_become_joints_beam_and_spot(node: Node, simulated: SimulatedHead, port: int) -> None:
    axes, markers = list[Any](), list[Any]()
    node.create_subscription(JointTrajectory, "head/joint_trajectory", axes.append, 10)
    node.create_subscription(MarkerArray, "beam/markers", markers.append, 10)
    ranges = node.create_publisher(LaserScan, "beam/range", 1)
    head = read_configuration(DEFAULT).make_heads()[0]
    show = Show([head])
    head.show(Look(0.5, "Red"))
    wanted = head.point((1.0, 0.5, 0.8))
    while head.is_moving:
        head.step(0.02)
    data = show.frames(0.0)[0][1]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(simulated)

    def spot() -> Any:
        found = [one for message in markers[-1:] for one in message.markers if one.ns == "spot"]
        return found[0] if found else None

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        before = (0.0, 0.0)
        for turn in range(3000):
            if turn % 20 == 0:
                ranges.publish(LaserScan(ranges=[1.5], range_max=30.0))
            sender.sendto(b"Art-Net\0rubbish", ("127.0.0.1", port))
            sender.sendto(artnet.dmx_packet(2, 1, bytes(512)), ("127.0.0.1", port))  # another universe
            sender.sendto(artnet.dmx_packet(1, 1, data), ("127.0.0.1", port))
            executor.spin_once(timeout_sec=0.01)
            while axes:
                pan, tilt = axes.pop(0).points[0].positions
                assert abs(pan - before[0]) <= head.limits.pan_speed / 44 + 1e-6  # no faster than the fixture
                before = (pan, tilt)
            if math.dist(before, (wanted.pan, wanted.tilt)) < 1e-3 and spot() and spot().pose.position.z > 1.6:
                break
        else:
            raise AssertionError(f"the head is at {before}")
    assert (spot().color.r, spot().color.g) == (1.0, 0.0)
    assert spot().color.a == pytest.approx(0.45, abs=0.01)
    assert spot().pose.position.z == pytest.approx(1.655)
    assert spot().scale.x == pytest.approx(2 * 1.66 * math.tan(math.radians(1.0)), rel=1e-3)
    cone = next(one for one in markers[-1].markers if one.ns == "beam")
    assert max(one.z for one in cone.points) == pytest.approx(1.66)


def test_a_port_in_use_is_named(simulated: SimulatedHead, port: int) -> None:
    with pytest.raises(UserError, match=f"cannot receive Art-Net at 127.0.0.1:{port}"):
        SimulatedHead(parameter_overrides=[Parameter("port", value=port)])


def test_the_tour_ends_when_somebody_else_points(node: Node) -> None:
    tour = Tour(parameter_overrides=[Parameter("period", value=0.01)])
    received: list[PointStamped] = []
    node.create_subscription(PointStamped, "clicked_point", received.append, 100)
    publisher = node.create_publisher(PointStamped, "clicked_point", 1)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(tour)
    while len({one.point.x for one in received}) < 2:
        executor.spin_once(timeout_sec=0.1)
    publisher.publish(PointStamped())
    while not tour._timer.is_canceled():
        executor.spin_once(timeout_sec=0.1)
    tour.destroy_node()
