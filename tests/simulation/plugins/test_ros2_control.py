"""Plugins for ros2_control without a controller manager."""

import pytest

from daidalos.description import urdf
from daidalos.simulation import Simulation
from daidalos.simulation.plugins.ros2_control import Ros2Control

ARM = """<link name='{0}_arm'>
  <inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>
  <joint name='{0}_joint' type='revolute'><parent link='base'/><child link='{0}_arm'/>
  <limit lower='-1' upper='1' effort='9' velocity='9'/></joint>
  <transmission name='{0}'><type>transmission_interface/SimpleTransmission</type><joint name='{0}_joint'>
  <hardwareInterface>hardware_interface/PositionJointInterface</hardwareInterface></joint>
  <actuator name='{0}_motor'/></transmission>"""


def dual_arm(plugins):
    """Return a robot with the arms left and right of one joint each, and plugins."""
    arms = "".join(ARM.format(side) for side in ("left", "right"))
    return urdf.parse(f"<robot name='r'><link name='base'/>{arms}{''.join(plugins)}</robot>", "r.urdf")


def plugin(namespace):
    return (
        f"\n<gazebo><plugin name='control' filename='libgazebo_ros_control.so'><robotNamespace>{namespace}"
        "</robotNamespace></plugin></gazebo>"
    )


@pytest.mark.parametrize(
    ("namespaces", "joints"),
    [
        (("left", "right"), [["left_joint"], ["right_joint"]]),
        (("/a/right", "/a/left"), [["right_joint"], ["left_joint"]]),
        (("left", "rest"), [["left_joint"], ["right_joint"]]),
        (("one", "two"), [["left_joint", "right_joint"]]),
    ],
)
def test_each_joint_has_one_of_several_plugins(namespaces, joints):
    simulation = Simulation(warn=lambda line: None)
    simulation.spawn(dual_arm(map(plugin, namespaces)))
    found = [c for c in simulation.instance("r").components if isinstance(c, Ros2Control)]
    assert [[joint.name for info in one.hardware for joint in info.joints] for one in found] == joints
    left_out = [line for line in simulation.warnings if "other plugins control all of its joints" in line]
    assert len(left_out) == len(namespaces) - len(joints)
    simulation.step(10)
