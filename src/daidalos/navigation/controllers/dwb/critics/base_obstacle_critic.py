"""Critic of the costs under the robot's centre."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.trajectories import Trajectories
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, LETHAL_OBSTACLE, NO_INFORMATION, Costs
from daidalos.navigation.costmap.footprint import outline_cost


@dataclass(frozen=True)
class ObstacleCriticParameters(Parameters):
    """Parameters of the critics of obstacles, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    sum_scores: bool = parameter(False, "Whether the costs of all poses are added, instead of the last pose's.")


class BaseObstacleCritic(TrajectoryCritic):
    """Critic of the costmap's values under the robot's centre; contact is impossible, the unknown as well."""

    names = ("dwb_critics::BaseObstacleCritic", "dwb_critics::BaseObstacle")
    Parameters = ObstacleCriticParameters
    parameters: ObstacleCriticParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        costmap = scene.control.costmap
        raw = centre_costs(
            trajectories.poses,
            trajectories.counts,
            costmap.costs,
            costmap.resolution,
            costmap.origin,
            self.parameters.sum_scores,
        )
        return self.parameters.scale * raw


class ObstacleFootprintCritic(TrajectoryCritic):
    """Critic of the costmap's values under the robot's outline; contact is impossible, the unknown as well."""

    names = ("dwb_critics::ObstacleFootprintCritic", "dwb_critics::ObstacleFootprint")
    Parameters = ObstacleCriticParameters
    parameters: ObstacleCriticParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        costmap = scene.control.costmap
        raw = footprint_costs(
            trajectories.poses,
            trajectories.counts,
            costmap.costs,
            costmap.resolution,
            costmap.origin,
            scene.footprint.polygon,
            self.parameters.sum_scores,
        )
        return self.parameters.scale * raw


@compiled
def centre_costs(
    poses: Array, counts: NDArray[np.int64], costs: Costs, resolution: float, origin: Array, sums: bool
) -> Array:
    """Return the cost of the last pose of each trajectory, or of all; infinite where one touches an obstacle."""
    totals = np.zeros(poses.shape[0])
    for k in range(poses.shape[0]):
        for t in range(counts[k]):
            column = int(np.floor((poses[k, t, 0] - origin[0]) / resolution))
            row = int(np.floor((poses[k, t, 1] - origin[1]) / resolution))
            if column < 0 or row < 0 or column >= costs.shape[1] or row >= costs.shape[0]:
                totals[k] = np.inf
                break
            cost = costs[row, column]
            if cost >= INSCRIBED_INFLATED_OBSTACLE:
                totals[k] = np.inf
                break
            totals[k] = totals[k] + cost if sums else cost
    return totals


@compiled
def footprint_costs(
    poses: Array,
    counts: NDArray[np.int64],
    costs: Costs,
    resolution: float,
    origin: Array,
    polygon: Array,
    sums: bool,
) -> Array:
    """Return what `centre_costs` does, by the largest cost under an outline."""
    totals = np.zeros(poses.shape[0])
    for k in range(poses.shape[0]):
        for t in range(counts[k]):
            x, y, yaw = poses[k, t, 0], poses[k, t, 1], poses[k, t, 2]
            cost = outline_cost(costs, resolution, origin, polygon, x, y, yaw)
            if cost in (LETHAL_OBSTACLE, NO_INFORMATION):
                totals[k] = np.inf
                break
            totals[k] = totals[k] + cost if sums else cost
    return totals
