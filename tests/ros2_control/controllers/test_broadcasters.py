"""Broadcasters say what the hardware says."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, arm, cycle, from_values, manager

from daidalos.common.parameters import ParameterError
from daidalos.common.pose3 import Pose
from daidalos.control.contracts import ControllerContext
from daidalos.description import urdf
from daidalos.samples.controllers import DynamicJointSample
from daidalos.samples.sensors import JointStateSample, TransformSample

STATES = ("elbow/position", "elbow/velocity", "wrist/position", "wrist/torque", "gauge/pressure")


def broadcast(**values: Any) -> tuple[Any, Any]:
    controller, _, states = alone(
        "joint_state_broadcaster/JointStateBroadcaster", arm(), {"state_names": STATES}, **values
    )
    states.values[:] = np.arange(1.0, len(states.names) + 1)
    said = cycle(controller, 5)
    dynamic = next((one for one in said if isinstance(one, DynamicJointSample)), None)
    return next(one for one in said if isinstance(one, JointStateSample)), dynamic


def test_joint_states_have_joints_with_what_is_known() -> None:
    joints, dynamic = broadcast()
    assert (joints.topic, joints.stamp_ns, joints.frame_id) == ("joint_states", 5, "base_link")
    assert joints.names == ("elbow", "wrist")
    assert joints.positions == pytest.approx([1.0, 3.0])
    assert joints.velocities == pytest.approx([2.0, math.nan], nan_ok=True)
    assert np.isnan(joints.efforts).all()
    assert dynamic.joints["gauge"] == {"pressure": 5.0}
    assert dynamic.joints["wrist"] == {"position": 3.0, "torque": 4.0}


def test_joints_and_interfaces_can_be_chosen() -> None:
    joints, _ = broadcast(joints=["wrist", "elbow"], interfaces=["position"])
    assert joints.names == ("wrist", "elbow")
    assert joints.positions == pytest.approx([1.0, 2.0])


def test_extra_joints_are_at_zero() -> None:
    joints, dynamic = broadcast(extra_joints=["lid"])
    assert joints.names == ("elbow", "wrist", "lid")
    for column in (joints.positions, joints.velocities, joints.efforts):
        assert column[2] == 0.0
    assert dynamic.joints["lid"] == {"position": 0.0, "velocity": 0.0, "effort": 0.0}


def test_fields_can_come_from_other_interfaces() -> None:
    joints, _ = broadcast(map_interface_to_joint_state={"effort": "torque"})
    assert joints.efforts == pytest.approx([math.nan, 4.0], nan_ok=True)


def test_topics_can_be_its_own_and_dynamic_states_left_out() -> None:
    joints, dynamic = broadcast(use_local_topics=True, publish_dynamic_joint_states=False)
    assert joints.topic == "~/joint_states"
    assert dynamic is None


def test_nobody_listens_nothing_is_said() -> None:
    context = {"state_names": STATES, "has_subscribers": lambda topic: False}
    controller, _, _ = alone("joint_state_broadcaster/JointStateBroadcaster", arm(), context)
    assert cycle(controller, 5) == []


def test_imu() -> None:
    controller, _, states = alone(
        "imu_sensor_broadcaster/IMUSensorBroadcaster",
        sensor_name="body",
        frame_id="imu_link",
        static_covariance_orientation=[float(k) for k in range(9)],
        rotation_offset={"yaw": 0.5},
    )
    assert states.names[0] == "body/orientation.x"
    states.values[:] = [0.0, 0.0, math.sin(0.1), math.cos(0.1), 1, 2, 3, 4, 5, 6]
    sample = cycle(controller, 7)[0]
    assert (sample.topic, sample.frame_id, sample.stamp_ns) == ("~/imu", "imu_link", 7)
    assert sample.orientation == pytest.approx(Pose.from_xyz_rpy((0, 0, 0), (0, 0, 0.7)).orientation)
    assert sample.angular_velocity == pytest.approx([1, 2, 3])
    assert sample.linear_acceleration == pytest.approx([4, 5, 6])
    assert sample.orientation_covariance == pytest.approx(range(9))


def test_force_torque() -> None:
    type_name = "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"
    controller, _, states = alone(
        type_name,
        sensor_name="wrist",
        frame_id="tool",
        offset={"force": {"x": 1.0}},
        multiplier={"torque": {"z": -2.0}},
    )
    states.values[:] = [1, 2, 3, 4, 5, 6]
    sample = cycle(controller, 7)[0]
    assert sample.topic == "~/wrench"
    assert sample.force == pytest.approx([2, 2, 3])
    assert sample.torque == pytest.approx([4, 5, -12])
    assert controller.exported["torque.z"] == -12
    names = {"force": {"z": "scale/weight"}}
    controller, _, states = alone(type_name, interface_names=names, frame_id="tool")
    assert states.names == ("scale/weight",)
    states.values[:] = 9.0
    assert cycle(controller, 7)[0].force == pytest.approx([math.nan, math.nan, 9.0], nan_ok=True)
    for wrong in ({}, {"sensor_name": "wrist", "interface_names": names}):
        with pytest.raises(ParameterError, match="'sensor_name' or interface_names must be given, and not both"):
            alone(type_name, frame_id="tool", **wrong)


def test_range() -> None:
    controller, _, states = alone(
        "range_sensor_broadcaster/RangeSensorBroadcaster", sensor_name="sonar", frame_id="nose", max_range=3.0
    )
    states["sonar/range"] = 1.25
    sample = cycle(controller, 7)[0]
    assert (sample.range, sample.max_range, sample.radiation_type) == (1.25, 3.0, 1)


def test_pose() -> None:
    controller, _, states = alone(
        "pose_broadcaster/PoseBroadcaster", pose_name="tracker", frame_id="map", tf={"publish_rate": 50.0}
    )
    states.values[:] = [1, 2, 3, 0, 0, 0, 1]
    said = [one for step in range(10) for one in cycle(controller, (step + 1) * 10_000_000)]
    transforms = [one for one in said if isinstance(one, TransformSample)]
    assert (len(said), len(transforms)) == (15, 5)
    assert (transforms[0].frame_id, transforms[0].child_frame_id) == ("map", "tracker")
    assert said[0].position == pytest.approx([1, 2, 3])
    states.values[6] = 0.0
    assert len(cycle(controller, 500_000_000)) == 1


def test_all_states_are_those_of_hardware_that_is_configured_at_the_activation() -> None:
    parts = "".join(
        f"""<link name="{name}_link"/><joint name="{name}" type="continuous"><parent link="base"/>
          <child link="{name}_link"/></joint><ros2_control name="{name}" type="system"><hardware>
          <plugin>mock_components/GenericSystem</plugin></hardware><joint name="{name}">
          <state_interface name="position"/></joint></ros2_control>"""
        for name in ("a", "b")
    )
    robot = urdf.parse(f'<robot name="r"><link name="base"/>{parts}</robot>')
    control = manager(robot, initial_states={"b": "unconfigured"})
    name, values = "states", from_values(publish_dynamic_joint_states=False)
    control.load(name, "joint_state_broadcaster/JointStateBroadcaster", values, ControllerContext(name))
    control.configure(name)
    control.switch([name])
    assert [sample.names for _, sample in control.update(PERIOD_NS)] == [("a",)]
    control.set_component_state("b", "active")
    control.switch((), [name])
    control.switch([name])
    assert [sample.names for _, sample in control.update(2 * PERIOD_NS)] == [("a", "b")]
    control.set_component_state("b", "unconfigured")
    assert control.controllers[name].state == "inactive"
