"""The simulated laser projector: IDN frames in, lines on the shapes of the world out."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Pose
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.errors import UserError
from daidalos.industry.assistance.device import Content
from daidalos.industry.assistance.laser_projector import LaserProjector, LaserProjectorParameters
from daidalos.nodes.daidalos_lighting.simulated_laser import SimulatedLaser

from .test_simulated_head import free_port

PATIENCE_S = 30.0


@pytest.fixture
def port() -> int:
    return free_port()


@pytest.fixture
def simulated(node: Node, port: int) -> Iterator[SimulatedLaser]:
    one = SimulatedLaser(parameter_overrides=[Parameter("port", value=port)])
    yield one
    one.destroy_node()


@pytest.fixture
def picture(node: Node, simulated: SimulatedLaser) -> Callable[[Callable[[Marker], bool]], Marker]:
    """A function that spins until a marker fulfils a condition, and returns it."""
    found = list[Any]()
    node.create_subscription(MarkerArray, "laser/markers", found.append, 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(simulated)

    def wait(holds: Callable[[Marker], bool]) -> Marker:
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            before = len(found)
            executor.spin_once(timeout_sec=0.02)
            if len(found) > before and holds(found[-1].markers[0]):
                return found[-1].markers[0]
        raise AssertionError("no such picture")

    return wait


def corners(marker: Marker) -> np.ndarray:
    """Return the ends of the lines ``(n, 3)``."""
    return np.array([(one.x, one.y, one.z) for one in marker.points])


@pytest.mark.slow
def test_the_picture_lies_on_what_the_beam_meets(
    node: Node, port: int, picture: Callable[[Callable[[Marker], bool]], Marker]
) -> None:
    table = Pose()
    table.position.z = 0.375
    flange = Pose()
    flange.position.x, flange.position.y, flange.position.z = 0.2, 0.1, 0.79
    states = node.create_publisher(ModelStates, "gazebo/model_states", 1)
    laser = LaserProjector(LaserProjectorParameters(port=port, radius=0.05), Path())
    laser.point((0.2, 0.1, 0.83), Content("red"))

    def publish_and(holds: Callable[[Marker], bool]) -> Callable[[Marker], bool]:
        def check(marker: Marker) -> bool:
            states.publish(ModelStates(name=["table", "flange", "robot"], pose=[table, flange, Pose()], twist=[]))
            return holds(marker)

        return check

    on_part = picture(publish_and(lambda one: len(one.points) > 10 and abs(one.points[0].z - 0.833) < 1e-3))
    found = corners(on_part)
    assert np.hypot(found[:, 0] - 0.2, found[:, 1] - 0.1) == pytest.approx(np.full(len(found), 0.05), abs=1e-3)
    assert (on_part.colors[0].r, on_part.colors[0].g) == (1.0, 0.0)
    assert on_part.color.a == on_part.colors[0].a == 1.0
    flange.position.x = 0.2 + 0.12  # its edge passes through the ring: a part of it lies on the table
    split = corners(picture(publish_and(lambda one: {0.83, 0.75} <= {round(at.z, 2) for at in one.points})))
    assert np.linalg.norm(split[1::2] - split[::2], axis=1).max() < 0.04  # no line crosses the edge, 0.08 m high
    laser.close()
    picture(lambda one: one.action == Marker.DELETE)


@pytest.mark.slow
def test_it_goes_dark_when_nothing_comes(port: int, picture: Callable[[Callable[[Marker], bool]], Marker]) -> None:
    packets = list[bytes]()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        laser = LaserProjector(LaserProjectorParameters(port=receiver.getsockname()[1]), Path())
        laser.point((0.0, 0.0, 0.0), Content())
        while len(packets) < 1 or len(packets[-1]) < 100:
            packets.append(receiver.recv(0x10000))
        laser.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(packets[-1], ("127.0.0.1", port))
        lit = picture(lambda one: one.action == Marker.ADD)
        sender.sendto(b"nonsense", ("127.0.0.1", port))
        sender.sendto(packets[-1][:-3], ("127.0.0.1", port))
    assert corners(lit)[:, 2] == pytest.approx(np.full(len(lit.points), 0.003), abs=1e-3)  # without a world: the floor
    picture(lambda one: one.action == Marker.DELETE)


def test_a_used_port_is_named(simulated: SimulatedLaser, port: int) -> None:
    with pytest.raises(UserError, match=f"cannot receive IDN at 127.0.0.1:{port}"):
        SimulatedLaser(parameter_overrides=[Parameter("port", value=port)])
