"""Critics of the distance from the end of the path in the costmap: of the robot, and of a point before it."""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.contracts import TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.critics.path_critics import AlignParameters, path_inside
from daidalos.navigation.controllers.dwb.map_grid import MapGridParameters, scores
from daidalos.navigation.controllers.dwb.trajectories import Trajectories


class GoalDistCritic(TrajectoryCritic):
    """Critic of the number of cells between the end of a trajectory and the path's last point in the costmap."""

    names = ("dwb_critics::GoalDistCritic", "dwb_critics::GoalDist")
    Parameters = MapGridParameters
    parameters: MapGridParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        costmap = scene.control.costmap
        return scores(trajectories, costmap, path_inside(scene.control.path, costmap)[-1:], self.parameters)


class GoalAlignCritic(TrajectoryCritic):
    """Critic of the number of cells between a point before the robot and one as far beyond the goal.

    The goal is moved on along the line from the robot, so that the robot looks towards it.
    """

    names = ("dwb_critics::GoalAlignCritic", "dwb_critics::GoalAlign")
    Parameters = AlignParameters
    parameters: AlignParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        p, control = self.parameters, scene.control
        end = path_inside(control.path, control.costmap)[-1:]
        if end.size:
            x, y = (float(value) for value in end[0] - control.pose[:2])
            angle = math.atan2(y, x)
            end = end + p.forward_point_distance * np.array([math.cos(angle), math.sin(angle)])
        return scores(trajectories, control.costmap, end, p, ahead=p.forward_point_distance, stops=False)
