"""Hardware that is not there."""

import numpy as np
import pytest
from control_robots import arm

from daidalos.control.errors import HardwareError
from daidalos.control.hardware.generic import GenericSystem
from daidalos.description import urdf
from daidalos.description.ros2_control import read_hardware

ALL = "".join(
    f'<{kind}_interface name="{name}"/>'
    for kind in ("command", "state")
    for name in ("position", "velocity", "acceleration")
)


def system(text: str = "", extra: str = "") -> GenericSystem:
    one = GenericSystem(read_hardware(arm(extra=extra, parameters=text))[0])
    one.configure()
    return one


def dynamic() -> GenericSystem:
    robot = urdf.parse(f"""<robot name="r"><link name="a"/><link name="b"/>
      <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
      <ros2_control name="h" type="system"><hardware><plugin>p</plugin>
      <param name="calculate_dynamics">true</param></hardware><joint name="j">{ALL}</joint></ros2_control></robot>""")
    one = GenericSystem(read_hardware(robot)[0])
    one.configure()
    return one


def test_states_start_at_rest_and_follow_commands() -> None:
    one = system()
    assert not one.states.values.any()
    one.commands["elbow/position"] = 0.7
    one.read(0, 0.01)
    assert one.states["elbow/position"] == 0.7
    assert one.states["elbow/velocity"] == 0.0


def test_initial_values_are_where_it_starts() -> None:
    valve = """<gpio name="valve"><command_interface name="flow"><param name="initial_value">0.3</param>
      </command_interface><state_interface name="flow"/></gpio>
      <sensor name="s"><state_interface name="x"><param name="initial_value">4</param></state_interface>
      <state_interface name="y"/></sensor>"""
    one = system(extra=valve)
    assert one.states["valve/flow"] == one.commands["valve/flow"] == 0.3
    assert one.states["s/x"] == 4.0
    assert np.isnan(one.states["s/y"])


def test_positions_can_be_kept_off() -> None:
    one = system('<param name="position_state_following_offset">-0.1</param>')
    one.commands["elbow/position"] = 0.7
    one.read(0, 0.01)
    assert one.states["elbow/position"] == pytest.approx(0.6)


def test_commands_can_be_ignored() -> None:
    one = system('<param name="disable_commands">true</param>')
    one.commands["elbow/position"] = 0.7
    one.read(0, 0.01)
    assert one.states["elbow/position"] == 0.0


def test_sensors_can_have_commands() -> None:
    sensor = '<sensor name="s"><state_interface name="x"/></sensor>'
    assert "s/x" not in system(extra=sensor).commands
    one = system('<param name="mock_sensor_commands">true</param>', sensor)
    one.commands["s/x"] = 3.0
    one.read(0, 0.01)
    assert one.states["s/x"] == 3.0


def test_followers_follow() -> None:
    robot = urdf.parse("""<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
      <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
      <joint name="k" type="continuous"><parent link="a"/><child link="c"/>
        <mimic joint="j" multiplier="-2" offset="0.5"/></joint>
      <ros2_control name="h" type="system"><hardware><plugin>p</plugin></hardware>
      <joint name="j"><command_interface name="position"/><state_interface name="position"/>
        <state_interface name="velocity"/></joint>
      <joint name="k"><state_interface name="position"/><state_interface name="velocity"/></joint>
      </ros2_control></robot>""")
    one = GenericSystem(read_hardware(robot)[0])
    one.configure()
    assert one.states["k/position"] == 0.5
    one.commands["j/position"] = 1.0
    one.read(0, 0.01)
    assert one.states["k/position"] == -1.5


@pytest.mark.parametrize(
    ("mode", "command", "expected"),
    [("position", 0.2, (0.2, 0.0, 0.0)), ("velocity", 0.2, (0.2, 0.2, 0.0)), ("acceleration", 0.2, (0.1, 0.2, 0.2))],
)
def test_dynamics_derive_what_is_not_commanded(mode: str, command: float, expected: tuple[float, ...]) -> None:
    one = dynamic()
    one.switch([f"j/{mode}"], [])
    one.commands[f"j/{mode}"] = command
    for step in range(1000):
        one.read(step * 1_000_000, 0.001)
    assert one.states.values == pytest.approx(expected, abs=1.1e-3)


def test_wrong_parameters_name_their_line() -> None:
    with pytest.raises(HardwareError, match=r":\d+.*'calculate_dynamics' should be true or false, got 'maybe'"):
        system('<param name="calculate_dynamics">maybe</param>')
    with pytest.raises(HardwareError, match="should be a number, got 'x'"):
        system('<param name="position_state_following_offset">x</param>')
