"""Parameters of differential drives in the notations of Gazebo classic, ROS 2 and gz."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from daidalos.simulation.contracts import ComponentContext
from daidalos.simulation.encoder_error import EncoderError
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.topics import absolute_topic, frame


@dataclass(frozen=True)
class Limits:
    """Bounds on a velocity and its change [m/s, m/s^2] or [rad/s, rad/s^2]."""

    slowest: float = -math.inf
    fastest: float = math.inf
    deceleration: float = -math.inf
    acceleration: float = math.inf

    def apply(self, wanted: float, now: float, elapsed: float) -> float:
        """Return the limited velocity `elapsed` seconds after `now`."""
        allowed = min(max(wanted, self.slowest), self.fastest)
        return min(max(allowed, now + self.deceleration * elapsed), now + self.acceleration * elapsed)


@dataclass(frozen=True)
class Settings:
    """Parameters of a differential drive.

    Parameters
    ----------
    left, right : tuple of str
        Joints of the wheels on each side.
    separation : float
        [m].
    diameters : tuple of float
        Of all wheels, or of each pair of them [m].
    torque : float
        Of each wheel [N m].
    wheel_acceleration : float
        Largest change of a wheel's rim speed [m/s^2]; infinite for none.
    linear, angular : Limits
        On the commanded velocity.
    period : float
        Between two updates [s].
    command_topic, odometry_topic, tf_topic, joint_topic : str
        Absolute; empty for what is not published.
    odometry_frame, base_frame : str
    encoder : EncoderError
    truth : bool
        Odometry from the true pose instead of from the wheels.
    publish_wheels : bool
        Transforms of the wheels on `tf_topic`.
    covariance : tuple of 3 floats
        Variances of x, y and yaw that the odometry claims.
    """

    left: tuple[str, ...]
    right: tuple[str, ...]
    separation: float
    diameters: tuple[float, ...]
    torque: float
    period: float
    command_topic: str
    odometry_topic: str
    tf_topic: str
    joint_topic: str
    odometry_frame: str
    base_frame: str
    wheel_acceleration: float = math.inf
    linear: Limits = field(default_factory=Limits)
    angular: Limits = field(default_factory=Limits)
    encoder: EncoderError = field(default_factory=EncoderError)
    truth: bool = False
    publish_wheels: bool = False
    covariance: tuple[float, float, float] = (1e-5, 1e-5, 1e-3)


def read_settings(parameters: PluginParameters, context: ComponentContext) -> Settings:
    """Read the parameters of a differential drive.

    Raises
    ------
    DescriptionError
        When one is missing or makes no sense.
    """
    if parameters.library.startswith("gz-sim-"):
        return _read_gz(parameters, context)
    if parameters.library == "gazebo_ros_skid_steer_drive":
        return _read_skid_steer(parameters)
    return _read_classic(parameters, context)


def _read_classic(parameters: PluginParameters, context: ComponentContext) -> Settings:
    """Read the parameters of Gazebo classic's plugin, in ROS 1's or ROS 2's names."""
    element = parameters.element
    left = parameters.require_joints("leftJoint", "left_joint")
    right = parameters.require_joints("rightJoint", "right_joint")
    # ROS 1's plugin swaps the sides unless it is told that the robot is described the right way round.
    is_ros1 = element.first("leftJoint") is not None
    if is_ros1 and element.flag_of("legacyMode", default=True):
        left, right = right, left
        context.warn(f"{element.where}: <legacyMode> is on: left and right wheels are swapped")
    source = element.text_of("odometrySource", "odometry_source", default="encoder").lower()
    publishes_tf = element.flag_of("publishOdomTF", "publish_odom_tf", default=True) and element.flag_of(
        "publishTf", "publish_tf", default=True
    )
    odometry = parameters.topic(element.text_of("odometryTopic", "odometry_topic", default="odom"))
    wheel_states = element.flag_of("publishWheelJointState", "publish_wheel_joint_state", default=False)
    acceleration = element.number_of("wheelAcceleration", "max_wheel_acceleration", default=0.0)
    rate = element.number_of("updateRate", "update_rate", default=100.0)
    return Settings(
        left=left,
        right=right,
        separation=_positive(parameters, 0.34, "wheelSeparation", "wheel_separation"),
        diameters=_diameters(parameters, 0.15, len(left), len(right)),
        torque=_positive(parameters, 5.0, "wheelTorque", "torque", "max_wheel_torque"),
        period=1.0 / rate if rate > 0 else 0.0,
        command_topic=parameters.topic(element.text_of("commandTopic", "command_topic", default="cmd_vel")),
        odometry_topic=odometry if element.flag_of("publish_odom", default=True) else "",
        tf_topic=parameters.topic("/tf") if publishes_tf else "",
        joint_topic=parameters.topic("joint_states") if wheel_states else "",
        odometry_frame=frame(element.text_of("odometryFrame", "odometry_frame", default="odom")),
        base_frame=frame(element.text_of("robotBaseFrame", "robot_base_frame", default="base_footprint")),
        wheel_acceleration=acceleration if acceleration > 0 else math.inf,
        encoder=_encoder(parameters),
        truth=source in ("world", "1"),
        publish_wheels=element.flag_of("publishWheelTF", "publish_wheel_tf", default=False),
        covariance=(
            element.number_of("covariance_x", default=1e-5),
            element.number_of("covariance_y", default=1e-5),
            element.number_of("covariance_yaw", default=1e-3),
        ),
    )


def _read_skid_steer(parameters: PluginParameters) -> Settings:
    """Read the parameters of ROS 1's skid steer drive, whose odometry is the true pose because its wheels slip."""
    element = parameters.element
    joints = {
        place: parameters.require_joint(f"{place}Joint", default=f"{words}_joint")
        for place, words in (
            *(("leftFront", "left_front"), ("leftRear", "left_rear")),
            *(("rightFront", "right_front"), ("rightRear", "right_rear")),
        )
    }
    rate = element.number_of("updateRate", default=100.0)
    publishes_tf = element.flag_of("broadcastTF", default=True)
    return Settings(
        left=(joints["leftFront"], joints["leftRear"]),
        right=(joints["rightFront"], joints["rightRear"]),
        separation=_positive(parameters, 0.4, "wheelSeparation"),
        diameters=(_positive(parameters, 0.15, "wheelDiameter"),),
        torque=_positive(parameters, 5.0, "torque"),
        period=1.0 / rate if rate > 0 else 0.0,
        command_topic=parameters.topic(element.text_of("commandTopic", default="cmd_vel")),
        odometry_topic=parameters.topic(element.text_of("odometryTopic", default="odom")),
        tf_topic=parameters.topic("/tf") if publishes_tf else "",
        joint_topic="",
        odometry_frame=frame(element.text_of("odometryFrame", default="odom")),
        base_frame=frame(element.text_of("robotBaseFrame", default="base_footprint")),
        truth=True,
        covariance=(
            element.number_of("covariance_x", default=1e-4),
            element.number_of("covariance_y", default=1e-4),
            element.number_of("covariance_yaw", default=1e-2),
        ),
    )


def _read_gz(parameters: PluginParameters, context: ComponentContext) -> Settings:
    """Read the parameters of gz's system."""
    element, name = parameters.element, context.model_name
    left = parameters.require_joints("left_joint")
    right = parameters.require_joints("right_joint")
    rate = element.number_of("odom_publish_frequency", default=50.0)
    base = next(iter(context.model.links), "base_link")
    default = {"topic": "cmd_vel", "odom_topic": "odometry", "tf_topic": "tf"}
    topics = {
        tag: absolute_topic(element.text_of(tag, default=f"/model/{name}/{word}"), context.namespace)
        for tag, word in default.items()
    }
    return Settings(
        left=left,
        right=right,
        separation=_positive(parameters, 1.0, "wheel_separation"),
        diameters=(2 * _positive(parameters, 0.2, "wheel_radius"),),
        torque=math.inf,
        period=1.0 / rate if rate > 0 else 0.0,
        command_topic=topics["topic"],
        odometry_topic=topics["odom_topic"],
        tf_topic=topics["tf_topic"],
        joint_topic="",
        odometry_frame=frame(element.text_of("frame_id", default=f"{name}/odom")),
        base_frame=frame(element.text_of("child_frame_id", default=f"{name}/{base}")),
        linear=_limits(parameters, "linear_"),
        angular=_limits(parameters, "angular_"),
        encoder=_encoder(parameters),
    )


def _limits(parameters: PluginParameters, kind: str) -> Limits:
    """Read limits; those without ``linear`` or ``angular`` in their name apply to both."""
    element = parameters.element

    def number(bound: str, what: str, default: float) -> float:
        return element.number_of(f"{bound}_{kind}{what}", f"{bound}_{what}", default=default)

    return Limits(
        slowest=number("min", "velocity", -math.inf),
        fastest=number("max", "velocity", math.inf),
        deceleration=number("min", "acceleration", -math.inf),
        acceleration=number("max", "acceleration", math.inf),
    )


def _encoder(parameters: PluginParameters) -> EncoderError:
    element = parameters.element
    noise = element.number_of("encoderNoise", "encoder_noise", default=0.0)
    if noise < 0:
        raise element.error("<encoderNoise> should not be negative")
    return EncoderError(noise, element.number_of("encoderSlip", "encoder_slip", default=0.0))


def _diameters(parameters: PluginParameters, default: float, *wheels: int) -> tuple[float, ...]:
    """Read the diameter of all wheels, or one for each pair, as in ROS 2's plugin."""
    first = _positive(parameters, default, "wheelDiameter", "wheel_diameter")
    diameters = tuple(child.number() for child in parameters.element.all("wheelDiameter", "wheel_diameter"))
    if len(set(diameters)) < 2:
        return (first,)
    if min(diameters) <= 0 or any(count != len(diameters) for count in wheels):
        raise parameters.element.error("expected one <wheel_diameter>, or one above zero for each pair of wheels")
    return diameters


def _positive(parameters: PluginParameters, default: float, *tags: str) -> float:
    value = parameters.element.number_of(*tags, default=default)
    if value <= 0:
        raise parameters.element.error(f"<{tags[-1]}> should be positive, got {value:g}")
    return value
