"""`ekf_node`: extended Kalman filter of odometry, poses, velocities and inertial measurements."""

from __future__ import annotations

from typing import Any

from daidalos.localization.filters.kalman import ExtendedKalmanFilter
from daidalos.nodes.robot_localization._filter_node import FilterNode


class EkfNode(FilterNode):
    """Node of the extended filter."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("ekf_filter_node", ExtendedKalmanFilter, **kwargs)
