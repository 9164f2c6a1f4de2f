"""Parameters of Ackermann drives in the notations of Gazebo classic and gz."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from daidalos.simulation.contracts import ComponentContext
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.plugins.diff_drive_settings import Limits
from daidalos.simulation.topics import absolute_topic, frame


@dataclass(frozen=True)
class Settings:
    """Parameters of an Ackermann drive.

    Parameters
    ----------
    left, right : tuple of str
        Driven joints on each side.
    left_steering, right_steering, steering_wheel : str
        Joints that turn; the last may be empty.
    wheel_radius : float
        [m].
    wheel_base, track : float
        Between the axles, and between the points about which the front wheels are steered [m]; zero is
        measured from the model.
    rear_track : float
        Between the driven wheels of an axle [m].
    steering_limit, speed_limit : float
        [rad], [m/s].
    steers_by_angle : bool
        The command's angular z is the steering angle, rather than the turn rate.
    steers_only : bool
        The command is a steering angle alone; nothing is driven and there is no odometry.
    truth : bool
        Odometry from the true pose instead of from the wheels.
    publish_wheels : bool
        Transforms of the wheels and of what steers them.
    distance_topic : str
        Where the way that it has driven is told; may be empty.
    """

    left: tuple[str, ...]
    right: tuple[str, ...]
    left_steering: str
    right_steering: str
    wheel_radius: float
    period: float
    command_topic: str
    odometry_topic: str
    tf_topic: str
    odometry_frame: str
    base_frame: str
    steering_wheel: str = ""
    steering_wheel_ratio: float = 1.0
    wheel_base: float = 0.0
    track: float = 0.0
    rear_track: float = 0.0
    steering_limit: float = math.inf
    linear: Limits = field(default_factory=Limits)
    steers_by_angle: bool = False
    steers_only: bool = False
    truth: bool = False
    publish_wheels: bool = False
    distance_topic: str = ""


def read_settings(parameters: PluginParameters, context: ComponentContext) -> Settings:
    """Read the parameters of an Ackermann drive.

    Raises
    ------
    AbsentPartError
        When a joint is absent or can not move.
    """
    read = _read_gz if parameters.library.startswith("gz-sim-") else _read_classic
    return read(parameters, context)


def _read_classic(parameters: PluginParameters, context: ComponentContext) -> Settings:
    element = parameters.element

    joint = parameters.require_joint
    driven = {side: (joint(f"front_{side}_joint"), joint(f"rear_{side}_joint")) for side in ("left", "right")}
    steering = element.number_of("max_steer", default=0.6)
    top = element.number_of("max_speed", default=20.0)
    rate = element.number_of("update_rate", default=100.0)
    wheel = element.text_of("steering_wheel_joint")
    tf = element.flag_of("publish_odom_tf", default=True)
    return Settings(
        left=driven["left"],
        right=driven["right"],
        left_steering=joint("left_steering_joint"),
        right_steering=joint("right_steering_joint"),
        steering_wheel=joint("steering_wheel_joint") if wheel else "",
        steering_wheel_ratio=element.number_of("max_steering_angle", default=7.85) / steering,
        wheel_radius=0.0,
        period=1.0 / rate if rate > 0 else 0.0,
        command_topic=parameters.topic(element.text_of("command_topic", default="cmd_vel")),
        odometry_topic=parameters.topic("odom") if element.flag_of("publish_odom", default=True) else "",
        tf_topic=parameters.topic("/tf") if tf else "",
        odometry_frame=frame(element.text_of("odometry_frame", default="odom")),
        base_frame=frame(element.text_of("robot_base_frame", default="base_link")),
        steering_limit=steering,
        linear=Limits(-top, top),
        steers_by_angle=True,
        truth=True,
        publish_wheels=element.flag_of("publish_wheel_tf", default=False),
        distance_topic=parameters.topic("distance") if element.flag_of("publish_distance", default=False) else "",
    )


def _read_gz(parameters: PluginParameters, context: ComponentContext) -> Settings:
    element, name = parameters.element, context.model_name

    by_actuators = element.flag_of("use_actuator_msg", default=False)
    steers_only = by_actuators or element.flag_of("steering_only", default=False)
    rate = element.number_of("odom_publish_frequency", default=50.0)
    base = next(iter(context.model.links), "base_link")
    command = element.text_of("sub_topic", default="steer_angle" if steers_only else "cmd_vel")
    default = {"topic": command, "odom_topic": "odometry", "tf_topic": "tf"}
    topics = {
        tag: absolute_topic(element.text_of(tag, default=f"/model/{name}/{word}"), context.namespace)
        for tag, word in default.items()
    }
    if by_actuators:
        context.warn(f"{element.where}: <use_actuator_msg> has no effect, angles are taken from {topics['topic']}")
    rear_track = element.number_of("wheel_separation", default=1.0)
    track = rear_track if steers_only else element.number_of("kingpin_width", default=0.8)
    return Settings(
        left=() if steers_only else parameters.require_joints("left_joint"),
        right=() if steers_only else parameters.require_joints("right_joint"),
        left_steering=parameters.require_joint("left_steering_joint"),
        right_steering=parameters.require_joint("right_steering_joint"),
        wheel_radius=element.number_of("wheel_radius", default=0.2),
        wheel_base=element.number_of("wheel_base", default=1.0),
        track=track,
        rear_track=rear_track,
        period=1.0 / rate if rate > 0 else 0.0,
        command_topic=topics["topic"],
        odometry_topic="" if steers_only else topics["odom_topic"],
        tf_topic="" if steers_only else topics["tf_topic"],
        steers_only=steers_only,
        odometry_frame=frame(element.text_of("frame_id", default=f"{name}/odom")),
        base_frame=frame(element.text_of("child_frame_id", default=f"{name}/{base}")),
        steering_limit=element.number_of("steering_limit", default=0.5),
        linear=Limits(
            element.number_of("min_velocity", default=-math.inf),
            element.number_of("max_velocity", default=math.inf),
            element.number_of("min_acceleration", default=-math.inf),
            element.number_of("max_acceleration", default=math.inf),
        ),
    )
