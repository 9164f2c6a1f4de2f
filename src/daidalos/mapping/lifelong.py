"""Removal of old key scans whose place newer ones show, so that a map that is used for years does not grow.

After the scores of slam_toolbox's lifelong mode: what two scans see is compared by the boxes around their points.
"""

from dataclasses import dataclass

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.slam import Slam

_FEW_EDGES = 3
"""Number of edges below which a scan whose box fits decays at once: no loop closure depends on it."""

_KEPT = 2
"""Key scans at the beginning of the map that are never removed."""


@dataclass(frozen=True)
class LifelongConfig(Parameters):
    """Parameters of the removal, by their names in slam_toolbox."""

    lifelong_search_use_tree: bool = parameter(
        False, "Whether all scans nearby are compared, not only those that the pose graph ties to the new one."
    )
    lifelong_minimum_score: float = parameter(
        0.1, "Least intersection over union of the boxes for two scans to be compared.", minimum=0.0, maximum=1.0
    )
    lifelong_iou_match: float = parameter(
        0.85, "Intersection over union from which an old scan is removed at once.", minimum=0.0, maximum=1.0
    )
    lifelong_node_removal_score: float = parameter(
        0.04, "Score below which a scan is removed; it begins with 1.", minimum=0.0, maximum=1.0
    )
    lifelong_overlap_score_scale: float = parameter(
        0.06, "Part of the overlap that a newer scan takes off the score.", minimum=0.0, maximum=1.0
    )
    lifelong_constraint_multiplier: float = parameter(
        0.08, "How much every edge beyond two slows the decay.", minimum=0.0, maximum=1.0
    )
    lifelong_nearby_penalty: float = parameter(0.001, "What a newer scan nearby takes off in any case.", minimum=0.0)
    lifelong_candidates_scale: float = parameter(
        0.03, "How much every other scan nearby speeds the decay up.", minimum=0.0, maximum=1.0
    )


class KeyScanDecay:
    """Scores of key scans, which fall with every newer scan of the same place.

    Parameters
    ----------
    config : LifelongConfig
        Weights and thresholds.
    """

    def __init__(self, config: LifelongConfig) -> None:
        self.config = config
        self._scores: list[float] = []

    def reset(self) -> None:
        """Forget the scores, such as for another map."""
        self._scores = []

    def update(self, slam: Slam) -> int:
        """Lower the scores of the scans that the newest one overlaps, and remove those that fell too low.

        Returns
        -------
        int
            The number of removed key scans.
        """
        count = slam.key_count
        self._scores += [1.0] * (count - len(self._scores))
        newest = count - 1
        candidates = self._candidates(slam, newest)
        boxes = {index: _box(slam, index) for index in [*candidates, newest]}
        overlaps = {index: _overlap(boxes[newest], boxes[index]) for index in candidates}
        compared = [index for index in candidates if overlaps[index][0] >= self.config.lifelong_minimum_score]
        for index in compared:
            self._scores[index] = self._lowered(slam, index, boxes[newest], overlaps[index], len(compared))
        removed = [index for index in compared if self._scores[index] < self.config.lifelong_node_removal_score]
        slam.remove_keys(removed)
        for index in reversed(removed):
            del self._scores[index]
        return len(removed)

    def _candidates(self, slam: Slam, newest: int) -> list[int]:
        """Return the old key scans that the newest one may replace, in order."""
        left, bottom, right, top = _box(slam, newest)
        radius = 0.5 * float(np.hypot(right - left, top - bottom))
        poses = slam.key_poses
        distance = np.hypot(poses[:, 0] - poses[newest, 0], poses[:, 1] - poses[newest, 1])
        old = [
            int(index)
            for index in np.flatnonzero(distance < radius)
            if _KEPT <= index <= newest - slam.config.scan_buffer_size
        ]
        if self.config.lifelong_search_use_tree:
            return old
        tied = _tied_to(slam, newest, set(np.flatnonzero(distance < radius).tolist()))
        return [index for index in old if index in tied]

    def _lowered(self, slam: Slam, index: int, new_box: Array, overlap: tuple[float, float], candidates: int) -> float:
        config, score = self.config, self._scores[index]
        iou, area = overlap
        edges = sum(index in (edge.first, edge.second) for edge in slam.edges)
        if iou > config.lifelong_iou_match and edges < _FEW_EDGES:
            return -1.0
        points = pose2.transform_points(slam.key_pose(index), slam.key_clouds[index].points)
        inside = ((points >= new_box[:2]) & (points <= new_box[2:])).all(axis=1).mean()
        lost = config.lifelong_overlap_score_scale * min(area, float(inside))
        held = min(max(0.0, config.lifelong_constraint_multiplier * (edges - 2)), lost, 1.0)
        crowd = 1.0 + config.lifelong_candidates_scale * (candidates - 1)
        return min(1.0, score * (1.0 + held) - crowd * (lost + config.lifelong_nearby_penalty))


def _tied_to(slam: Slam, newest: int, near: set[int]) -> set[int]:
    """Return the key scans that the pose graph ties to one over others that are near."""
    neighbours: dict[int, list[int]] = {}
    for edge in slam.edges:
        neighbours.setdefault(edge.first, []).append(edge.second)
        neighbours.setdefault(edge.second, []).append(edge.first)
    found, waiting = {newest}, [newest]
    while waiting:
        for other in neighbours.get(waiting.pop(), []):
            if other in near and other not in found:
                found.add(other)
                waiting.append(other)
    return found


def _box(slam: Slam, index: int) -> Array:
    """Return the box around the points of a key scan in the map: left, bottom, right, top."""
    points = pose2.transform_points(slam.key_pose(index), slam.key_clouds[index].points)
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def _overlap(new: Array, old: Array) -> tuple[float, float]:
    """Return the intersection of two boxes over their union, and over the area of the old one."""
    size = np.maximum(0.0, np.minimum(new[2:], old[2:]) - np.maximum(new[:2], old[:2]))
    shared, area_new, area_old = (
        float(np.prod(size)),
        float(np.prod(new[2:] - new[:2])),
        float(np.prod(old[2:] - old[:2])),
    )
    return shared / max(area_new + area_old - shared, 1e-9), shared / max(area_old, 1e-9)
