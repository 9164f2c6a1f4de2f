"""Parameters of the filters by robot_localization's names."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.localization.filters.model import SIZE
from daidalos.nodes.parameters import declare_one, location_of

if TYPE_CHECKING:
    from rclpy.node import Node

_NOISE = (0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04, 0.01, 0.01, 0.02, 0.01, 0.01, 0.015)
_NEVER = math.inf
_INPUT = re.compile(r"(odom|pose|twist|imu)\d+")


@dataclass(frozen=True)
class FilterParameters(Parameters):
    """Parameters of the nodes, beside those of their inputs."""

    frequency: float = parameter(30.0, "How often the state is published.", unit="Hz", above=0.0)
    sensor_timeout: float = parameter(
        math.nan, "Time without measurements after which the state is predicted; a cycle where unset.",
        unit="s", minimum=0.0,
    )  # fmt: skip
    two_d_mode: bool = parameter(False, "Whether height, roll, pitch and their changes are zero.")
    map_frame: str = parameter("map", "Frame of the map.", not_empty=True)
    odom_frame: str = parameter("odom", "Frame of the odometry.", not_empty=True)
    base_link_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True)
    base_link_output_frame: str = parameter("", "Name of the base in what is published; base_link_frame where empty.")
    world_frame: str = parameter("", "Frame of the state: map_frame or odom_frame, which it is where empty.")
    publish_tf: bool = parameter(True, "Whether the transform to the base, or from the map to odom, is published.")
    publish_acceleration: bool = parameter(False, "Whether the acceleration is published.")
    permit_corrected_publication: bool = parameter(
        False, "Whether a state is published again after a late measurement corrected it."
    )
    predict_to_current_time: bool = parameter(False, "Whether each published state is predicted to the present.")
    transform_time_offset: float = parameter(0.0, "Added to the stamps of published transforms.", unit="s")
    gravitational_acceleration: float = parameter(9.80665, "Acceleration of a body that falls.", unit="m/s^2")
    disabled_at_startup: bool = parameter(False, "Whether the filter waits for the service enable.")
    initial_state: tuple[float, ...] = parameter((0.0,) * SIZE, "State before the first measurement.", length=SIZE)
    process_noise_covariance: tuple[float, ...] = parameter(
        _NOISE, "Covariance that a second adds: 225 elements, or 15 variances."
    )
    initial_estimate_covariance: tuple[float, ...] = parameter(
        (1e-9,) * SIZE, "Covariance of the initial state: 225 elements, or 15 variances."
    )
    dynamic_process_noise_covariance: bool = parameter(
        False, "Whether the noise of the pose grows with the speed, and is zero for a robot that stands."
    )
    smooth_lagged_data: bool = parameter(
        False, "Whether a late measurement is taken in at its time, and those after it again."
    )
    history_length: float = parameter(0.0, "How late such a measurement may be.", unit="s", minimum=0.0)
    use_control: bool = parameter(False, "Whether velocities on cmd_vel move the prediction.")
    stamped_control: bool = parameter(False, "Whether cmd_vel is TwistStamped instead of Twist.")
    control_timeout: float = parameter(
        0.0, "Age from which a command counts as zero; 0 for never.", unit="s", minimum=0.0
    )
    control_config: tuple[bool, ...] = parameter((False,) * 6, "Which of the six velocities are commanded.", length=6)
    acceleration_limits: tuple[float, ...] = parameter(
        (1.0,) * 6, "Limits of the accelerations.", unit="m/s^2, rad/s^2", minimum=0.0, length=6
    )
    deceleration_limits: tuple[float, ...] = parameter(
        (1.0,) * 6, "Limits of slowing down.", unit="m/s^2, rad/s^2", minimum=0.0, length=6
    )
    acceleration_gains: tuple[float, ...] = parameter(
        (1.0,) * 6, "Acceleration per missing velocity.", unit="1/s", minimum=0.0, length=6
    )
    deceleration_gains: tuple[float, ...] = parameter(
        (1.0,) * 6, "Deceleration per surplus velocity.", unit="1/s", minimum=0.0, length=6
    )

    def check(self) -> None:
        """Refuse frames that do not fit together."""
        if len({self.map_frame, self.odom_frame, self.base_link_frame}) < 3:
            raise ParameterError("base_link_frame", "must differ from odom_frame, and both from map_frame")
        if self.world_frame not in ("", self.map_frame, self.odom_frame):
            allowed = f"map_frame '{self.map_frame}' or odom_frame '{self.odom_frame}'"
            raise ParameterError("world_frame", f"must be {allowed}, got '{self.world_frame}'")

    @property
    def world(self) -> str:
        """Frame of the state."""
        return self.world_frame or self.odom_frame


@dataclass(frozen=True)
class Input:
    """Settings of a topic with measurements.

    Attributes
    ----------
    name, kind, topic : str
        Such as ``odom0``, ``odom`` and ``wheels/odom``.
    uses : ndarray of bool, shape (15,)
        Which variables are measured.
    is_differential, is_relative : bool
        Whether poses are turned into velocities, or taken relative to the first one.
    queue_size : int
    pose_threshold, twist_threshold, acceleration_threshold : float
        Mahalanobis distances beyond which a measurement is rejected.
    uses_child_frame : bool
        Whether the pose is that of the message's child frame instead of the base.
    removes_gravity : bool
    """

    name: str
    kind: str
    topic: str
    uses: NDArray[np.bool_]
    is_differential: bool
    is_relative: bool
    queue_size: int
    pose_threshold: float
    twist_threshold: float
    acceleration_threshold: float
    uses_child_frame: bool
    removes_gravity: bool


def declare_inputs(node: Node) -> list[Input]:
    """Declare the parameters of the inputs that are given to a node, such as ``odom0`` and ``odom0_config``.

    Raises
    ------
    ParameterError
        When a value is not allowed, or there are no inputs.
    """
    names = sorted(name for name in node._parameter_overrides if _INPUT.fullmatch(name))
    if not names:
        raise ParameterError("odom0", "is missing: the filter needs at least one odomN, poseN, twistN or imuN")
    return [_declare_input(node, name) for name in names]


def _declare_input(node: Node, name: str) -> Input:
    kind = name.rstrip("0123456789")

    def threshold(what: str) -> float:
        description = "Mahalanobis distance beyond which a measurement is rejected."
        return declare_one(
            node, f"{name}_{what}rejection_threshold", _NEVER, description, above=0.0, takes_integer=True
        )

    has_pose, has_both = kind != "twist", kind in ("odom", "imu")
    pose = threshold("pose_" if has_both else "") if has_pose else _NEVER
    return Input(
        name,
        kind,
        declare_one(node, name, "", "Topic of the measurements.", not_empty=True),
        _declare_uses(node, name),
        has_pose and declare_one(node, f"{name}_differential", False, "Whether poses are turned into velocities."),
        has_pose and declare_one(node, f"{name}_relative", False, "Whether poses are relative to the first one."),
        declare_one(node, f"{name}_queue_size", 10, "How many messages may wait.", minimum=1),
        pose,
        threshold("twist_" if has_both else "") if kind != "pose" else _NEVER,
        threshold("linear_acceleration_") if kind == "imu" else _NEVER,
        kind == "odom"
        and declare_one(node, f"{name}_pose_use_child_frame", False, "Whether the pose is the child frame's."),
        kind == "imu"
        and declare_one(
            node, f"{name}_remove_gravitational_acceleration", False, "Whether gravity is part of the acceleration."
        ),
    )


def _declare_uses(node: Node, name: str) -> NDArray[np.bool_]:
    """Return which variables a topic measures, from its parameter ``_config``."""
    config = f"{name}_config"
    given = node.declare_parameter(config, [False] * SIZE).value
    if len(given) != SIZE:
        where = location_of(node, config)
        raise ParameterError(config, f"must have {SIZE} booleans, got {len(given)}", where)
    return np.array(given, dtype=bool)


WITHOUT_EFFECT = {
    "print_diagnostics": "what is wrong with measurements is in the log",
    "debug": "there is no debug file",
    "debug_out_file": "there is no debug file",
    "tf_prefix": "frames have their whole names",
    "transform_timeout": "transforms are not waited for; the newest counts where that of the time is missing",
    "reset_on_time_jump": "time that goes back always resets the filter",
}
"""Parameters that do nothing here, with the reason."""
