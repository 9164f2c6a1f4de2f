"""Commands within the limits of joints."""

import math

import numpy as np
import pytest

from daidalos.control.interfaces import Interfaces
from daidalos.control.limits import CommandLimiter
from daidalos.description import urdf
from daidalos.description.ros2_control import read_hardware

ROBOT = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="{type}"><parent link="a"/><child link="b"/>
  <limit lower="-1" upper="2" effort="{effort}" velocity="{velocity}"/></joint>
<ros2_control name="h" type="system"><hardware><plugin>p</plugin></hardware><joint name="j">{lift}
{command}<command_interface name="velocity"/><command_interface name="effort"/>
<state_interface name="position"/></joint></ros2_control></robot>"""
PLAIN = '<command_interface name="position"/>'


def limiter(
    command: str = PLAIN, lift: str = "", effort: float = 5.0, velocity: float = 3.0, type: str = "revolute"
) -> tuple[CommandLimiter, Interfaces, Interfaces]:
    text = ROBOT.format(command=command, lift=lift, effort=effort, velocity=velocity, type=type)
    info = read_hardware(urdf.parse(text))[0]
    commands, states = Interfaces(info.command_names), Interfaces(info.state_names)
    states.values[:] = 0.0
    return CommandLimiter(info.components, commands, states), commands, states


def limited(*values: float, period: float = 10.0, **options: object) -> list[float]:
    one, commands, _ = limiter(**options)  # type: ignore[arg-type]
    commands.values[:] = values
    one.apply(period)
    return list(commands.values)


def test_positions_speeds_and_efforts_stay_within_the_joints() -> None:
    assert limited(5.0, -9.0, 7.0) == pytest.approx([2.0, -3.0, 5.0])
    assert limited(-5.0, 9.0, -7.0) == pytest.approx([-1.0, 3.0, -5.0])
    assert limited(0.5, 1.0, 1.0) == pytest.approx([0.5, 1.0, 1.0])


def test_interfaces_have_limits_of_their_own() -> None:
    limits = '<param name="min">-0.1</param><param name="max">0.1</param>'
    narrow = f'<command_interface name="position">{limits}</command_interface>'
    assert limited(5.0, 0.0, 0.0, command=narrow)[0] == pytest.approx(0.1)


def test_limits_can_be_lifted() -> None:
    assert limited(50.0, 9.0, 7.0, lift='<limits enable="false"/>') == pytest.approx([50.0, 9.0, 7.0])


def test_zero_is_no_limit_of_speed_or_effort() -> None:
    assert limited(1.0, 9.0, 7.0, effort=0.0, velocity=0.0) == pytest.approx([1.0, 9.0, 7.0])


def test_joints_without_end_have_no_range() -> None:
    assert limited(50.0, 0.0, 0.0, type="continuous", velocity=0.0)[0] == 50.0


def test_positions_change_no_faster_than_the_joint() -> None:
    one, commands, _ = limiter()
    positions = []
    for _ in range(40):
        commands.values[:] = [1.5, math.nan, math.nan]
        one.apply(0.02)
        positions.append(commands.values[0])
    assert positions[:25] == pytest.approx(0.06 * np.arange(1, 26))
    assert positions[25:] == pytest.approx([1.5] * 15)


def test_what_is_not_commanded_stays_unknown_and_counts_from_the_state() -> None:
    one, commands, states = limiter()
    assert not one.apply(0.02)
    assert np.isnan(commands.values).all()
    states.values[:] = 1.0
    commands.values[0] = 1.5
    assert one.apply(0.02)
    assert commands.values[0] == pytest.approx(1.06)
