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

FAR_INTERVAL = 2
FAR_PLACES = 2
"""Of so many key scans one is compared with so many places farther away than the search distance."""

CONFIRMATIONS = 2
PENDING_SCANS = 40
MIN_CONFIRMING_STEP = 2
"""Other closures that must agree with one to a place far away, the key scans after which one that nothing confirms is
dropped, and the key scans between two that confirm each other."""

AGREEMENT, AGREEMENT_TURN = 0.3, 0.1
"""How far [m], [rad] closures that agree may be apart."""

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
        self._pending: list[Edge] = []
        self._far_turn = 0

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
        self._tried = [(scan, place) for scan, place in self._tried if newest - scan < RETRY_INTERVAL]
        is_far_turn = newest % FAR_INTERVAL == 0 and old > 0
        if near.shape[0] == 0 and not is_far_turn:
            return []
        drift = possible_drift(newest, poses, edges)
        closures = self._search_near(clouds, poses, near[drift[near] > SETTLED_DRIFT], distance, drift)
        if is_far_turn and not closures:
            far = np.flatnonzero((distance >= config.loop_search_maximum_distance) & (distance < drift[:old]))
            closures = self._search_far(clouds, poses, far, drift)
        return closures

    def _search_near(
        self, clouds: Sequence[Cloud], poses: Array, near: NDArray[np.intp], distance: Array, drift: Array
    ) -> list[Edge]:
        """Match the newest key scan with the closest place of each chain nearby."""
        newest = poses.shape[0] - 1
        closures = []
        for chain in _chains(near):
            if chain.shape[0] < self.config.loop_match_minimum_chain_size:
                continue
            apart = distance[chain] + np.abs(pose2.wrap(poses[chain, 2] - poses[newest, 2]))
            closest = int(chain[np.argmin(apart)])
            if any(abs(closest - place) <= CHAIN_REACH for _, place in self._tried):
                continue
            self._tried.append((newest, closest))
            guess = pose2.between(poses[closest], poses[newest])
            closure = self._match(clouds, poses, chain, closest, guess, float(drift[closest]))
            if closure is not None:
                closures.append(closure)
        return closures

    def _search_far(self, clouds: Sequence[Cloud], poses: Array, far: NDArray[np.intp], drift: Array) -> list[Edge]:
        """Match the newest key scan with places where it may be by its drift; return closures that confirm each other.

        The places are tried in turns, a few with each scan. One such match proves nothing, since rooms and corridors
        look alike: several that agree along the way are taken together.
        """
        newest = poses.shape[0] - 1
        places = [
            int(chain[k])
            for chain in _chains(far)
            for k in range(len(chain) // 2 % CHAIN_REACH, len(chain), CHAIN_REACH)
        ]
        self._pending = [edge for edge in self._pending if newest - edge.second <= PENDING_SCANS]
        # Where a match waits to be confirmed is looked at first.
        expected = [edge.first for edge in self._pending[-1:]]
        begin = self._far_turn % max(1, len(places))
        turns = [*expected, *(places[begin:] + places[:begin])[:FAR_PLACES]]
        self._far_turn = begin + FAR_PLACES
        for place in turns:
            members = np.arange(max(0, place - CHAIN_REACH), min(newest - QUERY_SCANS, place + CHAIN_REACH) + 1)
            guess = np.array([0.0, 0.0, pose2.wrap(poses[newest, 2] - poses[place, 2])])
            found = self._match(clouds, poses, members, place, guess, float(drift[place]))
            if found is None:
                continue
            agreeing = [edge for edge in self._pending if _agree(edge, found, poses)]
            self._pending.append(found)
            if len(agreeing) >= CONFIRMATIONS:
                self._pending = []
                return [*agreeing, found]
        return []

    def forget(self, index: int) -> None:
        """Follow the removal of a key scan: those after it are numbered one lower."""
        self._tried = [
            (scan - (scan > index), place - (place > index))
            for scan, place in self._tried
            if index not in (scan, place)
        ]
        self._pending = []

    def _match(
        self, clouds: Sequence[Cloud], poses: Array, chain: NDArray[np.intp], closest: int, guess: Array, drift: float
    ) -> Edge | None:
        """Match the newest key scans with those of a chain around its closest one, from a guess relative to that."""
        members = chain[np.abs(chain - closest) <= CHAIN_REACH]
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
        match = place.correlate(points, guess, window)
        if match is None:
            return None
        fine = place.refine(points, normals, match.pose)
        least = max(MIN_INLIER_RATIO, self.config.loop_match_minimum_response_fine)
        if fine.inlier_ratio < least or fine.residual > MAX_RESIDUAL:
            return None
        information = match_information(fine.normal_matrix / QUERY_SCANS)
        return Edge(closest, newest, fine.pose, information, closure=True)


def _chains(indices: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Split indices in order where they have larger gaps."""
    if not len(indices):
        return []
    return np.split(indices, np.flatnonzero(np.diff(indices) > CHAIN_GAP) + 1)


def _agree(first: Edge, second: Edge, poses: Array) -> bool:
    """Return whether two closures of different scans lead the same way, by the poses between their ends."""
    if not second.second - first.second >= MIN_CONFIRMING_STEP or abs(second.first - first.first) > PENDING_SCANS:
        return False
    on_map = pose2.compose(pose2.between(poses[first.first], poses[second.first]), second.measurement)
    gap = pose2.between(
        pose2.between(first.measurement, on_map), pose2.between(poses[first.second], poses[second.second])
    )
    return bool(np.hypot(gap[0], gap[1]) < AGREEMENT and abs(gap[2]) < AGREEMENT_TURN)


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
