"""Critic of obstacles by distances: far ones repel, near ones more so, and contact ends a rollout."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critics.cost_critic import contact_rule
from daidalos.navigation.controllers.mppi.rollouts import Rollouts, Samples
from daidalos.navigation.costmap.costmap import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    MAX_NON_OBSTACLE,
    NO_INFORMATION,
    Costs,
)
from daidalos.navigation.costmap.footprint import outline_cost


@dataclass(frozen=True)
class ObstaclesCriticParameters(Parameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_power: int = parameter(1, "Power that the weighted cost is raised to.", minimum=1)
    repulsion_weight: float = parameter(1.5, "Weight of obstacles within the inflation radius.", minimum=0.0)
    critical_weight: float = parameter(20.0, "Weight of obstacles within the collision margin.", minimum=0.0)
    collision_cost: float = parameter(100_000.0, "Cost of a trajectory that collides.", minimum=0.0)
    collision_margin_distance: float = parameter(
        0.1, "Distance of obstacles below which poses are critical.", unit="m", minimum=0.0
    )
    near_goal_distance: float = parameter(
        0.5, "Distance to the goal below which only critical poses count.", unit="m", minimum=0.0
    )
    cost_scaling_factor: float = parameter(
        10.0, "The inflation layer's cost_scaling_factor, to compute distances from costs.", unit="1/m", above=0.0
    )
    inflation_radius: float = parameter(0.55, "The inflation layer's radius.", unit="m", minimum=0.0)
    consider_footprint: bool = parameter(False, "Whether the footprint is checked instead of the robot's centre.")


class ObstaclesCritic(Critic):
    """Critic of the distances [m] of a rollout's poses to obstacles.

    Distances come from the costs of inflation, ``cost = 252 exp(-scaling (distance - inscribed radius))``, and are
    those of the inscribed circle's edge. The mean of what an obstacle lies within the inflation radius weighs
    `repulsion_weight`, the sum of what it lies within the collision margin `critical_weight`.
    """

    names = ("mppi::critics::ObstaclesCritic",)
    judges_contact = True
    Parameters = ObstaclesCriticParameters
    parameters: ObstaclesCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        costmap = scene.control.costmap
        costs = np.arange(1, MAX_NON_OBSTACLE + 1)
        distances = np.full(256, p.inflation_radius)
        distances[1 : MAX_NON_OBSTACLE + 1] = np.log(MAX_NON_OBSTACLE / costs) / p.cost_scaling_factor
        distances[INSCRIBED_INFLATED_OBSTACLE:NO_INFORMATION] = 0.0
        outline, contact = contact_rule(scene, p.consider_footprint)
        repulsion = 0.0 if scene.control.distance_to_goal < p.near_goal_distance else p.repulsion_weight
        added = cost_of_distances(
            rollouts.x,
            rollouts.y,
            rollouts.yaw,
            costmap.costs,
            costmap.resolution,
            costmap.origin,
            outline,
            max(scene.control.circumscribed_cost, 1),
            contact,
            distances,
            np.array([p.inflation_radius, p.collision_margin_distance, repulsion, p.critical_weight]),
            rollouts.collides,
        )
        rollouts.costs[:] += np.where(rollouts.collides, p.collision_cost, added**p.cost_power).astype(np.float32)


@compiled
def cost_of_distances(
    x: Samples,
    y: Samples,
    yaw: Samples,
    costs: Costs,
    resolution: float,
    origin: Array,
    outline: Array,
    circumscribed_cost: int,
    contact: int,
    distances: Array,
    weights: Array,
    collides: NDArray[np.bool_],
) -> Array:
    """Return the weighted cost of each rollout that touches nothing; set `collides` of the others."""
    radius, margin, repulsion, critical = weights
    height, width = costs.shape
    totals = np.zeros(x.shape[0])
    for b in range(x.shape[0]):
        repelled = critically = 0.0
        for t in range(x.shape[1]):
            column = math.floor((x[b, t] - origin[0]) / resolution)
            row = math.floor((y[b, t] - origin[1]) / resolution)
            if column < 0 or row < 0 or column >= width or row >= height:
                continue
            cost = int(costs[row, column])
            if outline.shape[0] > 0 and circumscribed_cost <= cost < INSCRIBED_INFLATED_OBSTACLE:
                under = outline_cost(costs, resolution, origin, outline, x[b, t], y[b, t], yaw[b, t])
                if under == LETHAL_OBSTACLE:
                    cost = under
            if contact <= cost < NO_INFORMATION:
                collides[b] = True
                break
            if cost == 0 or cost == NO_INFORMATION:
                continue
            repelled += max(radius - distances[cost], 0.0)
            critically += max(margin - distances[cost], 0.0)
        totals[b] = critical * critically + repulsion * repelled / x.shape[1]
    return totals
