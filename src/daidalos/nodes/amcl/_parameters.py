"""Parameters of AMCL by their ROS 1 names."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter, parameters_from
from daidalos.localization.config import LASER_MODELS
from daidalos.nodes.nav2_amcl._parameters import AmclParameters

_NAMES = {
    "odom_model_type": "robot_model_type",
    "kld_err": "pf_err",
    "kld_z": "pf_z",
    "laser_lambda_short": "lambda_short",
    **{f"odom_alpha{k}": f"alpha{k}" for k in range(1, 6)},
    **{f"laser_{name}": name for name in ("max_beams", "z_hit", "z_short", "z_max", "z_rand", "sigma_hit")},
    **{
        name: name
        for name in (
            "laser_model_type", "laser_min_range", "laser_max_range", "laser_likelihood_max_dist", "do_beamskip",
            "beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold", "min_particles", "max_particles",
            "update_min_d", "update_min_a", "resample_interval", "selective_resampling", "recovery_alpha_slow",
            "recovery_alpha_fast", "transform_tolerance", "tf_broadcast", "odom_frame_id", "base_frame_id",
            "global_frame_id",
        )
    },
}  # fmt: skip
"""Nav2's names of the parameters that both nodes have."""


def _number(default: float, description: str, **constraints: object) -> float:
    """Return a parameter that a launch file may give as an integer."""
    field: float = parameter(default, description, takes_integer=True, **constraints)  # type: ignore[arg-type]
    return field


@dataclass(frozen=True)
class Ros1AmclParameters(Parameters):
    """Parameters of the node, with ROS 1's defaults."""

    odom_model_type: str = parameter(
        "diff", "Model of the odometry's noise.", choices=("diff", "omni", "diff-corrected", "omni-corrected")
    )
    odom_alpha1: float = _number(0.2, "Noise of rotation by rotation.", minimum=0.0)
    odom_alpha2: float = _number(0.2, "Noise of rotation by translation.", minimum=0.0)
    odom_alpha3: float = _number(0.2, "Noise of translation by translation.", minimum=0.0)
    odom_alpha4: float = _number(0.2, "Noise of translation by rotation.", minimum=0.0)
    odom_alpha5: float = _number(0.2, "Noise of sideways motion.", minimum=0.0)
    laser_model_type: str = parameter("likelihood_field", "Model of the scanner.", choices=LASER_MODELS)
    laser_max_beams: int = parameter(30, "Beams of a scan that are used, spread evenly.", minimum=2)
    laser_min_range: float = _number(-1.0, "Least range that is used; -1 for the scanner's own.", unit="m")
    laser_max_range: float = _number(-1.0, "Largest range that is used; -1 for the scanner's own.", unit="m")
    laser_z_hit: float = _number(0.95, "Weight of hits in the sensor model.", minimum=0.0)
    laser_z_short: float = _number(0.1, "Weight of short readings in the sensor model.", minimum=0.0)
    laser_z_max: float = _number(0.05, "Weight of largest readings in the sensor model.", minimum=0.0)
    laser_z_rand: float = _number(0.05, "Weight of random readings in the sensor model.", minimum=0.0)
    laser_sigma_hit: float = _number(0.2, "Standard deviation of hits.", unit="m", above=0.0)
    laser_lambda_short: float = _number(0.1, "Decay of short readings.", unit="1/m", minimum=0.0)
    laser_likelihood_max_dist: float = _number(
        2.0, "Distance from obstacles beyond which the likelihood field is flat.", unit="m", above=0.0
    )
    do_beamskip: bool = parameter(False, "Whether beams that most particles cannot explain are left out.")
    beam_skip_distance: float = _number(
        0.5, "Distance from an obstacle up to which the end of a beam is explained.", unit="m", minimum=0.0
    )
    beam_skip_threshold: float = _number(0.3, "Ratio of particles that have to explain a beam.", minimum=0.0)
    beam_skip_error_threshold: float = _number(
        0.9, "Ratio of beams left out from which on none is left out.", minimum=0.0
    )
    min_particles: int = parameter(100, "Least number of particles.", minimum=1)
    max_particles: int = parameter(5000, "Largest number of particles.", minimum=1)
    kld_err: float = _number(0.01, "Bound of the Kullback-Leibler distance in KLD sampling.", above=0.0)
    kld_z: float = _number(0.99, "Normal quantile with whose probability that bound holds.", above=0.0)
    update_min_d: float = _number(0.2, "Motion after which a scan is used.", unit="m", minimum=0.0)
    update_min_a: float = _number(math.pi / 6.0, "Turn after which a scan is used.", unit="rad", minimum=0.0)
    resample_interval: int = parameter(2, "Scans between two resamplings.", minimum=1)
    selective_resampling: bool = parameter(
        False, "Whether particles are resampled only when less than half of them carry the weight."
    )
    recovery_alpha_slow: float = _number(0.0, "Decay of the slow average of the weights; 0 turns recovery off.")
    recovery_alpha_fast: float = _number(0.0, "Decay of the fast average of the weights; 0 turns recovery off.")
    transform_tolerance: float = _number(
        0.1, "How far ahead of the scan the transform is stamped.", unit="s", minimum=0.0
    )
    tf_broadcast: bool = parameter(True, "Whether the transform from the map to the odometry is published.")
    odom_frame_id: str = parameter("odom", "Frame of the odometry.", not_empty=True)
    base_frame_id: str = parameter("base_link", "Frame of the robot's base.", not_empty=True)
    global_frame_id: str = parameter("map", "Frame of the map.", not_empty=True)
    use_map_topic: bool = parameter(
        False, "Whether each map of the topic is used; else the first of the topic or of the service static_map.",
        read_only=True,
    )  # fmt: skip
    first_map_only: bool = parameter(False, "Whether maps after the first are ignored.")
    gui_publish_rate: float = _number(
        -1.0, "How often the particles are published at most; -1 for each update.", unit="Hz"
    )
    save_pose_rate: float = _number(
        0.5, "How often the pose is written to the parameters of the initial pose; 0 or less for never.", unit="Hz",
        read_only=True,
    )  # fmt: skip
    initial_pose_x: float = _number(0.0, "Position at which the robot starts.", unit="m")
    initial_pose_y: float = _number(0.0, "Position at which the robot starts.", unit="m")
    initial_pose_a: float = _number(0.0, "Heading with which the robot starts.", unit="rad")
    initial_cov_xx: float = _number(0.25, "Variance of that position.", unit="m^2", minimum=0.0)
    initial_cov_yy: float = _number(0.25, "Variance of that position.", unit="m^2", minimum=0.0)
    initial_cov_aa: float = _number((math.pi / 12.0) ** 2, "Variance of that heading.", unit="rad^2", minimum=0.0)

    def check(self) -> None:
        """Refuse what Nav2's parameters refuse."""
        self.for_nav2()

    def for_nav2(self) -> AmclParameters:
        """Return the parameters by their Nav2 names."""
        values = {new: getattr(self, old) for old, new in _NAMES.items()}
        values["first_map_only"] = self.first_map_only or not self.use_map_topic
        return parameters_from(AmclParameters, values)
