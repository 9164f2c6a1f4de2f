"""Matches of a scan against scans nearby: from a prediction of odometry, or from a rough guess of the place."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.config import SlamConfig
from daidalos.mapping.odometry import Drift
from daidalos.mapping.scan import Cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window
from daidalos.mapping.scan_matching.point_to_line import Refinement, match_information

CERTAIN_INLIER_RATIO = 0.8
"""Part of the points on lines from which a match near the prediction needs no search."""

NO_MATCH_INLIER_RATIO = 0.1
"""Part of the points on lines below which a scan fits nowhere in the window, and a larger one is searched."""

EXPANSION = 3.0
"""How many times as large the window is that is searched where nothing in the first one fits."""

GUESS_WINDOWS = ((1.0, 0.6), (4.0, np.pi))
"""Half widths [m], [rad] of the windows around a guess of the place, tried in turn."""

PLACE_INLIER_RATIO = 0.6
"""Part of the points on lines from which a place is taken for found."""


@dataclass(frozen=True)
class ScanMatch:
    """Pose of a scan and how well it is known.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) in the frame of the map.
    information : ndarray, shape (3, 3)
        Inverse covariance in the frame of the scan that the match alone gives; zero where none was accepted.
    accepted : bool
        Whether the scan fits; otherwise the pose is the prediction.
    turned : float
        Heading [rad] of the prediction relative to where the scan alone fits best.
    """

    pose: Array
    information: Array
    accepted: bool
    turned: float = 0.0


def match_scan(
    local: PointMap,
    cloud: Cloud,
    predicted: Array,
    drift: Drift,
    certainty: Array,
    config: SlamConfig,
    *,
    thorough: bool,
) -> ScanMatch:
    """Match a scan against scans nearby.

    Parameters
    ----------
    local : PointMap
        The scans nearby.
    cloud : Cloud
        The scan.
    predicted : ndarray, shape (3,)
        Pose by odometry since the last match.
    drift : Drift
        Motion since then; the window that is searched covers what odometry may have erred in it.
    certainty : ndarray, shape (3, 3)
        Inverse covariance of that motion.
    config : SlamConfig
        Windows and thresholds.
    thorough : bool
        Whether to search even where the scan fits at the prediction.
    """
    if not config.use_scan_matching:
        return _unmatched(predicted)
    if not thorough:
        near = local.refine(cloud.points, cloud.normals, predicted, iterations=15)
        if near.inlier_ratio > CERTAIN_INLIER_RATIO:
            return _fused(predicted, certainty, near)
    fine = _searched(local, cloud, predicted, _window(drift, config))
    if fine.inlier_ratio < NO_MATCH_INLIER_RATIO and config.use_response_expansion:
        fine = _searched(local, cloud, predicted, _window(drift, config, EXPANSION))
        if fine.inlier_ratio < PLACE_INLIER_RATIO:
            return _unmatched(predicted)
    if fine.inlier_ratio < config.link_match_minimum_response_fine:
        return _unmatched(predicted)
    return _fused(predicted, certainty, fine)


def _searched(local: PointMap, cloud: Cloud, predicted: Array, window: Window) -> Refinement:
    found = local.correlate(cloud.points, predicted, window)
    return local.refine(cloud.points, cloud.normals, predicted if found is None else found.pose)


def find_pose(local: PointMap, cloud: Cloud, guess: Array) -> ScanMatch:
    """Find a scan among others around a rough guess of its pose, such as a person's."""
    for distance, angle in GUESS_WINDOWS:
        window = Window(distance, angle, resolution=0.1, deviation=0.1, distance_penalty=0.01, angle_penalty=0.01)
        found = local.correlate(cloud.points, guess, window)
        if found is None:
            continue
        fine = local.refine(cloud.points, cloud.normals, found.pose)
        if fine.inlier_ratio >= PLACE_INLIER_RATIO:
            return ScanMatch(fine.pose, match_information(fine.normal_matrix), accepted=True)
    return _unmatched(guess)


def nearest_scans(pose: Array, poses: Array, count: int, reach: float) -> NDArray[np.intp]:
    """Return the indices of the poses (n, 3) within reach that are nearest to one, in position and heading."""
    distance = np.hypot(poses[:, 0] - pose[0], poses[:, 1] - pose[1])
    apart = distance + 0.5 * np.abs(pose2.wrap(poses[:, 2] - pose[2]))
    nearest = np.argsort(apart, kind="stable")[:count]
    within: NDArray[np.intp] = np.sort(nearest[distance[nearest] <= reach])
    return within


def view_centres(clouds: Sequence[Cloud], poses: Array, *, barycenter: bool) -> Array:
    """Return where scans count as being (n, 2): the middles of their points, or where they were taken."""
    if not barycenter:
        return poses[:, :2]
    middles = np.array([cloud.points.mean(axis=0) for cloud in clouds]).reshape(-1, 2)
    cosine, sine = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    x = poses[:, 0] + cosine * middles[:, 0] - sine * middles[:, 1]
    return np.stack([x, poses[:, 1] + sine * middles[:, 0] + cosine * middles[:, 1]], axis=1)


def _window(drift: Drift, config: SlamConfig, size: float = 1.0) -> Window:
    """Return the window of a search; a penalty that is meant for a small one must not outweigh a large error."""
    least_distance, least_angle = 0.5 * config.correlation_search_space_dimension, config.coarse_search_angle_offset
    error, turn = drift.largest_error
    distance, angle = size * max(least_distance, error), min(np.pi, size * max(least_angle, turn))
    return Window(
        distance,
        angle,
        distance_penalty=0.2 / config.distance_variance_penalty**2 * (least_distance / distance) ** 2,
        angle_penalty=0.2 / config.angle_variance_penalty**2 * (least_angle / angle) ** 2,
    )


def _unmatched(predicted: Array) -> ScanMatch:
    return ScanMatch(predicted, np.zeros((3, 3)), accepted=False)


def _fused(predicted: Array, certainty: Array, match: Refinement) -> ScanMatch:
    """Fuse a match with odometry, which constrains directions that lines do not, such as along a corridor."""
    information = match_information(match.normal_matrix)
    gap = pose2.between(match.pose, predicted)
    shift = np.linalg.solve(information + certainty, certainty @ gap)
    return ScanMatch(pose2.compose(match.pose, shift), information, accepted=True, turned=float(gap[2]))
