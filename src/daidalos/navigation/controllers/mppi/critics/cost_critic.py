"""Critic of obstacles: the costmap's values under a rollout, and a high cost for collisions."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Critic, NavigationContext, Scene
from daidalos.navigation.controllers.mppi.rollouts import Rollouts, Samples
from daidalos.navigation.costmap.costmap import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Costs,
)
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker, outline_cost


@dataclass(frozen=True)
class CostCriticParameters(Parameters):
    """Parameters of the critic, by their Nav2 names.

    The power is not Nav2's: raised to the third, cells near to contact weigh much and the middle of a door
    little.
    """

    cost_weight: float = parameter(10.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    cost_power: int = parameter(3, "Power that the cost of a cell is raised to.", minimum=1)
    near_collision_cost: int = parameter(
        253, "Cost of a cell from which on a pose there costs `critical_cost`.", minimum=1, maximum=254
    )
    critical_cost: float = parameter(300.0, "Cost of a pose within the inscribed radius of obstacles.", minimum=0.0)
    collision_cost: float = parameter(1_000_000.0, "Cost of a trajectory that collides.", minimum=0.0)
    near_goal_distance: float = parameter(
        0.5, "Distance to the goal below which only collisions count.", unit="m", minimum=0.0
    )
    consider_footprint: bool = parameter(False, "Whether the footprint is checked instead of the robot's centre.")
    trajectory_point_step: int = parameter(2, "Step between the poses of a trajectory that are checked.", minimum=1)


def contact_rule(scene: Scene, consider_footprint: bool) -> tuple[Array, int]:
    """Return the outline to check for contact, and the cost of a cell from which on its centre is in contact.

    A robot that is in contact already, by noise or by an obstacle that came, may drive away: only the obstacle
    itself counts for it.

    Parameters
    ----------
    scene : Scene
        Costmap, footprint and pose of the robot.
    consider_footprint : bool
        Whether the footprint is checked instead of the robot's centre.
    """
    if FootprintCollisionChecker(scene.control.costmap, scene.footprint).in_collision(scene.control.pose):
        return NO_OUTLINE, LETHAL_OBSTACLE
    is_outline_checked = consider_footprint and not scene.footprint.circular
    return scene.footprint.polygon if is_outline_checked else NO_OUTLINE, INSCRIBED_INFLATED_OBSTACLE


class CostCritic(Critic):
    """Critic of the mean cost of the cells that the robot's centre crosses, relative to a lethal cost.

    Near to the goal only what costs more than the goal counts, so that goals inside of inflation are reached.
    A robot that stands too near to an obstacle already, by noise or by an obstacle that came, may drive away:
    until it is farther off, only the obstacle itself counts as contact.
    """

    names = ("mppi::critics::CostCritic",)
    judges_contact = True

    Parameters = CostCriticParameters

    def __init__(
        self, parameters: CostCriticParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self.reconfigure(self.parameters)

    def reconfigure(self, parameters: CostCriticParameters) -> None:
        """Implement `NavigationExtension.reconfigure`."""
        super().reconfigure(parameters)
        self._price = parameters.cost_weight * (np.arange(256) / LETHAL_OBSTACLE) ** parameters.cost_power
        self._price[parameters.near_collision_cost : NO_INFORMATION] = parameters.critical_cost
        self._price[NO_INFORMATION] = 0.0

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        costmap = scene.control.costmap
        tolerated = 0
        if scene.control.distance_to_goal < p.near_goal_distance:
            tolerated = costmap.cost_at(float(scene.control.goal[0]), float(scene.control.goal[1]))
        price = self._price - self._price[tolerated]
        outline, contact = contact_rule(scene, p.consider_footprint)
        cost_of_cells(
            rollouts.x,
            rollouts.y,
            rollouts.yaw,
            costmap.costs,
            costmap.resolution,
            costmap.origin,
            outline,
            max(scene.control.circumscribed_cost, 1),
            contact,
            p.trajectory_point_step,
            price,
            p.collision_cost,
            rollouts.costs,
            rollouts.collides,
        )


NO_OUTLINE: Array = np.zeros((0, 2))


@compiled
def cost_of_cells(
    x: Samples,
    y: Samples,
    yaw: Samples,
    costs: Costs,
    resolution: float,
    origin: Array,
    outline: Array,
    circumscribed_cost: int,
    contact: int,
    stride: int,
    price: Array,
    collision: float,
    total: Samples,
    collides: NDArray[np.bool_],
) -> None:
    """Add the mean weighted cost under each rollout to `total`; collisions end a rollout and set `collides`."""
    scale = 1.0 / resolution
    height, width = costs.shape
    count = (x.shape[1] + stride - 1) // stride
    for b in range(x.shape[0]):
        added = 0.0
        for t in range(x.shape[1] - 1 - (count - 1) * stride, x.shape[1], stride):
            column = int((x[b, t] - origin[0]) * scale)
            row = int((y[b, t] - origin[1]) * scale)
            if column < 0 or row < 0 or column >= width or row >= height:
                continue
            cost = int(costs[row, column])
            if outline.shape[0] > 0 and circumscribed_cost <= cost < INSCRIBED_INFLATED_OBSTACLE:
                under = outline_cost(costs, resolution, origin, outline, x[b, t], y[b, t], yaw[b, t])
                if under == LETHAL_OBSTACLE:
                    cost = under
            if contact <= cost < NO_INFORMATION:
                collides[b] = True
                added += collision * (1.0 - 0.5 * t / x.shape[1])
                break
            added += max(price[cost], 0.0)
        total[b] += np.float32(added / count) if not collides[b] else np.float32(added)
