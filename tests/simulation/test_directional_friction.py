"""Wheels that grip along one direction alone: a base on four of them moves any way, as its wheels say."""

import pytest

from daidalos.description import sdf, urdf
from daidalos.description.gazebo import model_from_robot
from daidalos.samples.commands import NumberCommand
from daidalos.simulation import Simulation
from simulation.models import world
from simulation.plugins.vehicles import four_wheels

SECOND = 1_000_000_000
RADIUS, BASE, TRACK = 0.1, 0.6, 0.5
GRIPS = {"fl": "1 -1 0", "fr": "1 1 0", "rl": "1 1 0", "rr": "1 -1 0"}


def surface(direction, prefix="gz"):
    return (
        "<surface><friction><ode><mu>1</mu><mu2>0</mu2>"
        f"<fdir1 {prefix}:expressed_in='chassis'>{direction}</fdir1></ode></friction></surface>"
    )


def mecanum(drives=True):
    """Return a base on four wheels with rollers, with a drive for each."""
    plugins = "".join(
        f"<plugin name='{wheel}' filename='gz-sim-joint-controller-system'><joint_name>{wheel}_j</joint_name></plugin>"
        for wheel in (GRIPS if drives else ())
    )
    model = four_wheels(plugins, base=BASE, track=TRACK, radius=RADIUS)
    for wheel, direction in GRIPS.items():
        head, tail = model.split(f"<link name='{wheel}'>")
        model = f"{head}<link name='{wheel}'>{tail.replace('</collision>', surface(direction) + '</collision>', 1)}"
    return model


@pytest.mark.slow
@pytest.mark.parametrize("motion", [(0.3, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.5), (0.2, -0.2, 0.0)])
def test_a_base_on_mecanum_wheels_moves_as_its_wheels_say(motion):
    simulation = Simulation(world(mecanum()))
    simulation.advance(SECOND // 2)
    start = simulation.pose("cart")
    ahead, left, turn = motion
    arm = (BASE + TRACK) / 2 * turn
    speeds = {
        "fl": ahead - left - arm,
        "fr": ahead + left + arm,
        "rl": ahead + left - arm,
        "rr": ahead - left + arm,
    }
    for wheel, speed in speeds.items():
        simulation.command(f"/model/cart/joint/{wheel}_j/cmd_vel", NumberCommand(speed / RADIUS))
    simulation.advance(2 * SECOND)
    moved = start.inverse @ simulation.pose("cart")
    assert moved.position[:2] == pytest.approx((2 * ahead, 2 * left), abs=0.02)
    assert moved.yaw == pytest.approx(2 * turn, abs=0.03)


def test_what_grips_across_stands_on_a_slope_along_it():
    block = (
        "<model name='b'><pose>0 0 0.5 0 0 0</pose><link name='link'><inertial><mass>1</mass></inertial>"
        "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry>{}</collision></link></model>"
    )
    steady, loose = (block.format(surface(way).replace("chassis", "link")) for way in ("1 0 0", "0 1 0"))
    for model, slides in ((steady, False), (loose, True)):
        simulation = Simulation(world(model))
        simulation.gravity = (3.0, 0.0, -9.0)  # a slope of a third
        simulation.advance(SECOND)
        assert (abs(simulation.pose("b").position[0]) > 0.5) is slides


def test_a_direction_is_read_from_urdf_and_sdf():
    robot = urdf.parse(
        "<robot name='r'><link name='base'><collision><geometry><sphere radius='1'/></geometry></collision></link>"
        "<gazebo reference='base'><mu1>1</mu1><mu2>0</mu2><fdir1 ignition:expressed_in='base'>1 2 3</fdir1></gazebo>"
        "</robot>"
    )
    (collision,) = model_from_robot(robot).links["base"].collisions
    assert collision.surface.direction == (1, 2, 3)
    assert collision.surface.direction_frame == "base"
    model = sdf.parse_model(f"<sdf version='1.9'>{mecanum()}</sdf>")
    assert model.links["fl"].collisions[0].surface.direction == (1, -1, 0)
