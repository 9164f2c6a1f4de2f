"""Voxel layer: marks where rays of sensors end in space, and clears where they pass."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import (
    FREE_SPACE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Costs,
    Window,
    displaced,
)
from daidalos.navigation.costmap.layers.obstacle_layer import (
    ObservationSource,
    ObstacleLayer,
    ObstacleLayerParameters,
    bounds_of_rays,
)
from daidalos.navigation.costmap.observation import Observation
from daidalos.navigation.costmap.voxels import Bits, VoxelGrid

MAX_VOXELS = 16


@dataclass(frozen=True)
class VoxelLayerParameters(ObstacleLayerParameters):
    """Parameters of the layer, by their Nav2 names."""

    origin_z: float = parameter(0.0, "Height of the lowest voxel's lower side.", unit="m")
    z_resolution: float = parameter(0.2, "Height of a voxel.", unit="m", above=0.0)
    z_voxels: int = parameter(10, "Number of voxels above each cell.", minimum=1, maximum=MAX_VOXELS, read_only=True)
    unknown_threshold: int = parameter(
        15, "Number of unknown voxels above a cell up to which it is free.", minimum=0, maximum=MAX_VOXELS
    )
    mark_threshold: int = parameter(
        0, "Number of occupied voxels above a cell up to which it is free.", minimum=0, maximum=MAX_VOXELS
    )
    publish_voxel_map: bool = parameter(False, "Whether the voxels are published on voxel_grid.")


class VoxelLayer(ObstacleLayer):
    """Layer of observed obstacles that keeps heights apart: a ray clears only what it passes in space.

    Points below the lowest voxel count as in it; those above the highest are left out.
    """

    names = ("nav2_costmap_2d::VoxelLayer",)
    Parameters = VoxelLayerParameters
    parameters: VoxelLayerParameters

    def __init__(
        self, parameters: VoxelLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._marked: Bits = np.zeros((0, 0), np.uint16)
        self._unknown: Bits = np.zeros((0, 0), np.uint16)
        self._origin = np.zeros(2)

    @property
    def _all_bits(self) -> int:
        return (1 << self.parameters.z_voxels) - 1

    @property
    def voxels(self) -> VoxelGrid | None:
        """Implement `Layer.voxels`."""
        if self._seen is None or not self.parameters.publish_voxel_map:
            return None
        p = self.parameters
        origin = np.array([*self._seen.origin, p.origin_z])
        return VoxelGrid(
            self._marked.copy(), self._unknown.copy(), origin, self._seen.resolution, p.z_resolution, p.z_voxels
        )

    def match_size(self, costmap: Costmap) -> None:
        """Keep the voxels that are still inside of the costmap."""
        shape = (costmap.height, costmap.width)
        if self._seen is None or self._seen.resolution != costmap.resolution:
            self._marked = np.zeros(shape, np.uint16)
            self._unknown = np.full(shape, self._all_bits, np.uint16)
        else:
            right, up = (round(float(d)) for d in (costmap.origin - self._seen.origin) / costmap.resolution)
            self._marked = displaced(self._marked, right, up, shape, 0)
            self._unknown = displaced(self._unknown, right, up, shape, self._all_bits)
        super().match_size(costmap)

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Clear the voxels above a window of cells, or outside of it."""
        super().clear(keep, inside=inside)
        for bits, cleared in ((self._marked, 0), (self._unknown, self._all_bits)):
            kept = bits[keep.slices].copy()
            if inside:
                bits[keep.slices] = cleared
            else:
                bits[:] = cleared
                bits[keep.slices] = kept

    def _clear(self, seen: Costmap, observation: Observation, source: ObservationSource) -> Bounds:
        """Clear the voxels that rays passed."""
        p = self.parameters
        if observation.ends.shape[0]:
            scale = np.array([seen.resolution, seen.resolution, p.z_resolution])
            corner = np.array([*seen.origin, p.origin_z])
            start = np.array([*observation.origin, observation.origin_height])
            ends = np.column_stack([observation.ends, observation.end_heights])
            clear_voxels(
                seen.costs,
                self._marked,
                self._unknown,
                (start - corner) / scale,
                (ends - corner) / scale,
                observation.hits,
                source.raytrace_min_range / seen.resolution,
                source.raytrace_max_range / seen.resolution,
                p.z_voxels,
                p.mark_threshold,
                p.unknown_threshold,
            )
        return bounds_of_rays(observation, source.raytrace_max_range)

    def _mark(self, seen: Costmap, observation: Observation, source: ObservationSource) -> Bounds:
        """Mark the voxels in which rays ended on an obstacle within range."""
        p = self.parameters
        used = self._obstacles(observation, source)
        points, heights = observation.ends[used], observation.end_heights[used]
        cells = np.floor((points - seen.origin) / seen.resolution).astype(np.int64)
        level = np.maximum(np.floor((heights - p.origin_z) / p.z_resolution), 0.0).astype(np.int64)
        inside = (cells >= 0).all(axis=1) & (cells < (seen.width, seen.height)).all(axis=1) & (level < p.z_voxels)
        column, row = cells[inside, 0], cells[inside, 1]
        bit = (1 << level[inside]).astype(np.uint16)
        np.bitwise_or.at(self._marked, (row, column), bit)
        np.bitwise_and.at(self._unknown, (row, column), ~bit)
        full = np.bitwise_count(self._marked[row, column]) > p.mark_threshold
        seen.costs[row[full], column[full]] = LETHAL_OBSTACLE
        return Bounds().including_points(points)


@compiled
def clear_voxels(
    costs: Costs,
    marked: Bits,
    unknown: Bits,
    start: Array,
    ends: Array,
    hits: NDArray[np.bool_],
    min_range: float,
    max_range: float,
    levels: int,
    mark_threshold: int,
    unknown_threshold: int,
) -> None:
    """Clear every voxel that a ray crosses between two horizontal distances from its start, except the one it hit.

    Positions are in voxels from the lower corner of the grid. A cell above which at most `mark_threshold` voxels are
    occupied becomes free, or unknown where more than `unknown_threshold` are unknown. The voxels are visited in order
    along each ray (Amanatides and Woo 1987).
    """
    height, width = costs.shape
    for i in range(ends.shape[0]):
        d = ends[i] - start
        length = math.hypot(d[0], d[1])
        if length <= 0.0:
            continue
        limit = min(max_range, length) / length
        begin = min_range / length
        if begin >= limit:
            continue
        hit = np.floor(ends[i]).astype(np.int64)
        at = np.floor(start + begin * d).astype(np.int64)
        step = np.zeros(3, np.int64)
        next_at = np.full(3, np.inf)
        along = np.full(3, np.inf)
        for axis in range(3):
            if d[axis] != 0.0:
                step[axis] = 1 if d[axis] > 0.0 else -1
                next_at[axis] = (at[axis] + (1 if d[axis] > 0.0 else 0) - start[axis]) / d[axis]
                along[axis] = abs(1.0 / d[axis])
        while True:
            if hits[i] and at[0] == hit[0] and at[1] == hit[1] and at[2] == hit[2]:
                break
            column, row, level = at[0], at[1], at[2]
            if 0 <= row < height and 0 <= column < width and 0 <= level < levels:
                keep = ~(1 << level) & 0xFFFF
                marked[row, column] &= keep
                unknown[row, column] &= keep
                if _count(marked[row, column]) <= mark_threshold:
                    many = _count(unknown[row, column]) > unknown_threshold
                    costs[row, column] = NO_INFORMATION if many else FREE_SPACE
            axis = (
                0 if next_at[0] <= next_at[1] and next_at[0] <= next_at[2] else (1 if next_at[1] <= next_at[2] else 2)
            )
            if next_at[axis] > limit:
                break
            at[axis] += step[axis]
            next_at[axis] += along[axis]


@compiled
def _count(bits: int) -> int:
    """Return how many bits are set."""
    number = 0
    while bits:
        bits &= bits - 1
        number += 1
    return number
