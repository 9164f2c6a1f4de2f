"""The descriptions of industrial arms: the same dimensions and ranges as the data of the kinematics."""

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.description.joint import JointType
from daidalos.description.kinematics import KinematicTree
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots import ARMS
from daidalos.simulation import Simulation
from description.robots import SHARE, share_of
from simulation.models import world

SECOND = 1_000_000_000
AXES = [f"joint_{number}" for number in range(1, 7)]


def load(name):
    return urdf.load(SHARE / f"{name}_description/urdf/{name}.urdf.xacro", {}, share_of)


@pytest.mark.parametrize("name", ARMS)
def test_forward_kinematics_agrees(name):
    robot, arm = load(name), ARMS[name]
    tree = KinematicTree(robot)
    for angles in np.random.default_rng(1).uniform(*arm.limits.T, (50, 6)):
        matrices = tree.link_matrices(tree.positions(dict(zip(AXES, angles, strict=True))))
        np.testing.assert_allclose(matrices[tree.link_names.index("tool0")], forward(arm, angles), atol=1e-12)


@pytest.mark.parametrize("name", ARMS)
def test_ranges_speeds_and_mass_agree(name):
    robot, arm = load(name), ARMS[name]
    moving = [joint for joint in robot.joints.values() if joint.type is not JointType.FIXED]
    assert [joint.name for joint in moving] == AXES
    np.testing.assert_allclose([(j.axes[0].lower, j.axes[0].upper) for j in moving], arm.limits, atol=1e-12)
    np.testing.assert_allclose([j.axes[0].velocity for j in moving], arm.speeds, atol=1e-12)
    assert sum(link.inertial.mass for link in robot.links.values() if link.inertial) == pytest.approx(arm.mass)


@pytest.mark.parametrize("name", ARMS)
def test_it_loads_into_the_simulator_without_a_word(name):
    said = []
    simulation = Simulation(world(), has_subscribers=lambda topic: False, warn=said.append)
    spawned = simulation.spawn(load(name), pose=Pose((0.0, 0.0, 2.0)))
    simulation.advance(SECOND // 10)
    assert np.isfinite(simulation.pose(spawned).position).all()
    assert said == []


@pytest.mark.parametrize("name", ["irb120", "irb1600", "irb6700", "irb8700"])
def test_the_controlled_arm_stands_on_the_floor(name):
    robot = urdf.load(SHARE / f"{name}_description/urdf/{name}_controlled.urdf.xacro", {}, share_of)
    said = []
    simulation = Simulation(world(), has_subscribers=lambda topic: False, warn=said.append)
    simulation.spawn(robot)
    simulation.advance(SECOND // 10)
    assert robot.joints["world-base_link"].type is JointType.FIXED
    assert said == []
