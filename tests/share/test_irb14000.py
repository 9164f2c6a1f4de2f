"""The description of YuMi: the same dimensions, ranges and shapes as the data of its kinematics, and its tasks."""

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.description.geometry import Sphere
from daidalos.description.joint import JointType
from daidalos.description.kinematics import KinematicTree
from daidalos.industry.motion.redundant_kinematics import forward_of
from daidalos.industry.robots.yumi import GRIPPER_LENGTH, YUMI, YUMI_ARM
from daidalos.simulation import Simulation
from description.robots import SHARE, share_of
from simulation.models import world


@pytest.fixture(scope="module")
def robot():
    return urdf.load(SHARE / "irb14000_description/urdf/irb14000.urdf.xacro", {}, share_of)


@pytest.mark.parametrize("side", YUMI.bases)
def test_forward_kinematics_agrees(robot, side):
    tree = KinematicTree(robot)
    names = [f"yumi_joint_{number}_{side[0]}" for number in YUMI_ARM.numbers]
    for angles in np.random.default_rng(1).uniform(*YUMI_ARM.limits.T, (20, 7)):
        matrices = tree.link_matrices(tree.positions(dict(zip(names, angles, strict=True))))
        tool = YUMI.side(side) @ forward_of(YUMI_ARM, angles)[0]
        np.testing.assert_allclose(matrices[tree.link_names.index(f"yumi_tool0_{side[0]}")], tool, atol=1e-12)
        grip = tool @ Pose((0.0, 0.0, GRIPPER_LENGTH)).matrix
        np.testing.assert_allclose(matrices[tree.link_names.index(f"gripper_{side[0]}_tcp")], grip, atol=1e-12)


@pytest.mark.parametrize("side", "lr")
def test_ranges_speeds_and_mass_agree(robot, side):
    joints = [robot.joints[f"yumi_joint_{number}_{side}"] for number in YUMI_ARM.numbers]
    np.testing.assert_allclose([(one.axis.lower, one.axis.upper) for one in joints], YUMI_ARM.limits, atol=1e-12)
    np.testing.assert_allclose([one.axis.velocity for one in joints], YUMI_ARM.speeds, atol=1e-12)
    links = [robot.links[f"yumi_link_{number}_{side}"] for number in range(1, 8)]
    assert sum(link.inertial.mass for link in links) == pytest.approx(YUMI_ARM.mass)


@pytest.mark.parametrize("side", "lr")
def test_the_links_have_the_capsules_of_the_distances(robot, side):
    for number in range(1, 8):
        spheres = {
            (tuple(round(v, 9) for v in one.pose.position), one.geometry.radius)
            for one in robot.links[f"yumi_link_{number}_{side}"].collisions
            if isinstance(one.geometry, Sphere)
        }
        capsule = YUMI_ARM.links[number][0]
        assert spheres == {(capsule.start, capsule.radius), (capsule.end, capsule.radius)}


def test_every_joint_of_the_controlled_robot_stands_where_it_begins():
    robot = urdf.load(SHARE / "irb14000_description/urdf/irb14000_controlled.urdf.xacro", {}, share_of)
    said = []
    simulation = Simulation(world(), has_subscribers=lambda topic: False, warn=said.append)
    simulation.spawn(robot)
    simulation.advance(1_000_000_000)
    assert robot.joints["world-yumi_body"].type is JointType.FIXED
    np.testing.assert_allclose(
        simulation.pose("irb14000", "yumi_tool0_l").position, (-0.0098, 0.1826, 0.1986), atol=0.001
    )
    assert said == []
    assert list(simulation.contacts()) == []


@pytest.mark.slow
@pytest.mark.scenario(timeout=120, seed=1, record=False)
@pytest.mark.parametrize(
    ("task", "place"), [("hand_over", (0.36, -0.12, 0.012)), ("carry_together", (0.44, 0.0, 0.012))]
)
def test_both_hands_bring_the_bar_to_its_place(launch, world, task, place):
    bar_after = []
    arms = launch("irb14000_description", "task.launch.py", task=task, gui=False)
    world.wait_for("bar")
    arms.prints("two_arms.*: done", within=60.0)
    bar_after = world.read(lambda simulation: simulation.pose("bar").position)
    np.testing.assert_allclose(bar_after, place, atol=0.006)
