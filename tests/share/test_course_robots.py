"""The robots of the course: they load, weigh and move as they should."""

import math

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.joint import JointType
from daidalos.description.kinematics import KinematicTree
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import (
    ImageSample,
    LaserScanSample,
    OdometrySample,
    PointCloudSample,
)
from daidalos.simulation import Simulation
from description.robots import SHARE, share_of
from simulation.models import world

SECOND = 1_000_000_000
HUMANOID = "humanoid_description/urdf/humanoid.urdf.xacro"
TRUCK = "truck_description/urdf/truck.urdf.xacro"
ROBOTS = [
    "urdf_tutorial/urdf/simple_link.urdf",
    "urdf_tutorial/urdf/simple_joint.urdf",
    "urdf_tutorial/urdf/robot_example.urdf",
    "urdf_tutorial/urdf/robot_example_xacro_internal.urdf.xacro",
    "urdf_tutorial/urdf/robot_example_xacro_external.urdf.xacro",
    "urdf_tutorial/urdf/01-myfirst.urdf",
    "urdf_tutorial/urdf/02-multipleshapes.urdf",
    "urdf_tutorial/urdf/03-origins.urdf",
    "urdf_tutorial/urdf/04-materials.urdf",
    "urdf_tutorial/urdf/05-visual.urdf",
    "urdf_tutorial/urdf/06-flexible.urdf",
    "urdf_tutorial/urdf/07-physics.urdf",
    "urdf_tutorial/urdf/08-macroed.urdf.xacro",
    "urdf_tutorial_r2d2/urdf/r2d2.urdf.xml",
    HUMANOID,
    TRUCK,
    "tb3_description/urdf/turtlebot3_waffle_base.urdf.xacro",
    "nav2_minimal_tb4_description/urdf/standard/turtlebot4.urdf.xacro",
    "daidalos_barn/urdf/jackal.urdf.xacro",
    "turtlebot3_description/urdf/turtlebot3_burger.urdf.xacro",
]


def load(path, **mappings):
    return urdf.load(SHARE / path, mappings, share_of)


@pytest.mark.parametrize("path", ROBOTS)
def test_it_loads_into_the_simulator_without_a_word(path):
    said = []
    simulation = Simulation(world(), has_subscribers=lambda topic: False, warn=said.append)
    name = simulation.spawn(load(path), pose=Pose((0.0, 0.0, 2.0)))
    simulation.advance(SECOND // 10)
    assert np.isfinite(simulation.pose(name).position).all()
    # The first links of a course have no inertia yet.
    assert [line for line in said if "has no mass" not in line and "inertia" not in line] == []


@pytest.mark.parametrize("path", [HUMANOID, TRUCK])
def test_every_joint_that_moves_is_told_of(path):
    """Whoever is not among the joint states has no transform, and RViz complains of its link."""
    robot = load(path)
    told = {joint.name() for control in robot.ros2_control for joint in control.all("joint")}
    assert told == {joint.name for joint in robot.joints.values() if joint.type is not JointType.FIXED}


def test_the_three_ways_to_write_the_robot_are_one_robot():
    robots = [load(path) for path in ROBOTS[2:5]]
    assert len(robots[0].links) == 16
    assert len(robots[0].joints) == 15
    kinds = {joint.type.value for joint in robots[0].joints.values()}
    assert kinds == {"fixed", "continuous", "revolute", "prismatic"}
    trees = [KinematicTree(robot) for robot in robots]
    for tree in trees[1:]:
        assert tree.link_names == trees[0].link_names
        positions = np.linspace(-0.3, 0.3, len(tree.joint_names))
        assert np.allclose(tree.link_matrices(positions), trees[0].link_matrices(positions))


def test_the_right_finger_is_the_left_one_in_a_mirror():
    robot = load(ROBOTS[2])
    assert robot.links["left_gripper"].visuals[0].geometry.scale == (1, 1, 1)
    assert robot.links["right_gripper"].visuals[0].geometry.scale == (1, -1, 1)


def seen_by_the_humanoid():
    simulation = Simulation(sdf.load(SHARE / "humanoid_description/worlds/ball.world"))
    simulation.spawn(load(HUMANOID))
    samples = simulation.advance(SECOND // 5)
    return simulation, {sample.topic: sample for sample in samples}


@pytest.mark.slow
def test_the_humanoid_sees_the_ball_where_it_lies():
    """The cloud, turned by the optical frame's transform, has the ball's points 10 cm around its centre."""
    simulation, samples = seen_by_the_humanoid()
    cloud, depth = samples["/depth_camera/points"], samples["/depth_camera/depth/image_raw"]
    assert isinstance(cloud, PointCloudSample)
    assert isinstance(depth, ImageSample)
    assert cloud.frame_id == "depth_camera_optical"
    optical = simulation.pose("humanoid", "depth_camera_optical").matrix
    points = cloud.points.reshape(-1, 3) @ optical[:3, :3].T + optical[:3, 3]
    colors = cloud.colors.reshape(-1, 3).astype(int)
    red = (colors[:, 0] > 2 * colors[:, 1] + 20) & np.isfinite(points[:, 0])
    assert red.sum() > 200
    away = np.linalg.norm(points[red] - np.array(simulation.pose("ball").position), axis=1)
    assert away == pytest.approx(0.1, abs=0.005)
    floor = ~red & (np.abs(points[:, 2]) < 0.01)
    assert floor.sum() > 10_000


def test_the_humanoids_eyes_and_lidar_are_as_the_course_has_them():
    _, samples = seen_by_the_humanoid()
    picture, scan = samples["/camera/image_raw"], samples["/scan"]
    assert picture.pixels.shape == (480, 640, 3)
    assert picture.encoding == "rgb8"
    assert samples["/camera/camera_info"].matrix[0, 0] == pytest.approx(320 / math.tan(0.5))
    assert isinstance(scan, LaserScanSample)
    assert (len(scan.ranges), scan.range_min, scan.range_max) == (720, 0.1, 30.0)
    assert scan.ranges[360] == pytest.approx(3 - 0.05, abs=0.01)  # the wall ahead


def test_the_trucks_rear_axle_drives_the_arc_of_its_command():
    """With wheels of the plain plugin instead of the controllers: 1 m/s and 0.5 rad/s make a radius of 2 m."""
    plugin = (
        '<plugin filename="libgazebo_ros_diff_drive.so" name="d"><left_joint>body_to_back_left_wheel</left_joint>'
        "<right_joint>body_to_back_right_wheel</right_joint><wheel_separation>1.46</wheel_separation>"
        "<wheel_diameter>0.835</wheel_diameter><max_wheel_torque>2000</max_wheel_torque>"
        "<robot_base_frame>body</robot_base_frame></plugin>"
    )
    from daidalos.description.xacro import load_xacro

    text = load_xacro(SHARE / TRUCK, resolve=share_of)
    before, _, rest = text.partition("<ros2_control")
    after = rest.partition("</ros2_control>")[2]
    head, _, tail = after.partition("<plugin")
    text = before + head + plugin + tail.partition("</plugin>")[2]
    simulation = Simulation(world(), has_subscribers=lambda topic: topic == "/odom")
    simulation.spawn(urdf.parse(text, resolve=share_of), pose=Pose((0.0, 0.0, 0.43)))
    simulation.advance(SECOND)
    simulation.command("/cmd_vel", TwistCommand(np.array((1.0, 0, 0)), np.array((0, 0, 0.5))))
    simulation.advance(2 * SECOND)
    places = []
    for _ in range(20):
        samples = simulation.advance(SECOND // 4)
        places.append(simulation.pose("truck").transform((-1.5, 0.0, 0.0))[:2])
    x, y = np.array(places).T
    # The circle through the points, by least squares.
    a, b, c = np.linalg.lstsq(np.stack((x, y, np.ones_like(x)), axis=1), x**2 + y**2, rcond=None)[0]
    assert math.sqrt(c + a * a / 4 + b * b / 4) == pytest.approx(2.0, rel=0.02)
    odometry = [sample for sample in samples if isinstance(sample, OdometrySample)][-1]
    assert odometry.angular[2] == pytest.approx(0.5, rel=0.02)
