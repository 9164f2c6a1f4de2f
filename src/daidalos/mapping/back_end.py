"""Back end of SLAM: loop closures of the newest key scan and the poses that fit them, on a copy of the graph."""

from dataclasses import dataclass

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.loop_closing import LoopCloser
from daidalos.mapping.pose_graph import Edge, optimize
from daidalos.mapping.scan import Cloud

TOLERATED_GAP = 0.05
TOLERATED_TURN = 0.01
"""Disagreement [m], [rad] between a closure and the poses so far up to which optimizing can wait."""

BENT_GAP = 2.0
"""Disagreement [m] from which the poses are too bent to start an optimization from them alone."""


@dataclass(frozen=True)
class GraphSnapshot:
    """Key scans and the pose graph at one time.

    Attributes
    ----------
    clouds : list of Cloud
    poses : ndarray, shape (n, 3)
    edges : list of Edge
    revision : int
        Number of times that key scans were moved or removed until then.
    """

    clouds: list[Cloud]
    poses: Array
    edges: list[Edge]
    revision: int


@dataclass(frozen=True)
class Correction:
    """Result of a search for loop closures.

    Attributes
    ----------
    snapshot : GraphSnapshot
        What was searched.
    edges : list of Edge
        Its edges and the closures, without those that disagree with all the others.
    poses : ndarray, shape (n, 3), or None
        Where the key scans are by them; None where the poses fit already.
    """

    snapshot: GraphSnapshot
    edges: list[Edge]
    poses: Array | None


def find_correction(closer: LoopCloser, snapshot: GraphSnapshot) -> Correction | None:
    """Search loop closures of the newest key scan of a graph, and optimize its poses where they disagree.

    Returns
    -------
    Correction, or None
        None where there is no closure.
    """
    closures = closer.search(snapshot.clouds, snapshot.poses, snapshot.edges)
    if not closures:
        return None
    edges, poses = snapshot.edges + closures, snapshot.poses
    measured = np.array([edge.measurement for edge in closures])
    gaps = pose2.between(measured, pose2.between(poses[[edge.first for edge in closures]], poses[-1]))
    gap, turn = np.hypot(gaps[:, 0], gaps[:, 1]).max(), np.abs(gaps[:, 2]).max()
    if gap < TOLERATED_GAP and turn < TOLERATED_TURN:
        return Correction(snapshot, edges, None)
    solution = optimize(poses, edges, chordal=bool(gap > BENT_GAP))
    rejected = set(solution.rejected)
    return Correction(snapshot, [edge for k, edge in enumerate(edges) if k not in rejected], solution.poses)
