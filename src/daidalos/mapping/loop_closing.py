"""Loop closing: matches of the newest key scan with key scans made long before."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.config import SlamConfig
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.scan import Cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window, merge
from daidalos.mapping.scan_matching.point_to_line import match_information
from daidalos.mapping.tracking import view_centres

DRIFT_PER_METRE = 0.03
DRIFT_PER_RADIAN = 0.03
DRIFT_OF_CLOSURE = 0.02
"""How far [m] a pose may be off after a metre or a radian of matched motion, and across a closure."""

SETTLED_DRIFT = 0.08
"""Drift [m] below which two scans are tied together well enough and no closure is looked for."""

QUERY_SCANS = 4
"""Latest key scans that are matched together: they show more of a place than one does."""

CHAIN_REACH = 10
"""Key scans before and after the closest one of a chain that make up its map."""

CHAIN_GAP = 3
"""Largest step between the indices of key scans of one chain."""

RETRY_INTERVAL = 3
"""Key scans to wait before a chain that was tried is tried again."""

RESOLUTION = 0.1
"""Step [m] of the search, and standard deviation [m] of a point in it."""

MAX_SEARCH_ANGLE = 0.5
"""Largest half width [rad] of the search."""

MIN_LIKELIHOOD = 0.6
"""Mean likelihood of the points, from 0 to 1, that a place must reach to be looked at more closely."""

MIN_INLIER_RATIO = 0.7
"""Part of the points that must lie on lines of the old scans for a closure to be believed."""

MAX_RESIDUAL = 0.03
"""Largest rms distance [m] from those lines."""


class LoopCloser:
    """Detector of loop closures of the newest key scan.

    Parameters
    ----------
    config : SlamConfig
        How far to look.
    """

    def __init__(self, config: SlamConfig) -> None:
        self.config = config
        self._tried: list[tuple[int, int]] = []

    def search(self, clouds: Sequence[Cloud], poses: Array, edges: Sequence[Edge]) -> list[Edge]:
        """Find closures between the newest key scan and chains of earlier ones.

        Parameters
        ----------
        clouds : sequence of Cloud
            All the key scans.
        poses : ndarray, shape (n, 3)
            Their poses.
        edges : sequence of Edge
            The pose graph so far; it tells how far two scans may have drifted apart.
        """
        config = self.config
        newest = poses.shape[0] - 1
        centres = view_centres(clouds, poses, barycenter=config.use_scan_barycenter)
        old = max(0, newest - max(config.scan_buffer_size, QUERY_SCANS))
        distance = np.hypot(centres[:old, 0] - centres[newest, 0], centres[:old, 1] - centres[newest, 1])
        near = np.flatnonzero(distance < config.loop_search_maximum_distance)
        if near.shape[0] == 0:
            return []
        drift = possible_drift(newest, poses, edges)
        near = near[drift[near] > SETTLED_DRIFT]
        self._tried = [(scan, place) for scan, place in self._tried if newest - scan < RETRY_INTERVAL]
        closures = []
        for chain in np.split(near, np.flatnonzero(np.diff(near) > CHAIN_GAP) + 1):
            if chain.shape[0] < config.loop_match_minimum_chain_size:
                continue
            apart = distance[chain] + np.abs(pose2.wrap(poses[chain, 2] - poses[newest, 2]))
            closest = int(chain[np.argmin(apart)])
            if any(abs(closest - place) <= CHAIN_REACH for _, place in self._tried):
                continue
            self._tried.append((newest, closest))
            members = chain[np.abs(chain - closest) <= CHAIN_REACH]
            closure = self._match(clouds, poses, members, closest, float(drift[closest]))
            if closure is not None:
                closures.append(closure)
        return closures

    def forget(self, index: int) -> None:
        """Follow the removal of a key scan: those after it are numbered one lower."""
        self._tried = [
            (scan - (scan > index), place - (place > index))
            for scan, place in self._tried
            if index not in (scan, place)
        ]

    def _match(
        self, clouds: Sequence[Cloud], poses: Array, members: NDArray[np.intp], closest: int, drift: float
    ) -> Edge | None:
        newest = poses.shape[0] - 1
        latest = np.arange(max(0, newest - QUERY_SCANS + 1), newest + 1)
        place = PointMap([clouds[j] for j in members], pose2.between(poses[closest], poses[members]))
        points, normals = merge([clouds[j] for j in latest], pose2.between(poses[newest], poses[latest]))
        window = Window(
            distance=min(0.5 * self.config.loop_search_space_dimension, 0.2 + drift),
            angle=min(MAX_SEARCH_ANGLE, 0.05 + 0.15 * drift),
            resolution=RESOLUTION,
            deviation=RESOLUTION,
            distance_penalty=0.005,
            minimum_score=max(MIN_LIKELIHOOD, self.config.loop_match_minimum_response_coarse),
        )
        match = place.correlate(points, pose2.between(poses[closest], poses[newest]), window)
        if match is None:
            return None
        fine = place.refine(points, normals, match.pose)
        least = max(MIN_INLIER_RATIO, self.config.loop_match_minimum_response_fine)
        if fine.inlier_ratio < least or fine.residual > MAX_RESIDUAL:
            return None
        information = match_information(fine.normal_matrix / QUERY_SCANS)
        return Edge(closest, newest, fine.pose, information, closure=True)


def possible_drift(source: int, poses: Array, edges: Sequence[Edge]) -> Array:
    """Bound the drift [m] of each pose relative to one, shape (n,), by the shortest path through the graph.

    After Olson 2009, "Recognizing places using spectrally clustered local matches", with bounds where he has
    covariances.
    """
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    first = np.array([edge.first for edge in edges])
    second = np.array([edge.second for edge in edges])
    closure = np.array([edge.closure for edge in edges])
    step = pose2.between(poses[first], poses[second])
    moved = DRIFT_PER_METRE * np.hypot(step[:, 0], step[:, 1]) + DRIFT_PER_RADIAN * np.abs(step[:, 2])
    weight = np.where(closure, DRIFT_OF_CLOSURE, moved) + 1e-6
    count = poses.shape[0]
    graph = csr_matrix((weight, (first, second)), shape=(count, count))
    drift: Array = dijkstra(graph, directed=False, indices=source)
    return drift
