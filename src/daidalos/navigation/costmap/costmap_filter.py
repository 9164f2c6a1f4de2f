"""Base of costmap filters: what they share about their masks."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import compose, inverse, transform_points
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import Bounds, Costmap, CostmapError, Window

KEEPOUT, SPEED_PERCENT, SPEED_ABSOLUTE, BINARY = range(4)
"""Kinds of filters in `nav2_msgs/CostmapFilterInfo`."""
UNKNOWN = -1
"""Value of a mask, or outside of it, that says nothing."""
_PATIENCE_S = 2.0
"""Time [s] from the first update after which a filter without a mask is reported."""


@dataclass(frozen=True)
class CostmapFilterParameters(Parameters):
    """Parameters of all costmap filters, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the filter is used.")
    filter_info_topic: str = parameter(
        "costmap_filter_info", "Topic of the information about the mask.", not_empty=True, read_only=True
    )
    transform_tolerance: float = parameter(
        0.1, "Age of the transform to the mask's frame from which a warning is logged.", unit="s", minimum=0.0
    )


@dataclass(frozen=True)
class FilterInfo:
    """Meaning and topic of a mask, as `nav2_msgs/CostmapFilterInfo` carries them.

    Attributes
    ----------
    type : int
        Kind of filter.
    mask_topic : str
        Topic of the mask.
    base, multiplier : float
        A value v of the mask stands for base + multiplier * v.
    """

    type: int
    mask_topic: str
    base: float = 0.0
    multiplier: float = 1.0


@dataclass(frozen=True)
class FilterMask:
    """Mask of a filter.

    Attributes
    ----------
    grid : OccupancyGrid
        Values from 0 to 100; -1 says nothing.
    frame : str
        Frame of the grid's origin.
    """

    grid: OccupancyGrid
    frame: str


class CostmapFilter(Layer):
    """Layer of a costmap's `filters`, whose effect a mask gives for each place.

    While the transform to the mask's frame is late or missing, the last one is used.

    Attributes
    ----------
    types : tuple of int
        Class attribute: the types of `FilterInfo` that the filter takes.
    info : FilterInfo or None
        The last information.
    """

    types: ClassVar[tuple[int, ...]]
    parameters: CostmapFilterParameters

    def __init__(
        self, parameters: CostmapFilterParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self.info: FilterInfo | None = None
        self._mask: FilterMask | None = None
        self._place: Array | None = None
        self._first_update = math.inf
        self._warned: set[str] = set()

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        return (Input(self.parameters.filter_info_topic, FilterInfo, self.set_info),)

    def set_info(self, info: FilterInfo) -> Input | None:
        """Set the meaning of the mask and return the input of the mask, or None where the filter cannot use it."""
        if info.type not in self.types:
            expected = " or ".join(map(str, self.types))
            self.warn(f"filter info of type {info.type} is not used, but only type {expected}")
            return None
        if not (info.mask_topic and math.isfinite(info.base) and math.isfinite(info.multiplier)):
            self.warn(
                "filter info without a mask's topic, or with a base or multiplier that is not finite, is not used"
            )
            return None
        self.info = info
        return Input(info.mask_topic, FilterMask, self.set_mask)

    def set_mask(self, mask: FilterMask) -> None:
        """Set the mask.

        Raises
        ------
        CostmapError
            The mask has no cells.
        """
        if mask.grid.data.size == 0:
            raise CostmapError(f"{self.context.name}: the mask has no cells")
        if self._mask is None or self._mask.frame != mask.frame:
            self._place = None
        self._mask = mask

    def warn(self, problem: str) -> None:
        """Log a problem, each only once."""
        if problem not in self._warned:
            self._warned.add(problem)
            self.context.warn(f"{self.context.name}: {problem}")

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Implement `Layer.update_bounds` for filters with a mask; see `process`."""
        if self._mask is None:
            self._first_update = min(now, self._first_update)
            if now - self._first_update >= _PATIENCE_S:
                self.warn(self._missing_mask())
            return bounds
        self._find_place(self._mask)
        return bounds if self._place is None else self.process(robot_pose, bounds)

    @abstractmethod
    def process(self, robot_pose: Array, bounds: Bounds) -> Bounds:
        """Take the robot's pose (x, y, yaw) into account and return the bounds of what must be updated."""

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Leave the costs as they are."""

    def mask_values(self, costmap: Costmap, window: Window) -> NDArray[np.int8] | None:
        """Return the mask's values at the cells of a window; None while the mask or its place is not known."""
        if self._mask is None or self._place is None:
            return None
        columns = np.arange(window.left, window.right) + 0.5
        rows = np.arange(window.bottom, window.top) + 0.5
        x = costmap.origin[0] + columns * costmap.resolution
        y = costmap.origin[1] + rows * costmap.resolution
        points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return self._values_at(self._mask, points).reshape(rows.size, columns.size)

    def value_at(self, pose: Array) -> int | None:
        """Return the mask's value at a pose (x, y, yaw) of the costmap's frame; None outside of the mask."""
        if self._mask is None or self._place is None:
            return None
        grid = self._mask.grid
        x, y = transform_points(inverse(self._place), np.array([pose[:2]]))[0] / grid.resolution
        if not (0.0 <= x < grid.data.shape[1] and 0.0 <= y < grid.data.shape[0]):
            return None
        return int(grid.data[int(y), int(x)])

    def _values_at(self, mask: FilterMask, points: Array) -> NDArray[np.int8]:
        """Return the mask's values at points (n, 2) of the costmap's frame; unknown outside of the mask."""
        data = mask.grid.data
        cells = np.floor(transform_points(inverse(self._place), points) / mask.grid.resolution)  # type: ignore[arg-type]
        inside = ((cells >= 0) & (cells < (data.shape[1], data.shape[0]))).all(axis=1)
        values = np.full(points.shape[0], UNKNOWN, dtype=np.int8)
        column, row = cells[inside].astype(np.int64).T
        values[inside] = data[row, column]
        return values

    def _find_place(self, mask: FilterMask) -> None:
        """Find the pose of the mask's grid in the costmap's frame."""
        pose: Any = np.zeros(3)
        if mask.frame not in ("", self.context.global_frame):
            found = self.context.locate(mask.frame)
            if found is None:
                self.warn(f"there is no transform from the mask's frame '{mask.frame}' to {self.context.global_frame}")
                return
            pose, age = found
            if age > self.parameters.transform_tolerance:
                self.warn(
                    f"the transform from the mask's frame '{mask.frame}' to {self.context.global_frame} is older than "
                    f"transform_tolerance {self.parameters.transform_tolerance:g} s; the last one is used"
                )
        self._place = compose(pose, np.array(mask.grid.origin))

    def _missing_mask(self) -> str:
        if self.info is None:
            return f"there is no mask: no nav2_msgs/msg/CostmapFilterInfo came on {self.parameters.filter_info_topic}"
        return f"there is no mask: no nav_msgs/msg/OccupancyGrid came on {self.info.mask_topic}"
