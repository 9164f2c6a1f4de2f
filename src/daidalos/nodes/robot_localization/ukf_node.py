"""`ukf_node`: unscented Kalman filter of odometry, poses, velocities and inertial measurements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import Parameters, parameter
from daidalos.localization.filters.kalman import KalmanFilter, UnscentedKalmanFilter
from daidalos.nodes.parameters import declare
from daidalos.nodes.robot_localization._filter_node import FilterNode


@dataclass(frozen=True)
class UnscentedParameters(Parameters):
    """Parameters of the unscented filter's points."""

    alpha: float = parameter(0.001, "Spread of the points around the mean.", above=0.0)
    kappa: float = parameter(0.0, "Offset of the spread, above -15.", above=-15.0)
    beta: float = parameter(2.0, "What is known of the distribution; 2 where it is normal.", minimum=0.0)


class UkfNode(FilterNode):
    """Node of the unscented filter."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("ukf_filter_node", self._make, **kwargs)

    def _make(self, *settings: Any) -> KalmanFilter:
        points = declare(self, UnscentedParameters)
        return UnscentedKalmanFilter(*settings, alpha=points.alpha, kappa=points.kappa, beta=points.beta)
