"""Skid steering, planar move, velocity control, wheel slip."""

import numpy as np
import pytest

from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import OdometrySample, TransformSample, WheelSlipSample
from daidalos.simulation import Simulation
from simulation.models import box, world
from simulation.plugins.vehicles import four_wheels

SECOND = 1_000_000_000
SKID = (
    "<plugin name='s' filename='libgazebo_ros_skid_steer_drive.so'><leftFrontJoint>fl_j</leftFrontJoint>"
    "<leftRearJoint>rl_j</leftRearJoint><rightFrontJoint>fr_j</rightFrontJoint><rightRearJoint>rr_j</rightRearJoint>"
    "<wheelSeparation>0.5</wheelSeparation><wheelDiameter>0.2</wheelDiameter><torque>30</torque>"
    "<robotBaseFrame>chassis</robotBaseFrame></plugin>"
)


def twist(x=0.0, y=0.0, turn=0.0):
    return TwistCommand(np.array((x, y, 0.0)), np.array((0.0, 0.0, turn)))


def last(samples, kind):
    return [s for s in samples if isinstance(s, kind)][-1]


def test_a_skid_steered_cart_drives_and_turns():
    simulation = Simulation(world(four_wheels(SKID, base=0.3)))
    simulation.advance(SECOND // 2)
    simulation.command("/cmd_vel", twist(0.5))
    simulation.advance(2 * SECOND)
    assert simulation.velocity("cart", "chassis")[0][0] == pytest.approx(0.5, rel=0.02)
    simulation.command("/cmd_vel", twist(turn=1.0))
    odometry = last(simulation.advance(2 * SECOND), OdometrySample)
    rate = simulation.velocity("cart", "chassis")[1][2]
    assert 0.3 < rate <= 1.0  # it slips
    assert odometry.angular[2] == pytest.approx(rate, rel=0.05)  # odometry knows the truth


PLANAR = (
    "<plugin name='p' filename='libgazebo_ros_planar_move.so'><robot_base_frame>link</robot_base_frame>"
    "<publish_rate>50</publish_rate></plugin>"
)


def test_a_planar_base_goes_in_any_direction():
    smooth = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>"
    sledge = box("b", "1 2 0.5 0 0 1.5707963267948966", surface=smooth)
    simulation = Simulation(world(sledge.replace("</model>", PLANAR + "</model>")))
    simulation.command("/cmd_vel", twist(0.4, 0.2))
    samples = simulation.advance(2 * SECOND)
    # Turned by 90 degrees: its x axis is the world's y.
    assert simulation.pose("b").position[:2] == pytest.approx((1 - 0.4, 2 + 0.8), abs=0.01)
    odometry = last(samples, OdometrySample)
    assert odometry.position[:2] == pytest.approx((0.8, 0.4), abs=0.02)
    assert odometry.linear[:2] == pytest.approx((0.4, 0.2), abs=0.02)
    assert last(samples, TransformSample).child_frame_id == "link"
    assert len([s for s in samples if isinstance(s, OdometrySample)]) == pytest.approx(100, abs=3)


def test_a_planar_base_still_falls():
    simulation = Simulation(world(box("b", "0 0 5 0 0 0").replace("</model>", PLANAR + "</model>")))
    simulation.command("/cmd_vel", twist(0.4))
    simulation.advance(SECOND // 2)
    assert simulation.velocity("b")[0][2] == pytest.approx(-4.9, rel=0.01)


def test_velocity_control_flies():
    plugin = (
        "<plugin name='p' filename='gz-sim-velocity-control-system'><initial_linear>0 0 1</initial_linear></plugin>"
    )
    simulation = Simulation(world(box("b").replace("</model>", plugin + "</model>")))
    simulation.advance(SECOND)
    assert simulation.pose("b").position[2] == pytest.approx(1.5, abs=0.02)  # it falls a little in each step


def slipping(compliance, speed, push):
    """Return how fast a cart creeps whose wheels turn with a speed while it is pushed back."""
    names = ("fl", "fr", "rl", "rr")
    weight = 14 * 9.8 / 4
    wheels = "".join(
        f"<wheel link_name='{name}'><slip_compliance_lateral>{compliance}</slip_compliance_lateral>"
        f"<slip_compliance_longitudinal>{compliance}</slip_compliance_longitudinal>"
        f"<wheel_normal_force>{weight}</wheel_normal_force><wheel_radius>0.1</wheel_radius></wheel>"
        for name in names
    )
    plugin = SKID + f"<plugin name='slip' filename='libgazebo_ros_wheel_slip.so'>{wheels}</plugin>"
    simulation = Simulation(world(four_wheels(plugin)))
    simulation.advance(SECOND // 2)
    simulation.command("/cmd_vel", twist(speed))
    simulation.advance(2 * SECOND)
    simulation.push("cart", "chassis", force=(-push, 0, 0))
    samples = simulation.advance(2 * SECOND)
    return simulation.velocity("cart", "chassis")[0][0], last(samples, WheelSlipSample)


@pytest.mark.slow
def test_slip_grows_with_the_force():
    """Slip over rim speed is compliance times tangential over normal force."""
    speed, sample = slipping(1.0, 0.5, push=30.0)
    slip = 0.5 * 1.0 * 30.0 / (14 * 9.8)
    assert speed == pytest.approx(0.5 - slip, abs=0.01)
    assert sample.longitudinal == pytest.approx([slip / 0.5] * 4, abs=0.03)
    assert sample.lateral == pytest.approx([0] * 4, abs=0.01)


@pytest.mark.slow
def test_without_force_there_is_no_slip():
    speed, sample = slipping(1.0, 0.5, push=0.0)
    assert speed == pytest.approx(0.5, abs=0.005)
    assert np.abs(sample.longitudinal).max() < 0.01


def test_an_unknown_wheel_is_named():
    plugin = "<plugin name='p' filename='libWheelSlipPlugin.so'><wheel link_name='w'/></plugin>"
    simulation = Simulation(world(four_wheels(plugin)), warn=lambda line: None)
    assert "there is no link 'w'" in simulation.warnings[0]
