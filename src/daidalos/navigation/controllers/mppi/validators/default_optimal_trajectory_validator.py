"""Validator that looks for contact in the next seconds."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Scene, TrajectoryValidator
from daidalos.navigation.controllers.mppi.critics.cost_critic import contact_rule
from daidalos.navigation.costmap.costmap import LETHAL_OBSTACLE, NO_INFORMATION
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker


@dataclass(frozen=True)
class DefaultOptimalTrajectoryValidatorParameters(Parameters):
    """Parameters of the validator, by their Nav2 names."""

    collision_lookahead_time: float = parameter(2.0, "Time of the trajectory that is looked at.", unit="s", minimum=0.0)
    consider_footprint: bool = parameter(False, "Whether the footprint is checked instead of the robot's centre.")


class DefaultOptimalTrajectoryValidator(TrajectoryValidator):
    """Validator that refuses trajectories that touch an obstacle in the next seconds.

    As for the critics, a robot that is in contact already may drive away.
    """

    names = ("mppi::DefaultOptimalTrajectoryValidator",)
    Parameters = DefaultOptimalTrajectoryValidatorParameters
    parameters: DefaultOptimalTrajectoryValidatorParameters

    def is_valid(self, trajectory: Array, scene: Scene) -> bool:
        """Implement `TrajectoryValidator.is_valid`."""
        p = self.parameters
        costmap = scene.control.costmap
        outline, contact = contact_rule(scene, p.consider_footprint)
        checker = FootprintCollisionChecker(costmap, scene.footprint)
        for pose in trajectory[: math.ceil(p.collision_lookahead_time / scene.step)]:
            cost = costmap.cost_at(float(pose[0]), float(pose[1]))
            if outline.size and cost >= scene.control.circumscribed_cost and cost != NO_INFORMATION:
                cost = max(cost, checker.footprint_cost_at(pose) % NO_INFORMATION)
            if contact <= cost <= LETHAL_OBSTACLE:
                return False
        return True
