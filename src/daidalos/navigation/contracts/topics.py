"""Topics that extensions subscribe to and publish on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Input:
    """Topic that a costmap layer, a behaviour or a task at a waypoint subscribes to.

    Attributes
    ----------
    topic : str
        Its topic; empty for the costmap's own ``map_topic``.
    type : type
        For a layer `OccupancyGrid`, `LaserScanData`, `CloudData` or `RangeData`; for a costmap filter `FilterInfo` or
        `FilterMask`. For a behaviour `numpy.ndarray`, for a velocity (x [m/s], y [m/s], yaw [rad/s]), or `NoneType`,
        for an empty message, as for a task at a waypoint. For such a task also `numpy.ndarray`, for an image.
    take : callable
        Called with a map; or with a scan, cloud or range, the base pose at its time in the costmap's frame, and that
        time [s]; or with a velocity and the time [s]; or with nothing; or with a function that returns an image's
        pixels, shape (height, width) or (height, width, 3) for RGB, and raises `TaskFailed` where they cannot be read.
        Called with the information about a filter's mask it returns the input of that mask, or None where the filter
        cannot use it.
    latched : bool
        Whether a map that was published before it is subscribed to is wanted (durability transient local).
    """

    topic: str
    type: type
    take: Callable[..., Input | None]
    latched: bool = True


@dataclass(frozen=True)
class SpeedLimit:
    """Limit of the robot's speed.

    Attributes
    ----------
    value : float
        Speed [m/s] or percentage of the maximum; 0 for no limit.
    percentage : bool
        Whether it is a percentage.
    """

    value: float
    percentage: bool


@dataclass(frozen=True)
class Output:
    """Topic that a costmap layer or a controller publishes on.

    Attributes
    ----------
    topic : str
        Its topic.
    type : type
        For a layer `SpeedLimit`, `bool`, or `CloudData` in the costmap's frame, whose topic stands beside those of the
        costmap; for a controller see `Controller.outputs`.
    give : callable
        Called after each update of the costmap, or each cycle of a controller if there are subscribers; returns what is
        published, or None.
    """

    topic: str
    type: type
    give: Callable[[], Any]
