"""Approach to docks and staging poses: the control law, and a look along its path."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.controllers.ego_polar import EgoPolarLaw
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker

_ARRIVED = 0.01
"""Distance [m] from the target at which a projected path ends."""


@dataclass(frozen=True)
class ApproachParameters(Parameters):
    """Parameters below `controller`, by their Nav2 names."""

    k_phi: float = parameter(3.0, "Ratio of the rates of angle and distance; see `EgoPolarLaw`.", minimum=0.0)
    k_delta: float = parameter(2.0, "How fast the robot turns to the curve.", minimum=0.0)
    beta: float = parameter(0.4, "How much the speed falls with the curvature.", minimum=0.0)
    lambda_: float = parameter(2.0, "Exponent of the curvature.", minimum=0.0, name="lambda")
    v_linear_min: float = parameter(0.1, "Least speed.", unit="m/s", above=0.0)
    v_linear_max: float = parameter(0.25, "Largest speed.", unit="m/s", above=0.0)
    v_angular_max: float = parameter(0.75, "Largest turn rate.", unit="rad/s", above=0.0)
    slowdown_radius: float = parameter(0.25, "Distance at which the speed begins to fall.", unit="m", minimum=0.0)
    rotate_to_heading_angular_vel: float = parameter(1.0, "Turn rate in place.", unit="rad/s", above=0.0)
    rotate_to_heading_max_angular_accel: float = parameter(
        3.2, "Its largest change in a second.", unit="rad/s^2", above=0.0
    )
    use_collision_detection: bool = parameter(True, "Whether obstacles on the path stop the robot.", read_only=True)
    costmap_topic: str = parameter("local_costmap/costmap_raw", "Topic of the costmap.", not_empty=True, read_only=True)
    footprint_topic: str = parameter(
        "local_costmap/published_footprint", "Topic of the robot's outline.", not_empty=True, read_only=True
    )
    projection_time: float = parameter(5.0, "How far ahead obstacles are looked for.", unit="s", minimum=0.0)
    simulation_time_step: float = parameter(0.1, "Step of that look.", unit="s", above=0.0)
    dock_collision_threshold: float = parameter(
        0.3, "Distance from the dock within which obstacles are the dock.", unit="m", minimum=0.0
    )

    @property
    def law(self) -> EgoPolarLaw:
        """The control law."""
        return EgoPolarLaw(
            self.k_phi, self.k_delta, self.beta, self.lambda_, self.slowdown_radius,
            min(self.v_linear_min, self.v_linear_max), self.v_linear_max, self.v_angular_max,
        )  # fmt: skip


def projected_path(p: ApproachParameters, robot: Array, target: Array, *, backward: bool) -> Array:
    """Return poses (n, 3) that the control law leads to within `projection_time`, from the robot's on."""
    law, poses = p.law, [np.asarray(robot, float)]
    for _ in range(math.ceil(p.projection_time / p.simulation_time_step)):
        poses.append(law.next_pose(poses[-1], target, p.simulation_time_step, backward=backward))
        if float(np.hypot(*(target - poses[-1])[:2])) < _ARRIVED:
            break
    return np.array(poses)


def obstacle_on(path: Array, costmap: Costmap, footprint: Footprint, dock: Array, threshold: float) -> Array | None:
    """Return the first pose of a path at which the robot would touch an obstacle; None where it is free.

    Parameters
    ----------
    path : ndarray, shape (n, 3)
        In the costmap's frame.
    costmap : Costmap
    footprint : Footprint
    dock : ndarray, shape (3,)
        Poses nearer to this one than the threshold are not looked at: what is there is the dock.
    threshold : float
    """
    checker = FootprintCollisionChecker(costmap, footprint)
    for pose in path[1:]:
        if float(np.hypot(*(pose - dock)[:2])) > threshold and checker.in_collision(pose):
            at: Array = pose
            return at
    return None
