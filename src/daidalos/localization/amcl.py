"""AMCL: adaptive Monte Carlo localization in a known map."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import between, compose, inverse, wrap
from daidalos.localization.agreement import LostDetector, agreement_of
from daidalos.localization.config import AmclConfig
from daidalos.localization.errors import LocalizationError
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.localization.motion_models.differential import DifferentialMotionModel
from daidalos.localization.motion_models.motion_model import MotionModel
from daidalos.localization.motion_models.omnidirectional import OmniMotionModel
from daidalos.localization.particles import (
    count_bins,
    heaviest_cluster,
    kld_bound,
    low_variance_indices,
    mean_and_covariance,
    second_moments,
)
from daidalos.localization.refinement import refined
from daidalos.localization.sensor_models.beam import BeamModel
from daidalos.localization.sensor_models.likelihood_field import (
    LikelihoodFieldModel,
    LikelihoodFieldProbModel,
)
from daidalos.localization.sensor_models.sensor_model import Beams, SensorModel
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData

_DIFFERENTIAL = ("nav2_amcl::DifferentialMotionModel", "differential", "diff-corrected")
_OMNIDIRECTIONAL = ("nav2_amcl::OmniMotionModel", "omnidirectional", "omni-corrected")
SENSOR_MODELS: dict[str, type[LikelihoodFieldModel] | type[LikelihoodFieldProbModel] | type[BeamModel]] = {
    "likelihood_field": LikelihoodFieldModel,
    "likelihood_field_prob": LikelihoodFieldProbModel,
    "beam": BeamModel,
}
DEFAULT_COVARIANCE = np.diag([0.25, 0.25, (math.pi / 12.0) ** 2])
"""Spread of the first particles where no initial pose is given."""


ROUGHENING = np.array([0.02, 0.02, 0.01])
"""Noise [m, m, rad] of the particles while scans are used although the robot stands, so that they stay distinct."""


@dataclass(frozen=True)
class Estimate:
    """Pose estimate of the filter.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) of the base in the map.
    covariance : ndarray, shape (3, 3)
        Mean squares of all particles' distances from that pose, at the last scan that was used.
    particles : ndarray, shape (n, 3)
        All poses that are thought possible, at the last scan that was used.
    weights : ndarray, shape (n,)
        Their weights; they sum up to 1.
    map_to_odom : ndarray, shape (3,)
        Pose of odometry's frame in the map.
    updated : bool
        Whether the scan was used, rather than odometry alone.
    lost : bool
        Whether scans agreed with the map at the pose, and the last ones do not; see `LostDetector`.
    """

    pose: Array
    covariance: Array
    particles: Array
    weights: Array
    map_to_odom: Array
    updated: bool
    lost: bool = False


class Amcl:
    """A particle filter over the poses in a map.

    Particles move with odometry, are weighed by scans and drawn anew by their weights; as many as KLD
    sampling asks for. When scans fit worse than they did, random particles are added until the robot is found
    again.

    Parameters
    ----------
    config : AmclConfig
        Parameters.
    grid : OccupancyGrid
        The map.
    seed : int or None
        Of the random numbers; the parameter ``random_seed`` where None.

    Raises
    ------
    LocalizationError
        The map cannot be used.
    """

    def __init__(self, config: AmclConfig, grid: OccupancyGrid, seed: int | None = None) -> None:
        if seed is None and config.random_seed >= 0:
            seed = config.random_seed
        self._generator = np.random.default_rng(seed)
        self.config = config
        self._grid = grid
        self._lost = LostDetector()
        self._use(config)
        self._particles: Array = np.zeros((1, 3))
        self._weights: Array = np.ones(1)
        self._odom: Array = np.zeros(3)
        self._anchored = False
        self._map_to_odom: Array = np.zeros(3)
        self.initialize(np.zeros(3), DEFAULT_COVARIANCE)

    def reconfigure(self, config: AmclConfig) -> None:
        """Continue with other parameters, and with the particles that there are."""
        self._use(config)

    def set_map(self, grid: OccupancyGrid) -> None:
        """Continue in another map of the same frame.

        A pose that agreed with the last map is judged by the next scans in this one.

        Raises
        ------
        LocalizationError
            The map cannot be used; the last one stays.
        """
        self._world = _likelihood_map(self.config, grid)
        self._grid = grid

    def contains(self, position: Array) -> bool:
        """Return whether a position (x, y) lies on the map."""
        return self._world.contains(position)

    def initialize(self, pose: Array, covariance: Array) -> None:
        """Draw the particles around a pose.

        Parameters
        ----------
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) in the map.
        covariance : ndarray, shape (3, 3)
            How sure that is; of a matrix that is none, the nearest that is one is taken.

        Raises
        ------
        LocalizationError
            Either is not finite.
        """
        if not (np.isfinite(pose).all() and np.isfinite(covariance).all()):
            raise LocalizationError("an initial pose and its covariance must be finite")
        count = self.config.max_particles
        variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
        scaled = axes * np.sqrt(np.maximum(variances, 0.0))
        drawn = pose + self._generator.standard_normal((count, 3)) @ scaled.T
        drawn[:, 2] = wrap(drawn[:, 2])
        self._begin(drawn)
        self._settling = self.config.updates_after_initial_pose

    def global_localization(self) -> None:
        """Draw the particles anywhere in the free space of the map."""
        self._begin(self._world.draw_poses(self.config.max_particles, self._generator))

    def request_nomotion_update(self) -> None:
        """Use the next scan even if the robot has not moved."""
        self._forced = True

    def update(self, odom_pose: Array, scan: LaserScanData, *, odometry_jumped: bool = False) -> Estimate:
        """Update the particles with a scan and the odometry pose at its time.

        Parameters
        ----------
        odom_pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the base in odometry's frame.
        scan : LaserScanData
            The scan, with the pose of its sensor.
        odometry_jumped : bool
            Whether odometry moved as no robot can. Half of the particles follow, as when a simulated robot was
            moved, half stay, as when odometry began anew; the scan decides.

        Returns
        -------
        Estimate
            Pose in the map; from odometry alone while the robot has hardly moved.
        """
        if not self._anchored:
            self._anchored = True
            self._odom = odom_pose.copy()
            self._map_to_odom = compose(self._mean, inverse(odom_pose))
        beams = Beams.of_scan(scan, self.config)
        moved = self._moved(odom_pose)
        due = (moved or self._forced or self._settling > 0) and beams.ranges.size > 0
        if due:
            self._use_beams(odom_pose, beams, moved=moved, odometry_jumped=odometry_jumped)
        agreement = agreement_of(compose(self._map_to_odom, odom_pose), beams, self._world)
        if agreement is not None:
            self._lost.add(agreement)
        return self._estimate(odom_pose, updated=due)

    def _use_beams(self, odom_pose: Array, beams: Beams, *, moved: bool, odometry_jumped: bool) -> None:
        self._move(odom_pose, odometry_jumped)
        if self._settling and not moved:
            self._particles += ROUGHENING * self._generator.standard_normal(self._particles.shape)
        self._forced = False
        self._settling = max(self._settling - 1, 0)
        self._weigh(beams)
        self._look_closely(odom_pose, beams)

    def _move(self, odom_pose: Array, odometry_jumped: bool) -> None:
        """Move the particles as odometry did since they last moved."""
        if odometry_jumped:
            # Moved as a whole: with each particle's own heading, a jump over metres would scatter them.
            there = compose(self._map_to_odom, odom_pose)
            followed = compose(compose(there, inverse(compose(self._map_to_odom, self._odom))), self._particles)
            follows = np.less(self._generator.random(followed.shape[0]), 0.5)
            self._particles = np.where(follows.reshape(-1, 1), followed, self._particles)
            self._settling = self.config.updates_after_initial_pose
        else:
            self._particles = self._motion.sample(self._particles, self._odom, odom_pose, self._generator)
        self._odom = odom_pose.copy()

    def _use(self, config: AmclConfig) -> None:
        self._world = _likelihood_map(config, self._grid)
        self._motion: MotionModel = _motion_model(config)
        self._sensor: SensorModel = SENSOR_MODELS[config.laser_model_type](config)
        self.config = config

    def _begin(self, particles: Array) -> None:
        self._particles = particles
        self._weights = np.full(particles.shape[0], 1.0 / particles.shape[0])
        self._anchored = False
        self._forced = False
        self._settling = 1
        self._scans = 0
        self._slow = self._fast = 0.0
        self._lost.reset()
        self._mean, self._covariance = mean_and_covariance(particles, self._weights)
        self._map_to_odom = np.zeros(3)

    def _moved(self, odom_pose: Array) -> bool:
        step = between(self._odom, odom_pose)
        far = math.hypot(float(step[0]), float(step[1])) >= self.config.update_min_d
        return far or abs(float(step[2])) >= self.config.update_min_a

    def _weigh(self, beams: Beams) -> None:
        """Weight the particles by a scan, and resample them when it is due."""
        likelihoods = self._sensor.likelihoods(self._particles, beams, self._world)
        weights = self._weights * likelihoods
        average = float(weights.sum())
        if average > 0.0:
            self._weights = weights / average
        else:
            self._weights = np.full(weights.size, 1.0 / weights.size)
        self._follow_average(average)
        self._scans += 1
        effective = 1.0 / float(self._weights @ self._weights)
        if self._scans % self.config.resample_interval == 0 and (
            not self.config.selective_resampling or effective < 0.5 * self._weights.size
        ):
            self._resample()

    def _follow_average(self, average: float) -> None:
        """Update the two averages of the likelihood, whose ratio detects a lost robot."""
        if self._slow == 0.0:
            self._slow = self._fast = average
            return
        self._slow += self.config.recovery_alpha_slow * (average - self._slow)
        self._fast += self.config.recovery_alpha_fast * (average - self._fast)

    def _resample(self) -> None:
        c = self.config
        lost = self._share_of_random()
        most = low_variance_indices(self._weights, c.max_particles, self._generator.random())
        covered = count_bins(self._particles, most) + round(lost * c.max_particles)
        count = min(max(kld_bound(covered, c.pf_err, c.pf_z), c.min_particles), c.max_particles)
        chosen = low_variance_indices(self._weights, count, self._generator.random())
        drawn = self._particles[chosen]
        strangers = self._generator.random(count) < lost if lost > 0.0 else np.zeros(0, np.bool_)
        if strangers.any():
            drawn[strangers] = self._world.draw_poses(int(strangers.sum()), self._generator)
        self._particles = drawn
        self._weights = np.full(count, 1.0 / count)

    def _share_of_random(self) -> float:
        """Return the ratio of random particles: how far the fast average has fallen below the slow one."""
        if self.config.recovery_alpha_slow == 0.0 or self._slow <= 0.0:
            return 0.0
        return max(0.0, 1.0 - self._fast / self._slow)

    def _look_closely(self, odom_pose: Array, beams: Beams) -> None:
        """Set the pose estimate to the heaviest cluster, or to the likeliest pose within it."""
        members = heaviest_cluster(self._particles, self._weights)
        self._mean, spread = mean_and_covariance(self._particles[members], self._weights[members])
        if self.config.refine_pose:
            self._mean = refined(self._mean, spread, beams, self._world, self.config)
        self._covariance = second_moments(self._particles, self._weights, self._mean)
        self._map_to_odom = compose(self._mean, inverse(odom_pose))

    def _estimate(self, odom_pose: Array, *, updated: bool) -> Estimate:
        return Estimate(
            compose(self._map_to_odom, odom_pose),
            self._covariance.copy(),
            self._particles.copy(),
            self._weights.copy(),
            self._map_to_odom.copy(),
            updated,
            self._lost.is_lost,
        )


def _likelihood_map(config: AmclConfig, grid: OccupancyGrid) -> LikelihoodMap:
    return LikelihoodMap(grid, config.laser_likelihood_max_dist, downsampled=config.freespace_downsampling)


def _motion_model(config: AmclConfig) -> MotionModel:
    """Return the model that ``robot_model_type`` names; ROS 1's two without correction are the last ones."""
    name = config.robot_model_type
    if name in _DIFFERENTIAL or name == "diff":
        return DifferentialMotionModel(config, corrected=name in _DIFFERENTIAL)
    return OmniMotionModel(config, corrected=name in _OMNIDIRECTIONAL)
