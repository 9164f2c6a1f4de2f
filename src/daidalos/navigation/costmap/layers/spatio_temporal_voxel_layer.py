"""Spatio-temporal voxel layer: voxels that fade with time, and sooner where a sensor looks and sees nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.common.pose2 import transform_points
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import Input, Layer, NavigationContext, Output
from daidalos.navigation.costmap.costmap import (
    FREE_SPACE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Window,
)
from daidalos.navigation.costmap.footprint import fill_polygon
from daidalos.navigation.costmap.layers.obstacle_layer import combine
from daidalos.navigation.costmap.observation import CloudData, Observation
from daidalos.navigation.costmap.source_ages import age_of_observations, missing_observation
from daidalos.navigation.costmap.voxel_memory import (
    DEPTH_CAMERA,
    EXPONENTIAL,
    LIDAR,
    LINEAR,
    PERSISTENT,
    View,
    VoxelMemory,
)

PASS_THROUGH, VOXEL, NO_FILTER = "passthrough", "voxel", "none"


@dataclass(frozen=True)
class VoxelSource(Parameters):
    """Parameters of one sensor, by their names in spatio_temporal_voxel_layer.

    The default of `expected_update_rate` is half a second instead of no limit: without it the robot drives on when a
    sensor fails.
    """

    enabled: bool = parameter(True, "Whether the sensor is used.")
    data_type: str = parameter(
        "PointCloud2", "Type of its messages.", choices=("LaserScan", "PointCloud2"), read_only=True
    )
    topic: str = parameter("", "Topic of the sensor; empty for the source's name.", read_only=True)
    marking: bool = parameter(True, "Whether its points are marked.")
    clearing: bool = parameter(False, "Whether voxels fade sooner in its view; of point clouds.")
    obstacle_range: float = parameter(2.5, "Range up to which points are marked.", unit="m", minimum=0.0)
    min_obstacle_height: float = parameter(0.0, "Height from which points are marked.", unit="m")
    max_obstacle_height: float = parameter(3.0, "Height up to which points are marked.", unit="m")
    expected_update_rate: float = parameter(
        0.5, "Age of the latest observation from which the costmap is out of date; 0 for no limit.", unit="s",
        minimum=0.0,
    )  # fmt: skip
    observation_persistence: float = parameter(
        0.0, "How long an observation is kept; 0 keeps the latest alone.", unit="s", minimum=0.0
    )
    inf_is_valid: bool = parameter(False, "Whether rays of scans that met nothing count as observations.")
    clear_after_reading: bool = parameter(False, "Whether observations are dropped once they were used.")
    filter: str = parameter(
        PASS_THROUGH, "Which points are used: those within the heights, of these those in full voxels, or all.",
        choices=(PASS_THROUGH, VOXEL, NO_FILTER, ""),
    )  # fmt: skip
    voxel_min_points: int = parameter(0, "Points that a voxel must hold for that filter to keep it.", minimum=0)
    model_type: int = parameter(
        0, "Shape of the view: 0 of a depth camera, 1 of a lidar.", choices=(DEPTH_CAMERA, LIDAR)
    )
    min_z: float = parameter(0.0, "Where the view begins.", unit="m", minimum=0.0)
    max_z: float = parameter(10.0, "Where the view ends.", unit="m", minimum=0.0)
    vertical_fov_angle: float = parameter(0.7, "Height of the view.", unit="rad", minimum=0.0, maximum=math.pi)
    vertical_fov_padding: float = parameter(0.0, "Added to the height of a lidar's view.", unit="m", minimum=0.0)
    horizontal_fov_angle: float = parameter(1.04, "Width of the view.", unit="rad", minimum=0.0, maximum=2.0 * math.pi)
    decay_acceleration: float = parameter(
        0.0, "How much sooner voxels in the view fade: its sixth times the cube of their age.", unit="1/s^2",
        minimum=0.0,
    )  # fmt: skip


@dataclass(frozen=True)
class SpatioTemporalVoxelLayerParameters(Parameters):
    """Parameters of the layer, by their names in spatio_temporal_voxel_layer."""

    enabled: bool = parameter(True, "Whether the layer is used.")
    voxel_size: float = parameter(0.05, "Edge of a voxel.", unit="m", above=0.0, read_only=True)
    voxel_decay: float = parameter(-1.0, "How long voxels stay; negative for ever.", unit="s", takes_integer=True)
    decay_model: int = parameter(
        0, "How: 0 for that time, 1 as in exp(-age), -1 until a sensor looks there and sees nothing.",
        choices=(PERSISTENT, LINEAR, EXPONENTIAL),
    )  # fmt: skip
    mark_threshold: int = parameter(0, "Voxels above a cell up to which it is free.", minimum=0)
    track_unknown_space: bool = parameter(False, "Whether cells without voxels are unknown instead of free.")
    update_footprint_enabled: bool = parameter(True, "Whether the cells below the robot are cleared.")
    combination_method: int = parameter(
        1, "How costs are combined with those of layers below: 0 overwrites, 1 takes the largest.", choices=(0, 1)
    )
    publish_voxel_map: bool = parameter(False, "Whether the voxels are published on <layer>/voxel_grid.")
    observation_sources: str = parameter("", "Names of the sensors, with spaces between them.", read_only=True)
    sources: Mapping[str, VoxelSource] = per_name(VoxelSource, by="observation_sources", at="")


@dataclass(frozen=True)
class _Reading:
    """Points (n, 3) of a measurement in the costmap's frame, where its sensor was, and its axes, if known."""

    stamp: float
    points: Array
    position: Array
    rotation: Array | None


class SpatioTemporalVoxelLayer(Layer):
    """Layer of voxels from point clouds and scans."""

    names = ("spatio_temporal_voxel_layer/SpatioTemporalVoxelLayer",)
    clearable = True
    Parameters = SpatioTemporalVoxelLayerParameters
    parameters: SpatioTemporalVoxelLayerParameters

    def __init__(
        self,
        parameters: SpatioTemporalVoxelLayerParameters | None = None,
        context: NavigationContext | None = None,
    ) -> None:
        super().__init__(parameters, context)
        self.memory = VoxelMemory(self.parameters.voxel_size)
        self._readings: dict[str, list[_Reading]] = {name: [] for name in self.parameters.sources}
        self._latest: dict[str, float] = {}
        self._costmap: Costmap | None = None
        self._drawn = Bounds()
        self._under_robot: Array | None = None

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        return tuple(
            Input(source.topic or name, LaserScanData, partial(self.add_scan, name))
            if source.data_type == "LaserScan"
            else Input(source.topic or name, CloudData, partial(self.add_cloud, name))
            for name, source in self.parameters.sources.items()
        )

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Layer.outputs`."""
        return (Output(f"{self.context.name}/voxel_grid", CloudData, self._cloud),)

    def _cloud(self) -> CloudData | None:
        return CloudData(self.memory.centres, np.zeros(3)) if self.parameters.publish_voxel_map else None

    def add_scan(self, source: str, scan: LaserScanData, base_pose: Array, stamp: float) -> None:
        """Take a scan of one of the sources; see `Observation.from_scan`."""
        seen = Observation.from_scan(scan, base_pose, stamp, inf_is_valid=self.parameters.sources[source].inf_is_valid)
        if not seen.ends.shape[0]:
            return
        points = np.column_stack([seen.ends, seen.end_heights])[seen.hits]
        self._add(source, _Reading(stamp, points, np.array([*seen.origin, seen.origin_height]), None))

    def add_cloud(self, source: str, cloud: CloudData, base_pose: Array, stamp: float) -> None:
        """Take a point cloud of one of the sources; see `Observation.from_cloud`."""
        seen = Observation.from_cloud(cloud, base_pose, stamp)
        cosine, sine = math.cos(base_pose[2]), math.sin(base_pose[2])
        turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        position = np.array([*transform_points(base_pose, cloud.sensor[None, :2])[0], cloud.sensor[2]])
        points = np.column_stack([seen.ends, seen.end_heights])
        self._add(source, _Reading(stamp, points, position, turned @ cloud.rotation))

    def _add(self, source: str, reading: _Reading) -> None:
        """Keep a measurement, instead of the last one where none is to persist."""
        if not self.parameters.sources[source].enabled:
            return
        readings = self._readings[source]
        if self.parameters.sources[source].observation_persistence <= 0.0:
            readings.clear()
        readings.append(reading)
        self._latest[source] = reading.stamp

    def missing_input(self, now: float) -> str:
        """Implement `Layer.missing_input`."""
        return missing_observation(self._latest, self._used_sources(), now)

    def age_of_input(self, now: float) -> float:
        """Implement `Layer.age_of_input` by the sensors' `expected_update_rate`."""
        return age_of_observations(self._latest, self._used_sources(), now)

    def _used_sources(self) -> dict[str, VoxelSource]:
        return {name: source for name, source in self.parameters.sources.items() if source.enabled}

    def match_size(self, costmap: Costmap) -> None:
        """Forget the voxels outside of the costmap."""
        self._costmap = costmap
        low = costmap.origin
        high = low + costmap.resolution * np.array([costmap.width, costmap.height])
        places = self.memory.centres[:, :2]
        self.memory.keep(np.asarray(((places >= low) & (places < high)).all(axis=1)))

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Fade the voxels, mark new ones, and return the bounds of those before and after."""
        p = self.parameters
        before = self._drawn
        readings = [
            (source, reading) for name, source in self._used_sources().items() for reading in self._readings[name]
        ]
        self.memory.fade(now, p.decay_model, p.voxel_decay, [
            _view(source, reading) for source, reading in readings if source.clearing and reading.rotation is not None
        ])  # fmt: skip
        for source, reading in readings:
            if source.marking:
                self.memory.mark(self._obstacles(source, reading), reading.stamp)
        for name, source in p.sources.items():
            oldest = np.inf if source.clear_after_reading else now - source.observation_persistence
            kept = [one for one in self._readings[name] if one.stamp > oldest]
            latest = [] if source.clear_after_reading else self._readings[name][-1:]
            self._readings[name] = kept or latest
        self._drawn = Bounds().including_points(self.memory.centres[:, :2])
        if p.update_footprint_enabled:
            self._under_robot = self.context.footprint.at(robot_pose)
            self._drawn = self._drawn.including_points(self._under_robot)
        return bounds.including(before).including(self._drawn)

    def _obstacles(self, source: VoxelSource, reading: _Reading) -> Array:
        """Return the points (n, 3) of a reading that are marked."""
        points: Array = reading.points
        away = np.sqrt(((points - reading.position) ** 2).sum(axis=1))
        used = (away <= source.obstacle_range) & (away >= 0.01)
        if source.filter in (PASS_THROUGH, VOXEL):
            used &= (points[:, 2] >= source.min_obstacle_height) & (points[:, 2] <= source.max_obstacle_height)
        points = points[used]
        if source.filter == VOXEL and source.voxel_min_points > 1:
            _, index, counts = np.unique(
                np.floor(points / self.memory.size), axis=0, return_inverse=True, return_counts=True
            )
            points = points[counts[index.ravel()] >= source.voxel_min_points]
        return points

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Write the cells below more than `mark_threshold` voxels."""
        p = self.parameters
        costs = np.full_like(costmap.costs, NO_INFORMATION if p.track_unknown_space else FREE_SPACE)
        numbers = self._voxels_above(costmap)
        costs[numbers > p.mark_threshold] = LETHAL_OBSTACLE
        if p.update_footprint_enabled and self._under_robot is not None:
            fill_polygon(Costmap(costs, costmap.resolution, costmap.origin), self._under_robot, FREE_SPACE)
            fill_polygon(costmap, self._under_robot, FREE_SPACE)
        combine(costmap.costs[window.slices], costs[window.slices], p.combination_method)

    def _voxels_above(self, costmap: Costmap) -> NDArray[np.int64]:
        """Return the number of voxels above each cell; one that is larger than cells is above all that it covers."""
        centres = (self.memory.centres[:, :2] - costmap.origin) / costmap.resolution
        half = max(0.5 * self.memory.size / costmap.resolution - 1e-6, 0.0)
        half = half if half > 0.5 else 0.0
        low, high = (np.floor(centres + sign * half).astype(np.int64) for sign in (-1.0, 1.0))
        numbers = np.zeros(costmap.width * costmap.height, np.int64)
        most = int((high - low).max(initial=0)) + 1
        for right in range(most):
            for up in range(most):
                cells = low + np.array([right, up])
                inside = (cells <= high) & (cells >= 0) & (cells < (costmap.width, costmap.height))
                column, row = cells[inside.all(axis=1)].T
                numbers += np.bincount(row * costmap.width + column, minlength=numbers.size)
        return numbers.reshape(costmap.height, costmap.width)

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Forget the voxels above a window of cells, or outside of it."""
        if self._costmap is None:
            return
        cells = np.floor((self.memory.centres[:, :2] - self._costmap.origin) / self._costmap.resolution)
        within = np.asarray(((cells >= (keep.left, keep.bottom)) & (cells < (keep.right, keep.top))).all(axis=1))
        self.memory.keep(~within if inside else within)
        for readings in self._readings.values():
            readings.clear()


def _view(source: VoxelSource, reading: _Reading) -> View:
    assert reading.rotation is not None
    return View(
        source.model_type, reading.position, reading.rotation, source.min_z, source.max_z, source.vertical_fov_angle,
        source.horizontal_fov_angle, source.vertical_fov_padding, source.decay_acceleration,
    )  # fmt: skip
