"""What `<ros2_control>` elements say."""

import math

import pytest

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.joint import Mimic
from daidalos.description.ros2_control import HardwareInfo, read_hardware

ROBOT = """<robot name="arm">
<link name="base"/><link name="upper"/><link name="lower"/><link name="left"/><link name="right"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
  <limit lower="-1" upper="2" effort="5" velocity="3"/></joint>
<joint name="finger" type="prismatic"><parent link="lower"/><child link="left"/>
  <limit lower="0" upper="0.04" effort="5" velocity="1"/></joint>
<joint name="other_finger" type="prismatic"><parent link="lower"/><child link="right"/>
  <limit lower="0" upper="0.04" effort="5" velocity="1"/><mimic joint="finger" multiplier="-1" offset="0.01"/></joint>
{}
</robot>"""
SYSTEM = """<ros2_control name="arm_system" type="system" rw_rate="50" is_async="true">
<hardware><plugin>mock_components/GenericSystem</plugin><param name="mock_sensor_commands">true</param></hardware>
{}
</ros2_control>"""


def read(text: str) -> tuple[HardwareInfo, ...]:
    return read_hardware(urdf.parse(ROBOT.format(text)))


def components(text: str) -> HardwareInfo:
    return read(SYSTEM.format(text))[0]


def test_hardware_with_joints_sensors_gpios_and_transmissions() -> None:
    info = components("""
      <joint name="elbow">
        <command_interface name="position"><param name="min">-0.5</param><param name="max">0.5</param>
          <param name="initial_value">0.1</param></command_interface>
        <command_interface name="velocity"/>
        <state_interface name="position"><param name="initial_value">0.25</param></state_interface>
        <state_interface name="velocity"/>
        <param name="calibration">7</param>
      </joint>
      <sensor name="wrist"><state_interface name="force.x"/><param name="frame_id">tool</param></sensor>
      <gpio name="valve"><command_interface name="open" data_type="bool"><param name="initial_value">true</param>
        </command_interface><state_interface name="open" data_type="bool"/></gpio>
      <transmission name="t1"><plugin>transmission_interface/SimpleTransmission</plugin>
        <joint name="elbow" role="joint1"><mechanical_reduction>2.5</mechanical_reduction></joint>
        <actuator name="motor" role="actuator1"/></transmission>""")
    assert (info.name, info.type, info.plugin) == ("arm_system", "system", "mock_components/GenericSystem")
    assert info.parameters == {"mock_sensor_commands": "true"}
    assert info.location.line == 1 + ROBOT.partition("{}")[0].count("\n")
    assert (info.rw_rate, info.is_async) == (50.0, True)
    assert info.command_names == ("elbow/position", "elbow/velocity", "valve/open")
    assert info.state_names == ("elbow/position", "elbow/velocity", "wrist/force.x", "valve/open")
    elbow = info.joints[0]
    assert elbow.parameters == {"calibration": "7"}
    assert (elbow.commands[0].lower, elbow.commands[0].upper, elbow.commands[0].initial_value) == (-0.5, 0.5, 0.1)
    assert elbow.states[0].initial_value == 0.25
    assert math.isnan(elbow.states[1].initial_value)
    assert elbow.commands[1].upper == math.inf
    assert elbow.joint is not None
    assert elbow.joint.axis.velocity == 3.0
    assert info.sensors[0].parameters == {"frame_id": "tool"}
    assert (info.gpios[0].commands[0].data_type, info.gpios[0].commands[0].initial_value) == ("bool", 1.0)
    assert info.transmissions[0].joints == {"elbow": 2.5}
    assert info.transmissions[0].actuators == {"motor": 1.0}


@pytest.mark.parametrize(
    ("joint", "expected"),
    [
        ('<joint name="other_finger"/>', Mimic("finger", -1.0, 0.01)),
        ('<joint name="other_finger" mimic="true"/>', Mimic("finger", -1.0, 0.01)),
        ('<joint name="other_finger" mimic="false"/>', None),
        (
            '<joint name="other_finger"><param name="mimic">elbow</param><param name="multiplier">2</param></joint>',
            Mimic("elbow", 2.0, 0.0),
        ),
        ('<joint name="finger"/>', None),
    ],
)
def test_mimic_is_said_in_three_ways(joint: str, expected: Mimic | None) -> None:
    assert components(joint).joints[0].mimic == expected


def test_limits_can_be_lifted() -> None:
    info = components("""<joint name="elbow"><limits enable="false"/></joint>
      <joint name="finger"><command_interface name="position"><limits enable="false"/></command_interface></joint>""")
    assert not info.joints[0].limited
    assert info.joints[1].limited
    assert not info.joints[1].commands[0].limited


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (SYSTEM.format('<joint name="knee"/>'), "the robot has no joint 'knee'; known are shoulder, elbow"),
        (SYSTEM.format('<joint name="finger" mimic="true"/>'), "joint has no <mimic>"),
        (
            SYSTEM.format('<joint name="elbow"><command_interface name="a"/><command_interface name="a"/></joint>'),
            "command interface 'elbow/a' is there twice",
        ),
        (
            SYSTEM.format(
                '<joint name="elbow"><command_interface name="a"><param name="min">1</param>'
                '<param name="max">0</param></command_interface></joint>'
            ),
            "minimum 1 is above its maximum 0",
        ),
        (
            SYSTEM.format(
                '<joint name="elbow"><state_interface name="a"><param name="initial_value">x</param>'
                "</state_interface></joint>"
            ),
            "'initial_value' should be a number, got 'x'",
        ),
        ('<ros2_control name="a" type="thing"><hardware/></ros2_control>', "one of system, actuator, sensor"),
        ('<ros2_control name="a" type="system"><hardware/></ros2_control>', "<plugin> is missing"),
        (2 * SYSTEM.format(""), "the name 'arm_system' is taken"),
        (
            '<ros2_control name="a" type="sensor"><hardware><plugin>p</plugin></hardware>'
            '<sensor name="s"><command_interface name="x"/></sensor></ros2_control>',
            "takes no commands, got 's/x'",
        ),
    ],
)
def test_errors_name_the_line(text: str, message: str) -> None:
    with pytest.raises(DescriptionError, match=rf"robot_description:\d+.*{message}"):
        read(text)
