import math

import numpy as np
import pytest

from daidalos.samples.commands import NumberCommand, TwistCommand
from daidalos.samples.sensors import OdometrySample
from daidalos.simulation import Simulation
from simulation.models import world
from simulation.plugins.vehicles import four_wheels

SECOND = 1_000_000_000
GZ = (
    "<plugin name='a' filename='gz-sim-ackermann-steering-system'><left_joint>rl_j</left_joint>"
    "<right_joint>rr_j</right_joint><left_steering_joint>fl_steer</left_steering_joint>"
    "<right_steering_joint>fr_steer</right_steering_joint><wheel_separation>0.5</wheel_separation>"
    "<kingpin_width>0.5</kingpin_width><wheel_base>0.6</wheel_base><wheel_radius>0.1</wheel_radius>"
    "<steering_limit>0.7</steering_limit></plugin>"
)
CLASSIC = (
    "<plugin name='a' filename='libgazebo_ros_ackermann_drive.so'><front_left_joint>fl_j</front_left_joint>"
    "<front_right_joint>fr_j</front_right_joint><rear_left_joint>rl_j</rear_left_joint>"
    "<rear_right_joint>rr_j</rear_right_joint><left_steering_joint>fl_steer</left_steering_joint>"
    "<right_steering_joint>fr_steer</right_steering_joint><max_steer>0.6</max_steer>"
    "<robot_base_frame>chassis</robot_base_frame></plugin>"
)


def drive(plugin, topic, speed, turn, seconds=4):
    """Return the radius of the circle that the rear axle's middle goes, and the last odometry."""
    simulation = Simulation(world(four_wheels(plugin, steered=True)))
    simulation.advance(SECOND // 2)
    assert simulation.command(topic, TwistCommand(np.array((speed, 0, 0)), np.array((0, 0, turn)))) == 1
    simulation.advance(SECOND)
    start = simulation.pose("cart", "chassis")
    samples = simulation.advance(seconds * SECOND)
    end = simulation.pose("cart", "chassis")
    turned = (end.yaw - start.yaw + math.pi) % (2 * math.pi) - math.pi
    linear, angular = simulation.velocity("cart", "chassis")
    return (
        float(np.linalg.norm(linear[:2]) / abs(angular[2])),
        turned,
        [s for s in samples if isinstance(s, OdometrySample)][-1],
    )


def test_gzs_command_is_a_turn_rate():
    _, turned, odometry = drive(GZ, "/model/cart/cmd_vel", 0.5, 0.3)
    assert turned == pytest.approx(4 * 0.3, rel=0.03)
    assert odometry.linear[0] == pytest.approx(0.5, rel=0.02)
    assert odometry.angular[2] == pytest.approx(0.3, rel=0.03)


def test_ros2s_command_is_a_steering_angle():
    """The rear axle's middle goes a circle of L / tan(angle); the chassis is L / 2 ahead of it."""
    radius, turned, odometry = drive(CLASSIC, "/cmd_vel", 0.5, 0.4)
    assert radius == pytest.approx(math.hypot(0.6 / math.tan(0.4), 0.3), rel=0.03)
    assert turned > 0
    assert odometry.child_frame_id == "chassis"


def test_the_steering_has_a_limit():
    radius, _, _ = drive(CLASSIC, "/cmd_vel", 0.5, -1.5)
    assert radius == pytest.approx(math.hypot(0.6 / math.tan(0.6), 0.3), rel=0.03)


def test_a_missing_joint_is_named_and_the_rest_runs():
    simulation = Simulation(world(four_wheels(GZ.replace("fl_steer", "nose"), steered=True)), warn=lambda line: None)
    assert "there is no joint 'nose'" in simulation.warnings[0]
    assert simulation.models == ("ground_plane", "cart")
    assert not simulation.subscriptions


def test_a_drive_may_steer_only():
    steering = (
        "<plugin name='a' filename='gz-sim-ackermann-steering-system'><steering_only>true</steering_only>"
        "<left_steering_joint>fl_steer</left_steering_joint><right_steering_joint>fr_steer</right_steering_joint>"
        "<wheel_separation>0.5</wheel_separation><wheel_base>0.6</wheel_base><steering_limit>0.7</steering_limit>"
        "</plugin>"
    )
    simulation = Simulation(world(four_wheels(steering, steered=True)))
    assert not simulation.publications
    assert simulation.command("/model/cart/steer_angle", NumberCommand(0.4)) == 1
    simulation.advance(SECOND)
    inner, outer = (math.atan(0.6 / (0.6 / math.tan(0.4) - offset)) for offset in (0.25, -0.25))
    assert simulation.joint("cart", "fl_steer").position == pytest.approx(inner, abs=0.01)
    assert simulation.joint("cart", "fr_steer").position == pytest.approx(outer, abs=0.01)
