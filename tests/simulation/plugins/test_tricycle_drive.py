"""ROS 2's tricycle drive."""

import math

import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import JointStateSample, OdometrySample, TransformSample
from daidalos.simulation import Simulation
from simulation.models import world
from simulation.plugins.vehicles import WHEEL, inertia

SECOND = 1_000_000_000
BASE, TRACK, RADIUS = 0.6, 0.5, 0.1
JOINTS = "".join(
    f"<{tag}_joint>{joint}</{tag}_joint>"
    for tag, joint in (
        *(("steering", "steer"), ("actuated_wheel", "front_j")),
        *(("encoder_wheel_left", "left_j"), ("encoder_wheel_right", "right_j")),
    )
)
SIZES = "<wheel_separation>0.5</wheel_separation><actuated_wheel_diameter>0.2</actuated_wheel_diameter>"
SIZES += "<encoder_wheel_diameter>0.2</encoder_wheel_diameter><robot_base_frame>frame</robot_base_frame>"
REST = "<max_wheel_torque>20</max_wheel_torque>"


def tricycle(parameters):
    def wheel(name, x, y, parent):
        return (
            WHEEL.format(name=name, x=x, y=y, r=RADIUS)
            + f"<joint name='{name}_j' type='revolute'><parent>{parent}</parent><child>{name}</child>"
            "<axis><xyz>0 0 1</xyz></axis></joint>"
        )

    fork = (
        f"<link name='fork'><pose>{BASE} 0 {RADIUS} 0 0 0</pose>{inertia(0.5, 0.005)}</link>"
        "<joint name='steer' type='revolute'><parent>frame</parent><child>fork</child><axis><xyz>0 0 1</xyz>"
        "<limit><lower>-1.5</lower><upper>1.5</upper></limit></axis></joint>"
    )
    wheels = wheel("front", BASE, 0, "fork")
    wheels += wheel("left", 0, TRACK / 2, "frame") + wheel("right", 0, -TRACK / 2, "frame")
    body = f"<link name='frame'><pose>0.3 0 0.2 0 0 0</pose>{inertia(10, 0.4)}</link>"
    plugin = f"<plugin name='p' filename='libgazebo_ros_tricycle_drive.so'>{parameters}</plugin>"
    return Simulation(world(f"<model name='t'>{body}{fork}{wheels}{plugin}</model>"))


def command(speed, angle):
    return TwistCommand(np.array((speed, 0, 0)), np.array((0, 0, angle)))


def last(samples, kind):
    return [sample for sample in samples if isinstance(sample, kind)][-1]


def test_straight_ahead_the_odometry_is_the_truth():
    simulation = tricycle(JOINTS + SIZES + REST)
    assert not simulation.warnings
    simulation.command("/cmd_vel", command(0.5, 0.0))
    odometry = last(simulation.advance(4 * SECOND), OdometrySample)
    assert odometry.position[0] == pytest.approx(2, abs=0.06)  # the one wheel that drives slips as it starts
    assert odometry.position[0] == pytest.approx(simulation.pose("t").position[0], abs=5e-3)
    assert (odometry.topic, odometry.frame_id, odometry.child_frame_id) == ("/odom", "odom", "frame")


def test_the_commands_turn_is_the_steering_angle():
    """The wheel that drives goes about the point where its axle meets that of the others."""
    simulation = tricycle(JOINTS + SIZES + REST)
    simulation.command("/cmd_vel", command(0.3, 0.5))
    odometry = last(simulation.advance(5 * SECOND), OdometrySample)
    assert simulation.joint("t", "steer").position == pytest.approx(0.5, abs=0.01)
    assert odometry.linear[0] == pytest.approx(0.3 * math.cos(0.5), rel=0.03)
    assert odometry.angular[2] == pytest.approx(0.3 * math.sin(0.5) / BASE, rel=0.05)


def test_speed_and_angle_come_as_fast_as_they_may():
    limits = "<max_wheel_acceleration>0.2</max_wheel_acceleration><max_steering_speed>0.1</max_steering_speed>"
    simulation = tricycle(JOINTS + SIZES + REST + limits + "<max_steering_angle>0.15</max_steering_angle>")
    simulation.command("/cmd_vel", command(0.5, 0.5))
    odometry = last(simulation.advance(SECOND), OdometrySample)
    assert odometry.linear[0] == pytest.approx(0.2, abs=0.02)
    assert simulation.joint("t", "steer").position == pytest.approx(0.1, abs=0.01)
    simulation.advance(SECOND)
    assert simulation.joint("t", "steer").position == pytest.approx(0.15, abs=0.01)


def test_what_it_says_by_which_names():
    flags = "".join(f"<publish_{what}>true</publish_{what}>" for what in ("wheel_tf", "wheel_joint_state", "odom"))
    ros = "<ros><namespace>/n</namespace><remapping>cmd_vel:=go</remapping><remapping>odom:=way</remapping></ros>"
    simulation = tricycle(ros + JOINTS + SIZES + REST + flags + "<odometry_frame>start</odometry_frame>")
    assert set(simulation.publications) == {"/n/way", "/tf", "/n/joint_states"}
    assert set(simulation.subscriptions) == {"/n/go"}
    samples = list(simulation.advance(SECOND // 10))
    frames = {(s.frame_id, s.child_frame_id) for s in samples if isinstance(s, TransformSample)}
    assert frames == {("start", "frame"), *(("frame", name) for name in ("fork", "front", "left", "right"))}
    assert last(samples, JointStateSample).names == ("steer", "front_j", "left_j", "right_j")


def test_the_base_may_be_the_fork():
    parameters = JOINTS + SIZES.replace(">frame<", ">fork<") + "<publish_wheel_tf>true</publish_wheel_tf>"
    samples = [s for s in tricycle(parameters).advance(SECOND // 10) if isinstance(s, TransformSample)]
    assert {s.child_frame_id for s in samples if s.frame_id == "fork"} == {"front", "left", "right"}


def test_without_a_joint_it_is_left_out():
    assert "<steering_joint> is missing; the plugin is left out" in tricycle(SIZES).warnings[0]


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        (JOINTS + "<wheel_separation>0</wheel_separation>", "<wheel_separation> should be positive, got 0"),
    ],
)
def test_wrong_parameters_are_named(parameters, words):
    with pytest.raises(DescriptionError, match=words):
        tricycle(parameters)
