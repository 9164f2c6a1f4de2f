"""Table of samples and commands with their messages."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.common.pose3 import quaternion_from_rotation_vector
from daidalos.samples import commands, controllers, sensors, special_messages
from daidalos.samples.conversion import Conversion

TRANSFORM = Conversion(
    sensors.TransformSample,
    "geometry_msgs/TransformStamped",
    {"transform.translation": "translation", "transform.rotation": "rotation"},
)
_POSE = {"pose.position": "position", "pose.orientation": "orientation"}
_TWIST = {"twist.linear": "linear", "twist.angular": "angular"}
_WRENCH = {"wrench.force": "force", "wrench.torque": "torque"}


def _vectors(message: str, linear: str, angular: str, name: str) -> dict[str, Any]:
    """Return the sources of two vectors of a message: the halves of the sample's array (6,)."""
    return {
        f"{message}.{linear}": lambda sample: getattr(sample, name)[:3],
        f"{message}.{angular}": lambda sample: getattr(sample, name)[3:],
    }


_SENSORS = (
    Conversion(sensors.LaserScanSample, "sensor_msgs/LaserScan"),
    Conversion(sensors.PointCloudSample, "sensor_msgs/PointCloud2", to_message=special_messages.point_cloud),
    Conversion(sensors.ImageSample, "sensor_msgs/Image", to_message=special_messages.image),
    Conversion(
        sensors.CameraInfoSample,
        "sensor_msgs/CameraInfo",
        {
            "d": "distortion",
            "k": "matrix",
            "r": lambda sample: np.eye(3),
            "p": "projection",
        },
    ),
    Conversion(
        sensors.LogicalImageSample, "ros_gz_interfaces/LogicalCameraImage", {"model": special_messages.models_seen}
    ),
    Conversion(sensors.ImuSample, "sensor_msgs/Imu"),
    Conversion(
        sensors.RangeSample,
        "sensor_msgs/Range",
        {
            "radiation_type": lambda sample: 0 if sample.ultrasound else 1,  # ULTRASOUND, INFRARED
            "min_range": "range_min",
            "max_range": "range_max",
        },
    ),
    Conversion(
        sensors.NavSatSample,
        "sensor_msgs/NavSatFix",
        {
            "status": special_messages.navsat_status,
            "position_covariance": "covariance",
            "position_covariance_type": lambda sample: 2 if sample.covariance.any() else 0,  # DIAGONAL_KNOWN, UNKNOWN
        },
    ),
    Conversion(
        sensors.MagneticFieldSample,
        "sensor_msgs/MagneticField",
        {"magnetic_field": "field", "magnetic_field_covariance": "covariance"},
    ),
    Conversion(sensors.PressureSample, "sensor_msgs/FluidPressure", {"fluid_pressure": "pressure"}),
    Conversion(
        sensors.AltimeterSample,
        "ros_gz_interfaces/Altimeter",
        {"vertical_position": "position", "vertical_velocity": "velocity", "vertical_reference": "reference"},
    ),
    Conversion(sensors.WrenchSample, "geometry_msgs/WrenchStamped", _WRENCH),
    Conversion(sensors.ContactsSample, "ros_gz_interfaces/Contacts", {"contacts": special_messages.contacts}),
    Conversion(sensors.BumperSample, "gazebo_msgs/ContactsState", {"states": special_messages.contact_states}),
    Conversion(
        sensors.OdometrySample,
        "nav_msgs/Odometry",
        {f"pose.{path}": source for path, source in _POSE.items()}
        | {f"twist.{path}": source for path, source in _TWIST.items()}
        | {"pose.covariance": "pose_covariance", "twist.covariance": "twist_covariance"},
    ),
    Conversion(
        sensors.TransformSample, "tf2_msgs/TFMessage", {"transforms": lambda sample: [TRANSFORM.to_message(sample)]}
    ),
    Conversion(
        sensors.JointStateSample,
        "sensor_msgs/JointState",
        {"name": "names", "position": "positions", "velocity": "velocities", "effort": "efforts"},
    ),
    Conversion(sensors.FlagSample, "std_msgs/Bool", {"data": "value"}),
    Conversion(sensors.NumberSample, "std_msgs/Float32", {"data": "value"}),
    Conversion(sensors.TextSample, "std_msgs/String", {"data": "text"}),
    Conversion(
        sensors.BatterySample,
        "sensor_msgs/BatteryState",
        {
            "design_capacity": "capacity",
            "percentage": lambda sample: sample.charge / sample.capacity,
            "temperature": lambda sample: math.nan,
            "power_supply_status": lambda sample: 1 if sample.current > 0 else 2,  # CHARGING, DISCHARGING
            "present": lambda sample: True,
        },
    ),
    Conversion(
        sensors.WheelSlipSample,
        "gazebo_msgs/WheelSlip",
        {"name": "names", "lateral_slip": "lateral", "longitudinal_slip": "longitudinal"},
    ),
)
_COMMANDS = (
    Conversion(commands.TwistCommand, "geometry_msgs/Twist"),
    Conversion(commands.WrenchCommand, "geometry_msgs/Wrench"),
    Conversion(commands.SignalCommand, "std_msgs/Empty"),
    Conversion(commands.FlagCommand, "std_msgs/Bool", {"data": "value"}),
    Conversion(commands.NumberCommand, "std_msgs/Float64", {"data": "value"}),
    Conversion(
        commands.PositionTrajectoryCommand,
        "trajectory_msgs/JointTrajectory",
        from_message=special_messages.position_trajectory_of,
    ),
)
_CONTROLLERS = (
    Conversion(
        controllers.DynamicJointSample,
        "control_msgs/DynamicJointState",
        {
            "joint_names": "joints",
            "interface_values": lambda sample: special_messages.interface_values(sample.joints),
        },
    ),
    Conversion(
        controllers.InterfaceGroupsSample,
        "control_msgs/DynamicInterfaceGroupValues",
        {
            "interface_groups": "groups",
            "interface_values": lambda sample: special_messages.interface_values(sample.groups),
        },
    ),
    Conversion(
        controllers.InterfaceGroupsCommand,
        "control_msgs/DynamicInterfaceGroupValues",
        from_message=special_messages.interface_groups_of,
    ),
    Conversion(
        controllers.TrajectorySample,
        "control_msgs/JointTrajectoryControllerState",
        {
            "joint_names": "joints",
            "reference": lambda sample: special_messages.trajectory_point(sample.desired),
            "feedback": lambda sample: special_messages.trajectory_point(sample.actual),
            "error": lambda sample: special_messages.trajectory_point(sample.error),
            "output": lambda sample: special_messages.trajectory_point(sample.output),
            "speed_scaling_factor": "speed",
        },
    ),
    Conversion(controllers.VelocitySample, "geometry_msgs/TwistStamped", _TWIST),
    Conversion(controllers.DofSample, "control_msgs/MultiDOFStateStamped", {"dof_states": "dofs"}),
    Conversion(controllers.VariedRangeSample, "sensor_msgs/Range"),
    Conversion(controllers.PoseSample, "geometry_msgs/PoseStamped", _POSE),
    Conversion(
        controllers.SteeringSample,
        "control_msgs/SteeringControllerStatus",
        {
            "traction_wheels_position": "positions",
            "traction_wheels_velocity": "velocities",
            "steer_positions": "steering",
            "linear_velocity_command": "velocity_commands",
            "steering_angle_command": "steering_commands",
        },
    ),
    Conversion(
        controllers.MecanumSample,
        "control_msgs/MecanumDriveControllerState",
        {
            "front_left_wheel_velocity": lambda sample: float(sample.wheels[0]),
            "back_left_wheel_velocity": lambda sample: float(sample.wheels[1]),
            "back_right_wheel_velocity": lambda sample: float(sample.wheels[2]),
            "front_right_wheel_velocity": lambda sample: float(sample.wheels[3]),
            "reference_velocity.linear": lambda sample: (*sample.reference[:2].tolist(), 0.0),
            "reference_velocity.angular": lambda sample: (0.0, 0.0, float(sample.reference[2])),
        },
    ),
    Conversion(
        controllers.AdmittanceSample,
        "control_msgs/AdmittanceControllerState",
        {
            "mass.data": "mass",
            "damping.data": "damping",
            "stiffness.data": "stiffness",
            "rot_base_control": "control_orientation",
            "ref_trans_base_ft.transform.translation": "sensor_position",
            "ref_trans_base_ft.transform.rotation": "sensor_orientation",
            "selected_axes.data": lambda sample: sample.selected.astype(np.int8),
            "ft_sensor_frame.data": "sensor_frame",
            "admittance_position.transform.translation": lambda sample: sample.offset[:3],
            "admittance_position.transform.rotation": lambda sample: quaternion_from_rotation_vector(
                sample.offset[3:].tolist()
            ),
            **_vectors("admittance_acceleration.twist", "linear", "angular", "acceleration"),
            **_vectors("admittance_velocity.twist", "linear", "angular", "velocity"),
            **_vectors("wrench_base.wrench", "force", "torque", "wrench"),
            "joint_state.name": "joints",
            "joint_state.position": "joint_offset",
            "joint_state.velocity": "joint_velocity",
        },
    ),
    Conversion(controllers.VelocityCommand, "geometry_msgs/TwistStamped", _TWIST),
    Conversion(controllers.ValuesCommand, "std_msgs/Float64MultiArray", {"data": "values"}),
    Conversion(
        controllers.DofCommand,
        "control_msgs/MultiDOFCommand",
        {"dof_names": "names", "values_dot": "rates"},
    ),
    Conversion(controllers.StampedWrenchCommand, "geometry_msgs/WrenchStamped", _WRENCH),
    Conversion(controllers.SpeedCommand, "control_msgs/SpeedScalingFactor"),
    Conversion(
        controllers.TrajectoryCommand, "trajectory_msgs/JointTrajectory", from_message=special_messages.trajectory_of
    ),
    Conversion(
        controllers.TrajectoryPoint,
        "trajectory_msgs/JointTrajectoryPoint",
        to_message=special_messages.trajectory_point,
        from_message=special_messages.trajectory_point_of,
    ),
)
MESSAGES: dict[type, Conversion] = {one.kind: one for one in (*_SENSORS, *_COMMANDS, *_CONTROLLERS)}
"""The conversion of each class of samples and commands."""


def conversion_of(kind: type) -> Conversion | None:
    """Return the conversion of a class of samples or commands; None where there is none.

    A user's class may derive from one of the table, or have methods of its own: ``message_class``, which returns the
    message class and takes no argument, and ``to_message``.
    """
    if hasattr(kind, "message_class") and hasattr(kind, "to_message"):
        conversion = Conversion(kind, "", to_message=kind.to_message)
        conversion.message_class = kind.message_class()
        return conversion
    return next((MESSAGES[cls] for cls in kind.__mro__ if cls in MESSAGES), None)
