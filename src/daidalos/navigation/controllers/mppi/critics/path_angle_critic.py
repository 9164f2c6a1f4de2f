"""Critic of the angle between a rollout's heading and the path."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.parameters import parameter
from daidalos.common.pose2 import between, wrap
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class PathAngleCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(2.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        0.5, "Distance to the goal above which the critic works.", unit="m", minimum=0.0
    )
    offset_from_furthest: int = parameter(
        4, "Number of path points beyond the furthest reached one that the robot should look at.", minimum=0
    )
    max_angle_to_furthest: float = parameter(
        0.785, "Angle to that point below which the critic rests.", unit="rad", minimum=0.0
    )
    mode: int = parameter(
        0,
        "What faces the point: 0 the robot's front, 1 its front or its back, 2 the side that the path's poses face.",
        minimum=0,
        maximum=2,
    )


class PathAngleCritic(Critic):
    """Critic of the angle [rad] between a rollout's last heading and the path if the robot faces away from it."""

    names = ("mppi::critics::PathAngleCritic",)
    Parameters = PathAngleCriticParameters
    parameters: PathAngleCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        if scene.control.distance_to_goal < p.threshold_to_consider:
            return
        target = scene.control.path[scene.next_free(scene.furthest + p.offset_from_furthest)]
        ahead = between(scene.control.pose, target)
        backwards = p.mode == 2 and math.cos(float(target[2] - scene.control.pose[2])) * float(ahead[0]) < 0.0
        bearing = math.atan2(float(ahead[1]), float(ahead[0]))
        if float(self._angles(np.array([bearing]), backwards)[0]) < p.max_angle_to_furthest:
            return
        bearings = np.arctan2(np.float32(target[1]) - rollouts.y[:, -1], np.float32(target[0]) - rollouts.x[:, -1])
        p.add(rollouts, self._angles(bearings - rollouts.yaw[:, -1], backwards))

    def _angles(self, bearings: NDArray[np.floating], backwards: bool) -> NDArray[np.floating]:
        """Return the angle [rad] that the robot has to turn for each bearing in its own frame."""
        angles: NDArray[np.floating] = np.abs(wrap(bearings))
        if self.parameters.mode == 1:
            angles = np.minimum(angles, np.pi - angles)
        elif backwards:
            angles = np.pi - angles
        return angles
