import math

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import JointStateSample, OdometrySample, TransformSample
from daidalos.simulation import Simulation
from daidalos.simulation.plugins.diff_drive_settings import Limits
from simulation.models import turtlebot, world
from simulation.plugins import vehicles

SECOND = 1_000_000_000


def twist(speed, turn=0.0):
    return TwistCommand(np.array([speed, 0, 0]), np.array([0, 0, turn]))


def last(samples, kind):
    return [s for s in samples if isinstance(s, kind)][-1]


def yaw_of(quaternion):
    return 2 * math.atan2(quaternion[2], quaternion[3])


def difference(a, b):
    return (a - b + math.pi) % (2 * math.pi) - math.pi


def drive(robot, speed, turn, seconds, **options):
    """Drive and return the simulation, total true and measured turn, the last odometry and the true pose."""
    simulation = Simulation(world(), **options)
    simulation.spawn(robot, "robot")
    simulation.advance(SECOND // 2)
    start = simulation.pose("robot")
    simulation.command("/cmd_vel", twist(speed, turn))
    true = measured = 0.0
    last_true, last_measured = start.yaw, 0.0
    for _ in range(round(seconds * 4)):
        odometry = last(simulation.advance(SECOND // 4), OdometrySample)
        yaw, wheels = simulation.pose("robot").yaw, yaw_of(odometry.orientation)
        true, last_true = true + difference(yaw, last_true), yaw
        measured, last_measured = measured + difference(wheels, last_measured), wheels
    return simulation, true, measured, odometry, start.inverse @ simulation.pose("robot")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["waffle", "burger"])
def test_ten_metres_straight_within_5_mm(name):
    _, _, _, odometry, pose = drive(turtlebot(name), 0.26, 0.0, 39)
    assert odometry.position[0] > 10
    assert odometry.position[:2] == pytest.approx(pose.position[:2], abs=0.005)
    assert odometry.linear == pytest.approx([0.26, 0, 0], abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("turn", [1.5, -1.0])
def test_ten_turns_on_the_spot_within_a_thousandth(turn):
    _, true, measured, _, pose = drive(turtlebot(), 0.0, turn, 21 * math.pi / abs(turn))
    assert abs(true) > 20 * math.pi
    assert measured == pytest.approx(true, rel=1e-3)
    assert math.hypot(*pose.position[:2]) < 0.005


@pytest.mark.slow
def test_an_arc_has_the_right_radius():
    _, true, _, odometry, pose = drive(turtlebot(), 0.2, 0.4, math.pi / 0.4)
    assert true == pytest.approx(math.pi, abs=0.15)
    radius = math.hypot(pose.position[0], pose.position[1]) / (2 * math.sin(true / 2))
    assert radius == pytest.approx(0.5, rel=0.02)
    assert odometry.angular[2] == pytest.approx(0.4, rel=0.01)


@pytest.mark.slow
def test_at_rest_for_a_minute_nothing_drifts():
    simulation, true, _, odometry, pose = drive(turtlebot(), 0.0, 0.0, 60)
    assert np.abs(odometry.position).max() < 1e-5
    assert np.abs(pose.position).max() < 1e-5
    assert abs(true) < 1e-5
    assert simulation.time_ns == 60.5 * SECOND


def test_a_robot_pushed_by_its_wheels_slips_only_as_friction_says():
    """On ice it stays where it is, and its odometry does not know."""
    simulation = Simulation(world())
    simulation.spawn(turtlebot(), "robot")
    simulation.physics.model.geom_friction[:, 0] = 1e-4
    simulation.command("/cmd_vel", twist(0.2))
    odometry = last(simulation.advance(3 * SECOND), OdometrySample)
    assert odometry.position[0] > 0.5
    assert simulation.pose("robot").position[0] < 0.05


def test_acceleration_is_limited_as_the_plugin_says():
    simulation = Simulation(world())
    simulation.spawn(turtlebot(), "robot")
    simulation.advance(SECOND // 10)
    simulation.command("/cmd_vel", twist(0.5))
    speeds = [s.linear[0] for s in simulation.advance(SECOND) if isinstance(s, OdometrySample)]
    assert speeds[24] == pytest.approx(0.25, abs=0.02)
    assert speeds[-1] == pytest.approx(0.5, abs=1e-3)
    assert np.diff(speeds).max() < 0.02


def test_what_it_says():
    simulation = Simulation(world())
    simulation.spawn(turtlebot(), "robot", Pose((3, 4, 0)))
    simulation.command("/cmd_vel", twist(0.2))
    samples = simulation.advance(SECOND)
    odometry, transform = last(samples, OdometrySample), last(samples, TransformSample)
    states = last(samples, JointStateSample)
    assert (odometry.topic, odometry.frame_id, odometry.child_frame_id) == ("/odom", "odom", "base_footprint")
    assert 0.1 < odometry.position[0] < 0.2
    assert (transform.topic, transform.frame_id, transform.child_frame_id) == (
        "/tf",
        "odom",
        "base_footprint",
    )
    np.testing.assert_array_equal(transform.translation, odometry.position)
    assert (states.topic, states.names) == ("/joint_states", ("wheel_left_joint", "wheel_right_joint"))
    assert states.positions * 0.033 == pytest.approx([odometry.position[0]] * 2, abs=1e-9)
    assert np.diag(odometry.pose_covariance.reshape(6, 6)).tolist() == [1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3]


@pytest.mark.slow
def test_encoder_noise_and_slip_reach_the_odometry_and_not_the_robot():
    robot = turtlebot(noise=True)
    ends = [drive(robot, 0.25, 0.0, 8, seed=seed)[3:] for seed in range(4)]
    travelled = np.array([odometry.position[0] - pose.position[0] for odometry, pose in ends])
    assert 1e-4 < travelled.std() < 0.02
    truth = np.array([pose.position for _, pose in ends])
    assert np.ptp(truth, axis=0) == pytest.approx([0, 0, 0], abs=1e-9)


ROBOT = """<robot name="r"><link name="base"><inertial><mass value="5"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>{wheels}
  <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="caster_joint" type="fixed"><parent link="base"/><child link="ball"/>
  <origin xyz="-0.3 0 0"/></joint>
  <gazebo reference="ball"><mu1>0</mu1><mu2>0</mu2></gazebo>
  <gazebo><plugin name="d" filename="{library}">{parameters}</plugin></gazebo></robot>"""
WHEEL = """<link name="{n}"><inertial><mass value="0.3"/>
  <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.002"/></inertial>
  <collision><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
  <joint name="{n}_joint" type="continuous"><parent link="base"/><child link="{n}"/>
  <origin xyz="{x} {y} 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>"""


def spawned(library, parameters, wheels=(("left", 0.1, 0.2), ("right", 0.1, -0.2)), warn=None):
    described = "".join(WHEEL.format(n=name, x=x, y=y) for name, x, y in wheels)
    robot = urdf.parse(ROBOT.format(library=library, parameters=parameters, wheels=described))
    simulation = Simulation(world(), warn=warn)
    simulation.spawn(robot, "r", Pose((0, 0, 0.1)), namespace="n")
    return simulation


ROS1 = "<leftJoint>left_joint</leftJoint><rightJoint>right_joint</rightJoint>"
ROS1 += "<wheelSeparation>0.4</wheelSeparation><wheelDiameter>0.2</wheelDiameter>"
ROS1 += "<robotBaseFrame>base</robotBaseFrame>"
ROS2 = "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"
ROS2 += "<wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>"
GZ = "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"
GZ += "<wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>"


@pytest.mark.parametrize(
    ("library", "parameters", "command", "odometry", "frames", "rate"),
    [
        ("libgazebo_ros_diff_drive.so", ROS1 + "<legacyMode>false</legacyMode>", "/n/cmd_vel", "/n/odom",
         ("odom", "base"), 100),
        ("libgazebo_ros_diff_drive.so", ROS2 + "<update_rate>50</update_rate><ros><namespace>/x</namespace>"
         "<remapping>cmd_vel:=go</remapping><remapping>odom:=od</remapping></ros>", "/x/go", "/x/od",
         ("odom", "base_footprint"), 50),
        ("gz-sim-diff-drive-system", GZ, "/model/r/cmd_vel", "/model/r/odometry", ("r/odom", "r/base"), 50),
        ("libignition-gazebo-diff-drive-system.so", GZ + "<topic>go</topic><frame_id>odom</frame_id>",
         "/n/go", "/model/r/odometry", ("odom", "r/base"), 50),
    ],
)  # fmt: skip
def test_dialects(library, parameters, command, odometry, frames, rate):
    simulation = spawned(library, parameters)
    assert set(simulation.subscriptions) == {command}
    simulation.advance(SECOND // 2)
    simulation.command(command, twist(0.3, 0.2))
    samples = [s for s in simulation.advance(SECOND) if isinstance(s, OdometrySample)]
    assert len(samples) == rate
    assert (samples[-1].topic, samples[-1].frame_id, samples[-1].child_frame_id) == (odometry, *frames)
    assert samples[-1].linear[0] == pytest.approx(0.3, abs=1e-3)
    assert samples[-1].angular[2] == pytest.approx(0.2, abs=2e-3)
    assert simulation.pose("r").yaw > 0.1


def test_several_wheels_on_a_side():
    wheels = [(f"{side}{i}", x, y) for side, y in (("l", 0.2), ("r", -0.2)) for i, x in enumerate((0.1, 0.0))]
    joints = "".join(f"<{side}_joint>{side[0]}{i}_joint</{side}_joint>" for side in ("left", "right") for i in (0, 1))
    parameters = f"<num_wheel_pairs>2</num_wheel_pairs>{joints}<wheel_separation>0.4</wheel_separation>"
    parameters += "<wheel_diameter>0.2</wheel_diameter><max_wheel_acceleration>1</max_wheel_acceleration>"
    simulation = spawned("libgazebo_ros_diff_drive.so", parameters, wheels)
    simulation.command("/n/cmd_vel", twist(0.3))
    odometry = last(simulation.advance(2 * SECOND), OdometrySample)
    assert odometry.position[0] == pytest.approx(simulation.pose("r").position[0], abs=2e-3)


def test_wheels_of_two_sizes_roll_together():
    """The rims of a big and of a small pair go equally fast."""
    parts = [
        vehicles.WHEEL.format(name=f"{place}{side}", x=x, y=y, r=radius)
        + f"<joint name='{place}{side}_j' type='revolute'><parent>chassis</parent><child>{place}{side}</child>"
        "<axis><xyz>0 0 1</xyz></axis></joint>"
        for place, x, radius in (("front", 0.3, 0.2), ("rear", -0.3, 0.1))
        for side, y in (("l", 0.25), ("r", -0.25))
    ]
    joints = "".join(
        f"<left_joint>{place}l_j</left_joint><right_joint>{place}r_j</right_joint>"
        f"<wheel_separation>0.5</wheel_separation><wheel_diameter>{diameter}</wheel_diameter>"
        for place, diameter in (("front", 0.4), ("rear", 0.2))
    )
    plugin = f"<plugin name='p' filename='libgazebo_ros_diff_drive.so'>{joints}</plugin>"
    chassis = f"<link name='chassis'><pose>0 0 0.3 0 0 0</pose>{vehicles.inertia(10, 0.4)}</link>"
    simulation = Simulation(world(f"<model name='cart'>{chassis}{''.join(parts)}{plugin}</model>"))
    simulation.command("/cmd_vel", twist(0.5))
    odometry = last(simulation.advance(2 * SECOND), OdometrySample)
    speeds = [simulation.joint("cart", name).velocity for name in ("frontl_j", "rearl_j")]
    assert speeds == pytest.approx([2.5, 5], rel=0.02)
    assert odometry.position[0] == pytest.approx(simulation.pose("cart").position[0], abs=5e-3)


def test_ros1_swaps_the_sides_unless_told_otherwise():
    lines = []
    simulation = spawned("libgazebo_ros_diff_drive.so", ROS1, warn=lines.append)
    assert "<legacyMode> is on" in lines[0]
    simulation.command("/n/cmd_vel", twist(0.0, 0.5))
    simulation.advance(SECOND)
    assert simulation.pose("r").yaw < -0.2


@pytest.mark.parametrize("source", ["world", "1"])
def test_odometry_of_the_world_is_the_true_pose(source):
    base = f"<odometry_source>{source}</odometry_source><robot_base_frame>base</robot_base_frame>"
    simulation = spawned("libgazebo_ros_diff_drive.so", ROS2 + base)
    simulation.set_pose("r", Pose.from_xyz_rpy((3, 4, 0.1), (0, 0, 1)))
    simulation.command("/n/cmd_vel", twist(0.2))
    odometry = last(simulation.advance(SECOND), OdometrySample)
    assert odometry.position == pytest.approx(simulation.pose("r").position)
    assert odometry.linear == pytest.approx([0.2, 0, 0], abs=1e-3)


def test_wheel_transforms_and_silence():
    simulation = spawned(
        "libgazebo_ros_diff_drive.so",
        ROS2 + "<publish_odom>false</publish_odom><publish_wheel_tf>true</publish_wheel_tf>",
    )
    samples = simulation.advance(SECOND // 100)
    assert {s.child_frame_id for s in samples} == {"base_footprint", "left", "right"}
    wheel = next(s for s in samples if s.child_frame_id == "left")
    assert wheel.translation == pytest.approx([0.1, 0.2, 0], abs=1e-3)
    silent = spawned("libgazebo_ros_diff_drive.so", ROS2 + "<publish_odom_tf>0</publish_odom_tf>")
    assert {type(s) for s in silent.advance(SECOND // 100)} == {OdometrySample}


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        (
            ROS2 + "<wheel_diameter>0.3</wheel_diameter>",
            "expected one <wheel_diameter>, or one above zero for each pair",
        ),
        (ROS2.replace("0.4", "-1"), "<wheel_separation> should be positive"),
        (ROS2.replace("0.4", "wide"), "should be a number, got 'wide'"),
        (ROS2 + "<encoder_noise>-1</encoder_noise>", "<encoderNoise> should not be negative"),
    ],
)
def test_mistakes(parameters, words):
    with pytest.raises(DescriptionError, match=words):
        spawned("libgazebo_ros_diff_drive.so", parameters)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ("", "<left_joint> is missing"),
        (ROS2.replace("left_joint<", "lft_joint<"), "no joint 'lft_joint'; did you mean 'left_joint'"),
    ],
)
def test_without_its_joints_it_is_left_out(parameters, words):
    simulation = spawned("libgazebo_ros_diff_drive.so", parameters, warn=lambda line: None)
    assert words in simulation.warnings[0]
    assert "r" in simulation.models


def test_limits():
    limits = Limits(slowest=-0.1, fastest=0.5, deceleration=-2, acceleration=1)
    assert limits.apply(9, 0.4, 0.05) == pytest.approx(0.45)
    assert limits.apply(9, 0.4, 1) == 0.5
    assert limits.apply(-9, 0.4, 0.05) == pytest.approx(0.3)
    assert limits.apply(-9, 0.0, 1) == -0.1
    assert Limits().apply(9, 0, 0.001) == 9
