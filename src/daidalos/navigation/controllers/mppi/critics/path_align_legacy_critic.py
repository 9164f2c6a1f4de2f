"""Critic of the distance between a rollout and the nearest points of the path."""

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critics.path_align_critic import PathAlignCriticParameters, is_path_followed
from daidalos.navigation.controllers.mppi.rollouts import Rollouts, Samples


class PathAlignLegacyCritic(Critic):
    """Critic of the mean distance [m] of points of a rollout to the nearest pose of the path.

    As Nav2 had it before it compared points of equal length; it draws less along the path.
    """

    names = ("mppi::critics::PathAlignLegacyCritic",)
    Parameters = PathAlignCriticParameters
    parameters: PathAlignCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        if not is_path_followed(scene, p):
            return
        path = np.ascontiguousarray(scene.control.path[: scene.furthest + 1])
        offsets = nearest_offset(
            rollouts.x, rollouts.y, rollouts.yaw, path, p.trajectory_point_step, p.use_path_orientations
        )
        p.add(rollouts, offsets)


@compiled
def nearest_offset(x: Samples, y: Samples, yaw: Samples, path: Array, stride: int, orientations: bool) -> Array:
    """Return the mean distance of points of each rollout to the nearest pose of a path."""
    means = np.zeros(x.shape[0])
    for b in range(x.shape[0]):
        count = 0
        for t in range(stride - 1, x.shape[1], stride):
            best = np.inf
            for i in range(path.shape[0]):
                ox, oy = x[b, t] - path[i, 0], y[b, t] - path[i, 1]
                squared = ox * ox + oy * oy
                if orientations:
                    turned = (yaw[b, t] - path[i, 2] + np.pi) % (2.0 * np.pi) - np.pi
                    squared += turned * turned
                best = min(best, squared)
            means[b] += np.sqrt(best)
            count += 1
        means[b] /= max(count, 1)
    return means
