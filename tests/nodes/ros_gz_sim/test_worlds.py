"""The worlds that gz's tutorials begin with."""

import numpy as np
import pytest

from daidalos.description import sdf
from daidalos.nodes.gazebo_ros._worlds import find_world
from daidalos.samples.commands import TwistCommand
from daidalos.simulation import Simulation

SECOND = 1_000_000_000


def opened(name):
    path = find_world(name)
    assert path is not None
    simulation = Simulation(sdf.load(path))
    assert not simulation.warnings
    return simulation


def test_shapes_rest_on_the_ground():
    simulation = opened("shapes.sdf")
    simulation.advance(2 * SECOND)
    lowest = {name: simulation.bounds(name)[0][2] for name in simulation.models if name != "ground_plane"}
    assert sorted(lowest) == ["box", "capsule", "cone", "cylinder", "ellipsoid", "sphere"]
    assert list(lowest.values()) == pytest.approx([0.0] * 6, abs=0.005)


def test_the_vehicle_sees_the_wall_that_it_drives_to():
    simulation = opened("visualize_lidar.sdf")
    simulation.command("/model/vehicle_blue/cmd_vel", TwistCommand(np.array((0.5, 0.0, 0.0))))
    samples = simulation.advance(3 * SECOND)
    scan = [sample for sample in samples if sample.topic == "/lidar2"][-1]
    x, y, _ = simulation.pose("vehicle_blue").position
    assert (x, y) == pytest.approx((-3 + 1.5, 0.0), abs=0.1)
    assert np.asarray(scan.ranges)[320] == pytest.approx(4.9 - (x + 0.3), abs=0.05)
