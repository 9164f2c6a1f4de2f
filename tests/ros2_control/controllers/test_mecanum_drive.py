"""Mecanum drive, against the wheels' own geometry."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.samples.controllers import MecanumSample, VelocityCommand
from daidalos.samples.sensors import OdometrySample

PERIOD = PERIOD_NS * 1e-9
RADIUS, LENGTH, WIDTH = 0.05, 0.2, 0.15
WHEELS = {
    f"{place}_wheel_command_joint_name": place for place in ("front_left", "front_right", "rear_right", "rear_left")
}


def rig(**kinematics: Any) -> Any:
    sizes = {"wheels_radius": RADIUS, "sum_of_robot_center_projection_on_X_Y_axis": LENGTH + WIDTH} | kinematics
    return alone("mecanum_drive_controller/MecanumDriveController", **WHEELS, kinematics=sizes)


def run(parts: Any, velocity: tuple[float, float, float], cycles: int) -> list[Any]:
    controller, commands, states = parts
    take = controller.subscriptions["~/reference"].take
    take(VelocityCommand(np.array((*velocity[:2], 0.0)), np.array((0.0, 0.0, velocity[2]))))
    said = []
    for step in range(cycles):
        said = cycle(controller, (step + 1) * PERIOD_NS)
        states.values[:] = commands.values
    return said


@pytest.mark.parametrize("velocity", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.3, -0.7, 1.3)])
def test_rollers_touch_the_ground_without_sliding(velocity: tuple[float, float, float]) -> None:
    parts = rig()
    run(parts, velocity, 1)
    vx, vy, turn = velocity
    places = {"front_left": (1, 1), "rear_left": (-1, 1), "rear_right": (-1, -1), "front_right": (1, -1)}
    for wheel, speed in zip(parts[1].names, parts[1].values, strict=True):
        ahead, left = places[wheel.split("/")[0]]
        x, y = ahead * LENGTH, left * WIDTH
        at_wheel = np.array([vx - turn * y, vy + turn * x])
        # The rollers are free along their axis's normal; along the axis, at 45 degrees, ground and wheel agree.
        axis = np.array([1.0, -ahead * left]) / math.sqrt(2)
        assert axis @ at_wheel == pytest.approx(axis @ np.array([speed * RADIUS, 0.0]))


@pytest.mark.parametrize("offset", [{}, {"base_frame_offset": {"x": 0.1, "y": -0.05, "theta": 0.7}}])
def test_odometry_is_what_was_wanted(offset: dict[str, Any]) -> None:
    said = run(rig(**offset), (0.4, 0.2, 0.5), 201)
    last = next(one for one in said if isinstance(one, OdometrySample))
    angle = 0.5 * 2.0
    s, c = math.sin(angle), math.cos(angle)
    expected = np.array([[s, -(1 - c)], [1 - c, s]]) @ np.array([0.4, 0.2]) / 0.5
    assert last.position[:2] == pytest.approx(expected, rel=1e-9)
    assert last.linear[:2] == pytest.approx([0.4, 0.2])
    assert last.angular[2] == pytest.approx(0.5)
    state = next(one for one in said if isinstance(one, MecanumSample))
    assert state.reference == pytest.approx([0.4, 0.2, 0.5])


def test_it_stands_when_commands_are_old_and_when_it_stops() -> None:
    controller, commands, states = alone(
        "mecanum_drive_controller/MecanumDriveController",
        **WHEELS,
        reference_timeout=0.1,
        kinematics={"wheels_radius": RADIUS, "sum_of_robot_center_projection_on_X_Y_axis": 0.3},
    )
    parts = (controller, commands, states)
    run(parts, (1.0, 0.0, 0.0), 5)
    assert commands.values == pytest.approx(20.0)
    run(parts, (1.0, 0.0, 0.0), 20)
    assert commands.values == pytest.approx(0.0)
    run(parts, (1.0, 0.0, 0.0), 2)
    controller.deactivate()
    assert commands.values == pytest.approx(0.0)
