"""Moving obstacle layer: where people, carts and other robots will be soon."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Window,
)
from daidalos.navigation.costmap.footprint import fill_polygon
from daidalos.navigation.costmap.observation import Observation
from daidalos.navigation.tracking import MovingObstacleTracker, Track

_COST_AROUND_ROBOT = INSCRIBED_INFLATED_OBSTACLE - 13
"""Cost of a moving obstacle's way in which the robot stands."""


@dataclass(frozen=True)
class TrackedScan(Parameters):
    """Parameters of one lidar."""

    topic: str = parameter("", "Topic of the lidar; empty for the source's name.", read_only=True)


@dataclass(frozen=True)
class MovingObstacleLayerParameters(Parameters):
    """Parameters of the layer."""

    enabled: bool = parameter(True, "Whether the layer is used.")
    observation_sources: str = parameter("scan", "Names of the lidars, with spaces between them.", read_only=True)
    sources: Mapping[str, TrackedScan] = per_name(TrackedScan, by="observation_sources", at="")
    prediction_time: float = parameter(2.5, "How far ahead moving obstacles are predicted.", unit="s", minimum=0.0)
    min_speed: float = parameter(0.25, "Speed above which an obstacle moves.", unit="m/s", minimum=0.0, read_only=True)
    max_width: float = parameter(
        1.0, "Width up to which something is an obstacle of its own.", unit="m", above=0.0, read_only=True
    )
    margin: float = parameter(0.1, "Width that is added to each side of a moving obstacle.", unit="m", minimum=0.0)


class MovingObstacleLayer(Layer):
    """Layer of the ground that tracked obstacles will pass soon, at constant velocity; lethal.

    The layer of the obstacles themselves stands below it, inflation above. Nothing is marked where the robot stands:
    whoever comes towards it will not pass through it, and it may drive away. The way of an obstacle in which the robot
    stands already has high costs instead of lethal ones, so that the robot can leave it.
    """

    names = ("daidalos::MovingObstacleLayer",)
    clearable = True
    Parameters = MovingObstacleLayerParameters
    parameters: MovingObstacleLayerParameters

    def __init__(
        self, parameters: MovingObstacleLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        p = self.parameters
        self._trackers = {name: MovingObstacleTracker(p.max_width, p.min_speed) for name in p.sources}
        self._strips: list[tuple[Array, Array, float]] = []
        self._robot = np.zeros(2)
        self._stand: Array | None = None
        self._under_robot = self.context.footprint.at(np.zeros(3))

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        return tuple(
            Input(source.topic or name, LaserScanData, partial(self.add_scan, name))
            for name, source in self.parameters.sources.items()
        )

    def add_scan(self, source: str, scan: LaserScanData, base_pose: Array, stamp: float) -> None:
        """Take a scan of one of the lidars; see `Observation.from_scan`."""
        self._trackers[source].update(Observation.from_scan(scan, base_pose, stamp))

    def moving(self, now: float) -> list[Track]:
        """Return what moves at a time [s]."""
        return [track for tracker in self._trackers.values() for track in tracker.moving(now)]

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Include where obstacles were predicted before, and where they are now."""
        p = self.parameters
        self._robot = robot_pose[:2]
        self._under_robot = self.context.footprint.at(robot_pose)
        for strip in self._strips:
            bounds = bounds.including(_bounds(*strip))
        self._strips = []
        for track in self.moving(now):
            begin = track.position + track.velocity * (now - track.seen)
            end = begin + track.velocity * p.prediction_time
            self._strips.append((begin, end, track.radius + p.margin))
            bounds = bounds.including(_bounds(*self._strips[-1]))
        if not any((_distances(self._under_robot, begin, end) <= radius).any() for begin, end, radius in self._strips):
            self._stand = None
        elif self._stand is None:
            self._stand = self._under_robot
        return bounds

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Mark the strips, except where the robot was as the first one reached it, and a cell around that."""
        from scipy.ndimage import binary_dilation

        # Not where it is now: it would move on into them, cell by cell.
        under = self._under_robot if self._stand is None else self._stand
        here = costmap.window_of(Bounds().including_points(under).expanded(2.0 * costmap.resolution))
        before = costmap.costs[here.slices].copy()
        self._mark(costmap)
        if here.empty:
            return
        stand = Costmap(np.zeros_like(before), costmap.resolution, costmap.origin + _corner(here) * costmap.resolution)
        fill_polygon(stand, under, LETHAL_OBSTACLE)
        below = binary_dilation(stand.costs == LETHAL_OBSTACLE)
        costmap.costs[here.slices][below] = before[below]

    def _mark(self, costmap: Costmap) -> None:
        for begin, end, radius in self._strips:
            part = costmap.window_of(_bounds(begin, end, radius))
            if part.empty:
                continue
            rows, columns = part.slices
            y, x = np.mgrid[rows, columns]
            cells = np.stack([x, y], axis=-1)
            points = costmap.origin + (cells + 0.5) * costmap.resolution
            near = _distances(points, begin, end) <= radius
            reach = radius + 0.5 * self.context.footprint.inscribed_radius
            holds_robot = bool(_distances(self._robot, begin, end) <= reach)
            cost = _COST_AROUND_ROBOT if holds_robot else LETHAL_OBSTACLE
            costs = costmap.costs[part.slices]
            costs[near] = np.where(costs[near] == NO_INFORMATION, cost, np.maximum(costs[near], cost))

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Forget all tracks."""
        for tracker in self._trackers.values():
            tracker.reset()


def _corner(window: Window) -> Array:
    """Return the column and row of a window's first cell."""
    return np.array([window.left, window.bottom], dtype=np.float64)


def _bounds(begin: Array, end: Array, radius: float) -> Bounds:
    return Bounds().including_points(np.stack([begin, end])).expanded(radius)


def _distances(points: Array, begin: Array, end: Array) -> Array:
    """Return the distance [m] of points (..., 2) to a segment."""
    way = end - begin
    along = ((points - begin) @ way) / max(float(way @ way), 1e-12)
    nearest = begin + np.clip(along, 0.0, 1.0)[..., None] * way
    return np.asarray(np.linalg.norm(points - nearest, axis=-1))
