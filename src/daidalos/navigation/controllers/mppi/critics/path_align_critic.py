"""Critic of the distance between a rollout and the path, point by point."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts, Samples


@dataclass(frozen=True)
class PathAlignCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(10.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        0.5, "Distance to the goal above which the critic works.", unit="m", minimum=0.0
    )
    offset_from_furthest: int = parameter(
        6, "Number of path points that trajectories have to reach for the critic to work.", minimum=0
    )
    max_path_occupancy_ratio: float = parameter(
        0.07, "Share of the path behind obstacles above which the critic rests.", minimum=0.0, maximum=1.0
    )
    trajectory_point_step: int = parameter(4, "Step between the poses of a trajectory that are compared.", minimum=1)
    use_path_orientations: bool = parameter(False, "Whether angles to the path's orientations are added as lengths.")


class PathAlignCritic(Critic):
    """Critic of the mean distance [m] between points of a rollout and of the path at the same length.

    Silent where the goal is near, where the rollouts do not get far (the robot is about to turn), and where
    the path is blocked, so that the robot may leave it.
    """

    names = ("mppi::critics::PathAlignCritic",)
    Parameters = PathAlignCriticParameters
    parameters: PathAlignCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        if not is_path_followed(scene, p):
            return
        offsets = mean_offset(
            rollouts.x,
            rollouts.y,
            rollouts.yaw,
            np.ascontiguousarray(scene.control.pose),
            np.ascontiguousarray(scene.control.path),
            scene.along,
            p.trajectory_point_step,
            p.use_path_orientations,
        )
        p.add(rollouts, offsets)


def is_path_followed(scene: Scene, parameters: PathAlignCriticParameters) -> bool:
    """Return whether rollouts are to keep to the path: not near the goal, before a turn, or where it is blocked."""
    p = parameters
    if scene.control.distance_to_goal < p.threshold_to_consider or scene.furthest < p.offset_from_furthest:
        return False
    blocked = 1.0 - float(scene.path_free[: scene.furthest + 1].mean())
    return blocked <= p.max_path_occupancy_ratio


@compiled
def mean_offset(
    x: Samples,
    y: Samples,
    yaw: Samples,
    start: Array,
    path: Array,
    along: Array,
    stride: int,
    orientations: bool,
) -> Array:
    """Return the mean distance of rollouts to the path, matched by travelled length."""
    means = np.zeros(x.shape[0])
    last = path.shape[0] - 1
    for b in range(x.shape[0]):
        added = 0.0
        count = 0
        travelled = 0.0
        px, py = start[0], start[1]
        i = 0
        for t in range(stride - 1, x.shape[1], stride):
            dx, dy = x[b, t] - px, y[b, t] - py
            travelled += np.sqrt(dx * dx + dy * dy)
            px, py = float(x[b, t]), float(y[b, t])
            while i < last and along[i] < travelled:
                i += 1
            ox, oy = px - path[i, 0], py - path[i, 1]
            squared = ox * ox + oy * oy
            if orientations:
                turned = (yaw[b, t] - path[i, 2] + np.pi) % (2.0 * np.pi) - np.pi
                squared += turned * turned
            added += np.sqrt(squared)
            count += 1
            if i == last:
                break
        if count > 0:
            means[b] = added / count
    return means
