"""Small robots for the tests."""

from pathlib import Path

import daidalos
from daidalos.description.errors import DescriptionError

SHARE = Path(daidalos.__file__).parent / "share"


def problem_of(call):
    """Return the words of the description error that a call raises; None when it raises none."""
    try:
        call()
    except DescriptionError as problem:
        return str(problem)
    return None


def share_of(package):
    """Return the share directory of a built-in package."""
    folder = SHARE / package
    return folder if folder.is_dir() else None


ARM = """<?xml version="1.0"?>
<robot name="arm">
  <material name="blue"><color rgba="0 0 0.8 1"/></material>
  <link name="base">
    <visual><geometry><box size="1 2 3"/></geometry><material name="blue"/></visual>
    <collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision>
    <inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="upper"/>
  <link name="fore"/>
  <link name="finger"/>
  <link name="thumb"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>
    <axis xyz="0 2 0"/><limit lower="-1" upper="2" effort="10" velocity="3"/>
    <dynamics damping="0.5" friction="0.1"/>
    <safety_controller k_velocity="4" soft_lower_limit="-0.9"/>
    <calibration rising="0.2"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/><child link="fore"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="grip" type="prismatic">
    <parent link="fore"/><child link="finger"/><origin xyz="1 0.1 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/>
  </joint>
  <joint name="grip_mirror" type="prismatic">
    <parent link="fore"/><child link="thumb"/><origin xyz="1 -0.1 0"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/>
    <mimic joint="grip" multiplier="2" offset="0.01"/>
  </joint>
  <transmission name="t">
    <type>transmission_interface/SimpleTransmission</type>
    <joint name="elbow"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
    <actuator name="m"><mechanicalReduction>50</mechanicalReduction></actuator>
  </transmission>
  <gazebo reference="upper"><mu1>0.3</mu1><selfCollide>true</selfCollide></gazebo>
  <ros2_control name="c" type="system"><joint name="elbow"/></ros2_control>
</robot>
"""
