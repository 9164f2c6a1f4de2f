"""One table: what controllers say and take, and the messages, services and actions for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.common.pose3 import quaternion_from_rotation_vector
from daidalos.nodes.controller_manager import _gripper_messages, _trajectory_messages
from daidalos.nodes.controller_manager._entries import ActionEntry, ServiceEntry
from daidalos.nodes.controller_manager._trajectory_messages import (
    trajectory_command,
    trajectory_point_command,
    trajectory_state,
)
from daidalos.nodes.conversions import nanoseconds
from daidalos.nodes.gazebo_ros._conversion import Incoming, Outgoing, header, named, quaternion, vector
from daidalos.nodes.gazebo_ros._messages import INCOMING as SIMULATED_INCOMING
from daidalos.nodes.gazebo_ros._messages import OUTGOING as SIMULATED_OUTGOING
from daidalos.samples import controllers as samples


def _dynamic_joint_state(sample: samples.DynamicJointSample) -> Any:
    from control_msgs.msg import DynamicJointState, InterfaceValue

    return DynamicJointState(
        header=header(sample),
        joint_names=list(sample.joints),
        interface_values=[
            InterfaceValue(interface_names=list(values), values=list(values.values()))
            for values in sample.joints.values()
        ],
    )


def _twist(linear: Any, angular: Any) -> Any:
    from geometry_msgs.msg import Twist

    return Twist(linear=vector(linear), angular=vector(angular))


def _twist_stamped(sample: samples.VelocitySample) -> Any:
    from geometry_msgs.msg import TwistStamped

    return TwistStamped(header=header(sample), twist=_twist(sample.linear, sample.angular))


def _velocity(message: Any) -> samples.VelocityCommand:
    linear, angular = message.twist.linear, message.twist.angular
    return samples.VelocityCommand(
        np.array([linear.x, linear.y, linear.z]),
        np.array([angular.x, angular.y, angular.z]),
        nanoseconds(message.header.stamp),
    )


def _values(message: Any) -> samples.ValuesCommand:
    return samples.ValuesCommand(np.array(message.data, dtype=np.float64))


def _dof_command(message: Any) -> samples.DofCommand:
    values, rates = (np.array(one, dtype=np.float64) for one in (message.values, message.values_dot))
    return samples.DofCommand(tuple(message.dof_names), values, rates)


def _dof_states(sample: samples.DofSample) -> Any:
    from control_msgs.msg import MultiDOFStateStamped, SingleDOFState

    states = [
        SingleDOFState(
            name=one.name,
            reference=one.reference,
            feedback=one.feedback,
            feedback_dot=one.feedback_rate,
            error=one.error,
            error_dot=one.error_rate,
            time_step=one.period,
            output=one.output,
        )
        for one in sample.dofs
    ]
    return MultiDOFStateStamped(header=header(sample), dof_states=states)


def _range(sample: samples.VariedRangeSample) -> Any:
    from sensor_msgs.msg import Range

    return Range(
        header=header(sample),
        radiation_type=sample.radiation_type,
        field_of_view=sample.field_of_view,
        min_range=sample.min_range,
        max_range=sample.max_range,
        range=sample.range,
        variance=sample.variance,
    )


def _pose(sample: samples.PoseSample) -> Any:
    from geometry_msgs.msg import Point, Pose, PoseStamped

    x, y, z = sample.position.tolist()
    pose = Pose(position=Point(x=x, y=y, z=z), orientation=quaternion(sample.orientation))
    return PoseStamped(header=header(sample), pose=pose)


def _steering(sample: samples.SteeringSample) -> Any:
    from control_msgs.msg import SteeringControllerStatus

    return SteeringControllerStatus(
        header=header(sample),
        traction_wheels_position=sample.positions,
        traction_wheels_velocity=sample.velocities,
        steer_positions=sample.steering,
        linear_velocity_command=sample.velocity_commands,
        steering_angle_command=sample.steering_commands,
    )


def _mecanum(sample: samples.MecanumSample) -> Any:
    from control_msgs.msg import MecanumDriveControllerState

    front_left, rear_left, rear_right, front_right = sample.wheels.tolist()
    x, y, turn = sample.reference
    return MecanumDriveControllerState(
        header=header(sample),
        front_left_wheel_velocity=front_left,
        back_left_wheel_velocity=rear_left,
        back_right_wheel_velocity=rear_right,
        front_right_wheel_velocity=front_right,
        reference_velocity=_twist(np.array((x, y, 0.0)), np.array((0.0, 0.0, turn))),
    )


def _admittance(sample: samples.AdmittanceSample) -> Any:
    from control_msgs.msg import AdmittanceControllerState
    from geometry_msgs.msg import Transform, TransformStamped, TwistStamped, Wrench, WrenchStamped
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float64MultiArray, Int8MultiArray, String

    def transform(position: Any, orientation: Any) -> Any:
        moved = Transform(translation=vector(position), rotation=quaternion(orientation))
        return TransformStamped(header=header(sample), transform=moved)

    def twist(values: Any) -> Any:
        return TwistStamped(header=header(sample), twist=_twist(values[:3], values[3:]))

    wrench = Wrench(force=vector(sample.wrench[:3]), torque=vector(sample.wrench[3:]))
    return AdmittanceControllerState(
        mass=Float64MultiArray(data=sample.mass),
        damping=Float64MultiArray(data=sample.damping),
        stiffness=Float64MultiArray(data=sample.stiffness),
        rot_base_control=quaternion(sample.control_orientation),
        ref_trans_base_ft=transform(sample.sensor_position, sample.sensor_orientation),
        selected_axes=Int8MultiArray(data=sample.selected.astype(np.int8)),
        ft_sensor_frame=String(data=sample.sensor_frame),
        admittance_position=transform(
            sample.offset[:3], np.array(quaternion_from_rotation_vector(sample.offset[3:].tolist()))
        ),
        admittance_acceleration=twist(sample.acceleration),
        admittance_velocity=twist(sample.velocity),
        wrench_base=WrenchStamped(header=header(sample), wrench=wrench),
        joint_state=JointState(
            header=header(sample),
            name=list(sample.joints),
            position=sample.joint_offset,
            velocity=sample.joint_velocity,
        ),
    )


def _wrench_command(message: Any) -> samples.StampedWrenchCommand:
    force, torque = message.wrench.force, message.wrench.torque
    return samples.StampedWrenchCommand(
        np.array([force.x, force.y, force.z]), np.array([torque.x, torque.y, torque.z]), message.header.frame_id
    )


def _set_bool() -> Any:
    from std_srvs.srv import SetBool

    return SetBool


def _trigger() -> Any:
    from std_srvs.srv import Trigger

    return Trigger


def _fill_answer(response: Any, answer: samples.Answer) -> Any:
    response.success, response.message = answer.success, answer.text
    return response


def _speed(message: Any) -> samples.SpeedCommand:
    return samples.SpeedCommand(float(message.factor))


OUTGOING: dict[type, Outgoing] = {
    **SIMULATED_OUTGOING,
    samples.DynamicJointSample: Outgoing(named("control_msgs", "DynamicJointState"), _dynamic_joint_state),
    samples.TrajectorySample: Outgoing(named("control_msgs", "JointTrajectoryControllerState"), trajectory_state),
    samples.VelocitySample: Outgoing(named("geometry_msgs", "TwistStamped"), _twist_stamped),
    samples.DofSample: Outgoing(named("control_msgs", "MultiDOFStateStamped"), _dof_states),
    samples.VariedRangeSample: Outgoing(named("sensor_msgs", "Range"), _range),
    samples.PoseSample: Outgoing(named("geometry_msgs", "PoseStamped"), _pose),
    samples.SteeringSample: Outgoing(named("control_msgs", "SteeringControllerStatus"), _steering),
    samples.MecanumSample: Outgoing(named("control_msgs", "MecanumDriveControllerState"), _mecanum),
    samples.AdmittanceSample: Outgoing(named("control_msgs", "AdmittanceControllerState"), _admittance),
}
INCOMING: dict[type, Incoming] = {
    **SIMULATED_INCOMING,
    samples.VelocityCommand: Incoming(named("geometry_msgs", "TwistStamped"), _velocity),
    samples.ValuesCommand: Incoming(named("std_msgs", "Float64MultiArray"), _values),
    samples.DofCommand: Incoming(named("control_msgs", "MultiDOFCommand"), _dof_command),
    samples.StampedWrenchCommand: Incoming(named("geometry_msgs", "WrenchStamped"), _wrench_command),
    samples.SpeedCommand: Incoming(named("control_msgs", "SpeedScalingFactor"), _speed),
    samples.TrajectoryCommand: Incoming(named("trajectory_msgs", "JointTrajectory"), trajectory_command),
    samples.TrajectoryPoint: Incoming(named("trajectory_msgs", "JointTrajectoryPoint"), trajectory_point_command),
}
SERVICES: dict[type, ServiceEntry] = {
    samples.TrajectoryStateRequest: _trajectory_messages.SERVICE,
    samples.Switched: ServiceEntry(_set_bool, lambda request: samples.Switched(request.data), _fill_answer),
    samples.Asked: ServiceEntry(_trigger, lambda request: samples.Asked(), _fill_answer),
}
ACTIONS: dict[type, ActionEntry] = {
    samples.TrajectoryRequest: _trajectory_messages.ACTION,
    samples.GripperRequest: _gripper_messages.SINGLE,
    samples.ParallelGripperRequest: _gripper_messages.PARALLEL,
}
