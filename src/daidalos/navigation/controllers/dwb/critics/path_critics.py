"""Critics of the distance from the path: of the robot, and of a point before it."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.map_grid import MapGridParameters, scores
from daidalos.navigation.controllers.dwb.trajectories import Trajectories
from daidalos.navigation.costmap.costmap import Costmap


@dataclass(frozen=True)
class AlignParameters(MapGridParameters):
    """Parameters of critics of a point before the robot, by their Nav2 names."""

    forward_point_distance: float = parameter(0.325, "Distance of the point that is judged.", unit="m")


class PathDistCritic(TrajectoryCritic):
    """Critic of the number of cells between the path and the end of a trajectory."""

    names = ("dwb_critics::PathDistCritic", "dwb_critics::PathDist")
    Parameters = MapGridParameters
    parameters: MapGridParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        costmap = scene.control.costmap
        return scores(trajectories, costmap, path_inside(scene.control.path, costmap), self.parameters)


class PathAlignCritic(TrajectoryCritic):
    """Critic of the number of cells between the path and a point before the robot at the end of a trajectory.

    It draws the robot's front to the path, and rests where the goal is nearer than the point.
    """

    names = ("dwb_critics::PathAlignCritic", "dwb_critics::PathAlign")
    Parameters = AlignParameters
    parameters: AlignParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        p, costmap = self.parameters, scene.control.costmap
        away = scene.control.goal[:2] - scene.control.pose[:2]
        if math.hypot(float(away[0]), float(away[1])) < p.forward_point_distance:
            return np.zeros(trajectories.counts.size)
        path = path_inside(scene.control.path, costmap)
        return scores(trajectories, costmap, path, p, ahead=p.forward_point_distance, stops=False)


def path_inside(path: Array, costmap: Costmap) -> Array:
    """Return points (n, 2) of a path, a cell apart at most, from where it enters a costmap until it leaves it."""
    points = path[:, :2]
    steps = np.hypot(*np.diff(points, axis=0).T)
    if (steps > costmap.resolution).any():
        along = np.concatenate([[0.0], np.cumsum(steps)])
        at = np.union1d(along, np.arange(0.0, along[-1], costmap.resolution))
        points = np.stack([np.interp(at, along, points[:, axis]) for axis in range(2)], axis=-1)
    cells = np.floor((points - costmap.origin) / costmap.resolution)
    inside = np.all((cells >= 0) & (cells < (costmap.width, costmap.height)), axis=1)
    if not inside.any():
        return points[:0]
    first = int(np.argmax(inside))
    outside = np.flatnonzero(~inside[first:])
    return points[first : first + int(outside[0])] if outside.size else points[first:]
