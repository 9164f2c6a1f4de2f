"""Which collisions are wheels, and that wheels whose shape is a mesh roll as true as cylinders."""

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.description.geometry import Box, Cylinder, Mesh
from daidalos.description.joint import Axis, Joint, JointType
from daidalos.description.link import Collision
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import OdometrySample
from daidalos.simulation import Simulation
from daidalos.simulation.conversion.wheels import wheel_disc
from simulation.models import turtlebot, world

SECOND = 1_000_000_000
AXLE_ALONG_Y = Joint("j", JointType.CONTINUOUS, "base", "wheel", axes=(Axis((0.0, 1.0, 0.0)),))
LYING = quaternion_from_rpy(math.pi / 2, 0.0, 0.0)


def wheel_mesh(folder, sections=24, radius=0.033, width=0.018, hub=0.0):
    """Write a wheel along z, with a hub on one side."""
    wheel = trimesh.creation.cylinder(radius, width, sections=sections)
    if hub:
        axle = trimesh.creation.cylinder(radius / 3, hub, sections=sections)
        wheel = trimesh.util.concatenate([wheel, axle.apply_translation((0, 0, (width + hub) / 2))])
    file = folder / f"wheel{sections}-{hub}.stl"
    wheel.export(file)
    return Mesh(file.name, file)


@pytest.mark.parametrize(("sections", "round_enough"), [(4, False), (6, False), (12, True), (24, True)])
def test_what_is_round_is_a_wheel(tmp_path, sections, round_enough):
    disc = wheel_disc(AXLE_ALONG_Y, Collision(wheel_mesh(tmp_path, sections), Pose(orientation=LYING)))
    assert (disc is not None) == round_enough
    if disc is not None:
        assert (disc.radius, disc.width) == pytest.approx((0.033, 0.018), rel=1e-4)
        assert disc.pose.position == pytest.approx((0, 0, 0), abs=1e-6)
        assert abs((disc.pose.matrix[:3, :3] @ (0, 0, 1))[1]) == pytest.approx(1)


def test_a_hub_widens_a_wheel_to_its_side(tmp_path):
    disc = wheel_disc(AXLE_ALONG_Y, Collision(wheel_mesh(tmp_path, hub=0.01), Pose(orientation=LYING)))
    assert (disc.radius, disc.width) == pytest.approx((0.033, 0.028), rel=1e-4)
    # The hub's end, z = 0.019 in the mesh, is turned to y = -0.019.
    assert disc.pose.position == pytest.approx((0, -0.005, 0), abs=1e-6)


@pytest.mark.parametrize(
    ("joint", "pose"),
    [
        (None, Pose(orientation=LYING)),
        (replace(AXLE_ALONG_Y, type=JointType.FIXED), Pose(orientation=LYING)),
        (replace(AXLE_ALONG_Y, axes=(Axis((0.0, 1.0, 0.0), lower=-1.0, upper=1.0),)), Pose(orientation=LYING)),
        (AXLE_ALONG_Y, Pose()),
        (AXLE_ALONG_Y, Pose((0.01, 0.0, 0.0), LYING)),
    ],
    ids=["no joint", "fixed", "limited", "across the axle", "off centre"],
)
def test_what_does_not_turn_about_its_own_axis_is_none(tmp_path, joint, pose):
    for shape in (wheel_mesh(tmp_path), Cylinder(0.033, 0.018)):
        assert wheel_disc(joint, Collision(shape, pose)) is None
    assert wheel_disc(AXLE_ALONG_Y, Collision(Box((0.1, 0.1, 0.1)))) is None


@pytest.mark.slow
def test_ten_turns_on_meshes_are_ten_turns_by_the_wheels(tmp_path):
    robot = turtlebot()
    mesh = wheel_mesh(tmp_path, 48)
    links = {
        name: replace(link, collisions=tuple(replace(c, geometry=mesh) for c in link.collisions))
        if name.startswith("wheel_")
        else link
        for name, link in robot.links.items()
    }
    simulation = Simulation(world())
    simulation.spawn(replace(robot, links=links), "robot")
    simulation.advance(SECOND // 2)
    simulation.command("/cmd_vel", TwistCommand(np.zeros(3), np.array([0.0, 0.0, 1.5])))
    true, measured = [simulation.pose("robot").yaw], [0.0]
    for _ in range(168):
        samples = simulation.advance(SECOND // 4)
        _, _, z, w = [s for s in samples if isinstance(s, OdometrySample)][-1].orientation
        true.append(simulation.pose("robot").yaw)
        measured.append(2 * math.atan2(z, w))
    turned, counted = np.ptp(np.unwrap(true)), np.ptp(np.unwrap(measured))
    assert counted > 20 * math.pi * 0.98
    assert turned == pytest.approx(counted, rel=1e-3)
