"""Parameters of the particle filter, by AMCL's names."""

import math
from dataclasses import dataclass

from daidalos.localization.errors import LocalizationError


@dataclass(frozen=True)
class AmclConfig:
    """Parameters of AMCL as Nav2 names them; SI units.

    Defaults are Nav2's, with one exception: recovery is on (`recovery_alpha_slow`, `recovery_alpha_fast`), as
    it is in ROS 1's examples, since a robot that was carried elsewhere stays lost without it.

    Attributes
    ----------
    robot_model_type : str
        `nav2_amcl::DifferentialMotionModel` or `nav2_amcl::OmniMotionModel`; `differential` and
        `omnidirectional` mean the same.
    alpha1, alpha2, alpha3, alpha4, alpha5 : float
        Noise of odometry: of rotation by rotation and by translation, of translation by translation and by
        rotation, and of sideways motion.
    laser_model_type : str
        `likelihood_field`, `likelihood_field_prob` or `beam`.
    max_beams : int
        Beams of a scan that are used, spread evenly.
    laser_min_range, laser_max_range : float
        Ranges that are used; the scanner's own limits where negative.
    z_hit, z_short, z_max, z_rand, sigma_hit, lambda_short : float
        Mixture of the sensor model (Thrun, Burgard and Fox 2005, section 6.3).
    laser_likelihood_max_dist : float
        Distance from obstacles [m] beyond which the likelihood field is flat.
    min_particles, max_particles : int
        Size of the particle set.
    pf_err, pf_z : float
        Bound of KLD sampling: the Kullback-Leibler distance to the true distribution stays below `pf_err`
        with probability `pf_z` (Fox 2003).
    update_min_d, update_min_a : float
        Motion [m], [rad] after which a scan is used.
    resample_interval : int
        Scans between two resamplings.
    recovery_alpha_slow, recovery_alpha_fast : float
        Decay of the slow and the fast average of the weights, whose ratio says how many random particles to
        add (augmented MCL, Thrun, Burgard and Fox 2005, table 8.3); 0 turns recovery off.
    """

    robot_model_type: str = "nav2_amcl::DifferentialMotionModel"
    alpha1: float = 0.2
    alpha2: float = 0.2
    alpha3: float = 0.2
    alpha4: float = 0.2
    alpha5: float = 0.2
    laser_model_type: str = "likelihood_field"
    max_beams: int = 60
    laser_min_range: float = -1.0
    laser_max_range: float = 100.0
    z_hit: float = 0.5
    z_short: float = 0.05
    z_max: float = 0.05
    z_rand: float = 0.5
    sigma_hit: float = 0.2
    lambda_short: float = 0.1
    laser_likelihood_max_dist: float = 2.0
    min_particles: int = 500
    max_particles: int = 2000
    pf_err: float = 0.05
    pf_z: float = 0.99
    update_min_d: float = 0.25
    update_min_a: float = 0.2
    resample_interval: int = 1
    recovery_alpha_slow: float = 0.001
    recovery_alpha_fast: float = 0.1

    def __post_init__(self) -> None:
        _require(1 <= self.min_particles <= self.max_particles, "min_particles must be 1 to max_particles")
        _require(self.max_beams >= 2, "max_beams must be at least 2")
        _require(self.resample_interval >= 1, "resample_interval must be at least 1")
        _require(0.0 < self.pf_z < 1.0, "pf_z must be between 0 and 1")
        _require(self.pf_err > 0.0, "pf_err must be positive")
        _require(self.sigma_hit > 0.0, "sigma_hit must be positive")
        slow, fast = self.recovery_alpha_slow, self.recovery_alpha_fast
        _require(0.0 <= slow <= fast <= 1.0, "0 <= recovery_alpha_slow <= recovery_alpha_fast <= 1 must hold")
        alphas = (self.alpha1, self.alpha2, self.alpha3, self.alpha4, self.alpha5)
        _require(all(a >= 0.0 and math.isfinite(a) for a in alphas), "alpha1 to alpha5 must not be negative")


def _require(holds: bool, rule: str) -> None:
    if not holds:
        raise LocalizationError(rule)
