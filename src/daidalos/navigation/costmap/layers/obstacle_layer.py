"""Obstacle layer: marks where rays of sensors end, and clears where they pass."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import (
    FREE_SPACE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Costs,
    Window,
)
from daidalos.navigation.costmap.footprint import fill_polygon
from daidalos.navigation.costmap.observation import CloudData, Observation
from daidalos.navigation.costmap.source_ages import age_of_observations, missing_observation


@dataclass(frozen=True)
class ObservationSource(Parameters):
    """Parameters of one sensor, by their Nav2 names.

    Two defaults differ from Nav2's. `inf_is_valid` is on: a ray that met nothing shows that its way is free, and
    obstacles that have gone stay in the costmap for ever without it. `expected_update_rate` is half a second instead of
    no limit: without it the robot drives on when a sensor fails. `topic` is the source's name where empty.
    """

    obstacle_max_range: float = parameter(2.5, "Range up to which obstacles are marked.", unit="m", minimum=0.0)
    obstacle_min_range: float = parameter(0.0, "Range from which obstacles are marked.", unit="m", minimum=0.0)
    raytrace_max_range: float = parameter(3.0, "Range up to which cells are cleared.", unit="m", minimum=0.0)
    raytrace_min_range: float = parameter(0.0, "Range from which cells are cleared.", unit="m", minimum=0.0)
    observation_persistence: float = parameter(
        0.0, "How long an observation is kept; 0 keeps the latest alone.", unit="s", minimum=0.0
    )
    expected_update_rate: float = parameter(
        0.5,
        "Age of the latest observation from which the costmap is out of date; 0 for no limit.",
        unit="s",
        minimum=0.0,
    )
    marking: bool = parameter(True, "Whether obstacles are marked.")
    clearing: bool = parameter(True, "Whether cells before obstacles are cleared.")
    inf_is_valid: bool = parameter(True, "Whether rays that met nothing clear their way.")
    min_obstacle_height: float = parameter(0.0, "Height from which points are obstacles.", unit="m")
    max_obstacle_height: float = parameter(2.0, "Height up to which points are obstacles.", unit="m")
    topic: str = parameter("", "Topic of the sensor; empty for the source's name.", read_only=True)
    data_type: str = parameter(
        "LaserScan", "Type of its messages.", choices=("LaserScan", "PointCloud2"), read_only=True
    )


@dataclass(frozen=True)
class ObstacleLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the layer is used.")
    max_obstacle_height: float = parameter(2.0, "Height up to which points of any sensor are obstacles.", unit="m")
    min_obstacle_height: float = parameter(0.0, "Height from which points of any sensor are obstacles.", unit="m")
    observation_sources: str = parameter("scan", "Names of the sensors, with spaces between them.", read_only=True)
    sources: Mapping[str, ObservationSource] = per_name(ObservationSource, by="observation_sources", at="")
    footprint_clearing_enabled: bool = parameter(True, "Whether the cells below the robot are cleared.")
    combination_method: int = parameter(
        1,
        "How costs are combined with those of layers below: 0 overwrites, 1 takes the largest, 2 takes the largest "
        "and leaves unknown cells unknown.",
        choices=(0, 1, 2),
    )


class _Reading:
    """Measurement that is converted to an observation where it is used: most come between two updates.

    Parameters
    ----------
    stamp : float
        Time [s] of the measurement.
    convert : callable
        Returns the observation.
    """

    def __init__(self, stamp: float, convert: Callable[[], Observation]) -> None:
        self.stamp = stamp
        self._convert = convert

    @cached_property
    def observation(self) -> Observation:
        """Rays of the measurement."""
        return self._convert()


class ObstacleLayer(Layer):
    """Layer of observed obstacles, kept until a ray passes through them.

    The cells that the robot stands on are free.
    """

    names = ("nav2_costmap_2d::ObstacleLayer",)
    clearable = True
    Parameters = ObstacleLayerParameters
    parameters: ObstacleLayerParameters

    def __init__(
        self, parameters: ObstacleLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self.default = NO_INFORMATION if self.context.track_unknown_space else FREE_SPACE
        self._seen: Costmap | None = None
        self._buffers: dict[str, list[_Reading]] = {name: [] for name in self.parameters.sources}
        self._under_robot: Array | None = None
        self._latest: dict[str, float] = {}
        self._is_warned_of_heights = False

    def add_observation(self, observation: Observation, source: str = "scan") -> None:
        """Add a measurement of one of the sources, to be used at the next update.

        Raises
        ------
        KeyError
            There is no source of that name.
        """
        self._add(source, observation.stamp, lambda: observation)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        kinds: dict[str, tuple[type, Callable[..., None]]] = {
            "LaserScan": (LaserScanData, self.add_scan),
            "PointCloud2": (CloudData, self.add_cloud),
        }
        return tuple(
            Input(source.topic or name, kinds[source.data_type][0], partial(kinds[source.data_type][1], name))
            for name, source in self.parameters.sources.items()
        )

    def add_scan(self, source: str, scan: LaserScanData, base_pose: Array, stamp: float) -> None:
        """Take a scan of one of the sources; see `Observation.from_scan`."""
        inf_is_valid = self.parameters.sources[source].inf_is_valid
        self._add(source, stamp, lambda: Observation.from_scan(scan, base_pose, stamp, inf_is_valid=inf_is_valid))

    def add_cloud(self, source: str, cloud: CloudData, base_pose: Array, stamp: float) -> None:
        """Take a point cloud of one of the sources; see `Observation.from_cloud`."""
        self._add(source, stamp, lambda: Observation.from_cloud(cloud, base_pose, stamp))

    def _add(self, source: str, stamp: float, convert: Callable[[], Observation]) -> None:
        """Keep a measurement, instead of the last one where none is to persist."""
        buffer = self._buffers[source]
        if self.parameters.sources[source].observation_persistence <= 0.0:
            buffer.clear()
        buffer.append(_Reading(stamp, convert))
        self._latest[source] = stamp

    def missing_input(self, now: float) -> str:
        """Return which sensor has observed nothing for its `expected_update_rate`."""
        return missing_observation(self._latest, self.parameters.sources, now)

    def age_of_input(self, now: float) -> float:
        """Implement `Layer.age_of_input` by the sensors' `expected_update_rate`."""
        return age_of_observations(self._latest, self.parameters.sources, now)

    def match_size(self, costmap: Costmap) -> None:
        """Keep the observations that are still inside of the costmap."""
        if self._seen is None or self._seen.resolution != costmap.resolution:
            self._seen = Costmap.filled(costmap.width, costmap.height, costmap.resolution, costmap.origin, self.default)
        else:
            self._seen.cover(costmap.width, costmap.height, costmap.origin, self.default)

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Apply new observations, and return their bounds."""
        if self._seen is None:
            return bounds
        readings = [
            (self.parameters.sources[name], reading.observation)
            for name, buffer in self._buffers.items()
            for reading in buffer
        ]
        for source, observation in readings:
            if source.clearing:
                bounds = bounds.including(self._clear(self._seen, observation, source))
        for source, observation in readings:
            if source.marking:
                bounds = bounds.including(self._mark(self._seen, observation, source))
        for name, buffer in self._buffers.items():
            oldest = now - self.parameters.sources[name].observation_persistence
            buffer[:] = [kept for kept in buffer if kept.stamp > oldest]
        if self.parameters.footprint_clearing_enabled:
            self._under_robot = self.context.footprint.at(robot_pose)
            fill_polygon(self._seen, self._under_robot, FREE_SPACE)
            bounds = bounds.including_points(self._under_robot)
        return bounds

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Write the observations: the higher cost wins, and any cost wins over unknown."""
        if self._seen is None:
            return
        if self.parameters.footprint_clearing_enabled and self._under_robot is not None:
            fill_polygon(costmap, self._under_robot, FREE_SPACE)
        combine(costmap.costs[window.slices], self._seen.costs[window.slices], self.parameters.combination_method)

    def _clear(self, seen: Costmap, observation: Observation, source: ObservationSource) -> Bounds:
        """Clear the cells that rays passed."""
        if observation.ends.shape[0]:
            clear_rays(
                seen.costs,
                seen.resolution,
                seen.origin,
                observation.origin,
                observation.ends,
                observation.hits,
                source.raytrace_min_range,
                source.raytrace_max_range,
            )
        return bounds_of_rays(observation, source.raytrace_max_range)

    def _mark(self, seen: Costmap, observation: Observation, source: ObservationSource) -> Bounds:
        """Mark the cells in which rays ended on an obstacle within range."""
        points = observation.ends[self._obstacles(observation, source)]
        cells = np.floor((points - seen.origin) / seen.resolution).astype(np.int64)
        inside = (cells >= 0).all(axis=1) & (cells < (seen.width, seen.height)).all(axis=1)
        seen.costs[cells[inside, 1], cells[inside, 0]] = LETHAL_OBSTACLE
        return Bounds().including_points(points)

    def _obstacles(self, observation: Observation, source: ObservationSource) -> NDArray[np.bool_]:
        """Return which rays ended on an obstacle within range and height; shape (n,)."""
        away = observation.ends - observation.origin
        distance = np.hypot(away[:, 0], away[:, 1])
        heights = observation.end_heights
        low = max(source.min_obstacle_height, self.parameters.min_obstacle_height)
        high = min(source.max_obstacle_height, self.parameters.max_obstacle_height)
        near = observation.hits & (distance <= source.obstacle_max_range) & (distance >= source.obstacle_min_range)
        used = near & (heights >= low) & (heights <= high)
        if near.any() and not used.any() and not self._is_warned_of_heights:
            self._is_warned_of_heights = True
            self.context.warn(
                f"{self.context.name}: all points are at heights from {heights[near].min():.2f} m to "
                f"{heights[near].max():.2f} m, and none is an obstacle: min_obstacle_height is {low:g} m, "
                f"max_obstacle_height {high:g} m"
            )
        return np.asarray(used)

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Clear the observations inside of a window of cells, or outside of it."""
        if self._seen is None:
            return
        for buffer in self._buffers.values():
            buffer.clear()
        if inside:
            self._seen.costs[keep.slices] = self.default
        else:
            kept = self._seen.costs[keep.slices].copy()
            self._seen.costs[:] = self.default
            self._seen.costs[keep.slices] = kept


def bounds_of_rays(observation: Observation, reach: float) -> Bounds:
    """Return the bounds of rays up to a distance [m] from their start."""
    if observation.ends.shape[0] == 0:
        return Bounds()
    x, y = (float(value) for value in observation.origin)
    touched = Bounds().including_points(observation.ends)
    return Bounds(
        max(touched.min_x, x - reach),
        max(touched.min_y, y - reach),
        min(touched.max_x, x + reach),
        min(touched.max_y, y + reach),
    ).including(Bounds(x, y, x, y))


@compiled
def clear_rays(
    costs: Costs,
    resolution: float,
    grid_origin: Array,
    start: Array,
    ends: Array,
    hits: NDArray[np.bool_],
    min_range: float,
    max_range: float,
) -> None:
    """Clear every cell that a ray crosses between two distances from its start, except the one it hit.

    The cells are visited in order along each ray (Amanatides and Woo 1987), so none that it crosses is
    missed.
    """
    sx = (start[0] - grid_origin[0]) / resolution
    sy = (start[1] - grid_origin[1]) / resolution
    height, width = costs.shape
    for i in range(ends.shape[0]):
        dx = (ends[i, 0] - grid_origin[0]) / resolution - sx
        dy = (ends[i, 1] - grid_origin[1]) / resolution - sy
        length = math.hypot(dx, dy)
        if length <= 0.0:
            continue
        hit_column = math.floor(sx + dx) if hits[i] else -1
        hit_row = math.floor(sy + dy) if hits[i] else -1
        limit = min(max_range / resolution, length) / length
        begin = min_range / resolution / length
        if begin >= limit:
            continue
        x, y = sx + begin * dx, sy + begin * dy
        column, row = math.floor(x), math.floor(y)
        step_x, step_y = (1 if dx > 0.0 else -1), (1 if dy > 0.0 else -1)
        next_x = (column + (1 if dx > 0.0 else 0) - sx) / dx if dx != 0.0 else np.inf
        next_y = (row + (1 if dy > 0.0 else 0) - sy) / dy if dy != 0.0 else np.inf
        along_x = abs(1.0 / dx) if dx != 0.0 else np.inf
        along_y = abs(1.0 / dy) if dy != 0.0 else np.inf
        while True:
            if column == hit_column and row == hit_row:
                break
            if 0 <= column < width and 0 <= row < height:
                costs[row, column] = FREE_SPACE
            if min(next_x, next_y) > limit:
                break
            if next_x < next_y:
                column += step_x
                next_x += along_x
            else:
                row += step_y
                next_y += along_y


@compiled
def combine(below: Costs, above: Costs, method: int) -> None:
    """Write costs over others: 0 all that is known, 1 the larger of both, 2 the larger where the other is known."""
    for row in range(below.shape[0]):
        for column in range(below.shape[1]):
            cost = above[row, column]
            if cost == NO_INFORMATION:
                continue
            old = below[row, column]
            if method == 0 or (old == NO_INFORMATION and method == 1) or old < cost:
                below[row, column] = cost
