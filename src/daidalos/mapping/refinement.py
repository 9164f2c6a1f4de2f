"""Global refinement: match all pairs of key scans that see the same walls, then solve all poses at once."""

from collections.abc import Sequence

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.pose_graph import Edge, optimize
from daidalos.mapping.scan import Cloud
from daidalos.mapping.scan_matching.buckets import build_reference
from daidalos.mapping.scan_matching.point_to_line import match_information, refine

BACK = 3
"""Scans before each one that it is matched against in any case."""

NEIGHBOURS = 4
"""Earlier scans nearby that a scan is matched against; more of them change nothing that can be measured."""

VIEW_DISTANCE = 2.0
VIEW_ANGLE = 1.6
"""How far [m] the middles of what two scans see may be apart, and their headings [rad]."""

REACH = 0.3
"""Largest distance [m] over which a point looks for its line."""

MIN_INLIER_RATIO = 0.4
MAX_RESIDUAL = 0.045
"""Part of a pair's points that must match, and their largest rms distance [m] from the lines."""

CHAIN_WEIGHT = 0.01
"""Weight of the edges that the scans came with: they hold together what no pair ties, and bend little."""


def refine_poses(clouds: Sequence[Cloud], poses: Array, edges: Sequence[Edge], odometry: Sequence[Edge] = ()) -> Array:
    """Match overlapping pairs of key scans point to line and solve for all poses (after Lu, Milios 1997).

    Parameters
    ----------
    clouds : sequence of Cloud
        The key scans.
    poses : ndarray, shape (n, 3)
        Their poses, with loops closed.
    edges : sequence of Edge
        The pose graph that they come from.
    odometry : sequence of Edge
        Motions by odometry, which hold the headings along corridors where few walls are seen.
    """
    references = [build_reference(cloud.points, cloud.normals, REACH) for cloud in clouds]
    matched = [
        Edge(edge.first, edge.second, edge.measurement, CHAIN_WEIGHT * edge.information)
        for edge in edges
        if not edge.closure
    ]
    matched.extend(odometry)
    for first, second in _pairs(clouds, poses):
        cloud = clouds[second]
        guess = pose2.between(poses[first], poses[second])
        fine = refine(cloud.points, cloud.normals, references[first], guess, reach=0.15, iterations=6)
        if fine.inlier_ratio < MIN_INLIER_RATIO or fine.residual > MAX_RESIDUAL:
            continue
        information = match_information(fine.inlier_ratio * fine.normal_matrix)
        matched.append(Edge(first, second, fine.pose, information, closure=second > first + BACK))
    return optimize(poses, matched).poses


def _pairs(clouds: Sequence[Cloud], poses: Array) -> list[tuple[int, int]]:
    """Find scans in a row, and for each scan the nearest earlier ones by the middles of what they see."""
    from scipy.spatial import cKDTree

    middles = np.array(
        [
            pose2.transform_points(pose, cloud.points.mean(axis=0, keepdims=True))[0]
            for cloud, pose in zip(clouds, poses, strict=True)
        ]
    )
    pairs = {(k - back, k) for k in range(len(clouds)) for back in range(1, BACK + 1) if k >= back}
    near = cKDTree(middles).query_ball_point(middles, VIEW_DISTANCE)
    for k, found in enumerate(near):
        others = np.array([j for j in found if j < k - BACK], dtype=np.int64)
        others = others[np.abs(pose2.wrap(poses[others, 2] - poses[k, 2])) < VIEW_ANGLE]
        order = np.argsort(np.hypot(*(middles[others] - middles[k]).T), kind="stable")
        pairs.update((int(j), k) for j in others[order[:NEIGHBOURS]])
    return sorted(pairs)
