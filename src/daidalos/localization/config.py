"""Parameters of the particle filter, by AMCL's names."""

from dataclasses import dataclass

from daidalos.common.parameters import ParameterError, Parameters, parameter

MOTION_MODELS = (
    "nav2_amcl::DifferentialMotionModel", "nav2_amcl::OmniMotionModel", "differential", "omnidirectional",
    "diff-corrected", "omni-corrected", "diff", "omni",
)  # fmt: skip
"""Nav2's names, those of its first releases, and ROS 1's; the last two are ROS 1's models with larger noise."""
LASER_MODELS = ("likelihood_field", "likelihood_field_prob", "beam")


@dataclass(frozen=True)
class AmclConfig(Parameters):
    """Parameters of AMCL as Nav2 names them.

    Defaults are Nav2's, with one exception: recovery is on (`recovery_alpha_slow`, `recovery_alpha_fast`), as
    it is in ROS 1's examples, since a robot that was carried elsewhere stays lost without it. The last three are
    ours.

    The mixture of the sensor model is that of Thrun, Burgard and Fox 2005, section 6.3; recovery is augmented MCL,
    table 8.3; KLD sampling is that of Fox 2003.
    """

    robot_model_type: str = parameter(
        "nav2_amcl::DifferentialMotionModel", "Model of the odometry's noise.", choices=MOTION_MODELS
    )
    alpha1: float = parameter(0.2, "Noise of rotation by rotation.", minimum=0.0)
    alpha2: float = parameter(0.2, "Noise of rotation by translation.", minimum=0.0)
    alpha3: float = parameter(0.2, "Noise of translation by translation.", minimum=0.0)
    alpha4: float = parameter(0.2, "Noise of translation by rotation.", minimum=0.0)
    alpha5: float = parameter(0.2, "Noise of sideways motion.", minimum=0.0)
    laser_model_type: str = parameter("likelihood_field", "Model of the scanner.", choices=LASER_MODELS)
    max_beams: int = parameter(60, "Beams of a scan that are used, spread evenly.", minimum=2)
    laser_min_range: float = parameter(-1.0, "Least range that is used; negative for the scanner's own.", unit="m")
    laser_max_range: float = parameter(100.0, "Largest range that is used; negative for the scanner's own.", unit="m")
    z_hit: float = parameter(0.5, "Weight of hits in the sensor model.", minimum=0.0)
    z_short: float = parameter(0.05, "Weight of short readings in the sensor model.", minimum=0.0)
    z_max: float = parameter(0.05, "Weight of largest readings in the sensor model.", minimum=0.0)
    z_rand: float = parameter(0.5, "Weight of random readings in the sensor model.", minimum=0.0)
    sigma_hit: float = parameter(0.2, "Standard deviation of hits.", unit="m", above=0.0)
    lambda_short: float = parameter(0.1, "Decay of short readings.", unit="1/m", minimum=0.0)
    laser_likelihood_max_dist: float = parameter(
        2.0, "Distance from obstacles beyond which the likelihood field is flat.", unit="m", above=0.0
    )
    do_beamskip: bool = parameter(
        False, "Whether likelihood_field_prob leaves out beams that most particles cannot explain."
    )
    beam_skip_distance: float = parameter(
        0.5, "Distance from an obstacle up to which the end of a beam is explained.", unit="m", minimum=0.0
    )
    beam_skip_threshold: float = parameter(
        0.3, "Ratio of particles that have to explain a beam.", minimum=0.0, maximum=1.0
    )
    beam_skip_error_threshold: float = parameter(
        0.9, "Ratio of beams left out from which on none is left out.", minimum=0.0, maximum=1.0
    )
    min_particles: int = parameter(500, "Least number of particles.", minimum=1)
    max_particles: int = parameter(2000, "Largest number of particles.", minimum=1)
    pf_err: float = parameter(
        0.05, "Bound of the Kullback-Leibler distance to the true distribution in KLD sampling.", above=0.0
    )
    pf_z: float = parameter(
        0.99, "Quantile of the standard normal distribution with whose probability that bound holds.", above=0.0
    )
    update_min_d: float = parameter(0.25, "Motion after which a scan is used.", unit="m", minimum=0.0)
    update_min_a: float = parameter(0.2, "Turn after which a scan is used.", unit="rad", minimum=0.0)
    resample_interval: int = parameter(1, "Scans between two resamplings.", minimum=1)
    selective_resampling: bool = parameter(
        False, "Whether particles are resampled only when less than half of them carry the weight, as in ROS 1."
    )
    recovery_alpha_slow: float = parameter(
        0.001, "Decay of the slow average of the weights; 0 turns recovery off.", minimum=0.0, maximum=1.0
    )
    recovery_alpha_fast: float = parameter(
        0.1, "Decay of the fast average of the weights; 0 turns recovery off.", minimum=0.0, maximum=1.0
    )
    freespace_downsampling: bool = parameter(
        False, "Whether random particles are drawn in every second row and column of cells only."
    )
    random_seed: int = parameter(-1, "Seed of the random numbers; negative for another one each time.")
    refine_pose: bool = parameter(
        True, "Whether the pose is the likeliest one near the mean of the particles rather than the mean."
    )
    updates_after_initial_pose: int = parameter(
        5, "Scans that are used after an initial pose even if the robot stands.", minimum=1
    )

    def check(self) -> None:
        """Refuse numbers of particles and decays in the wrong order."""
        if self.min_particles > self.max_particles:
            raise ParameterError("min_particles", "is above max_particles")
        if self.recovery_alpha_slow > self.recovery_alpha_fast:
            raise ParameterError("recovery_alpha_slow", "is above recovery_alpha_fast")
