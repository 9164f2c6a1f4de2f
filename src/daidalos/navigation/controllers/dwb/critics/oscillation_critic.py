"""Critic that keeps a robot from going back and forth."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.contracts import NavigationContext, TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.trajectories import Trajectories


@dataclass(frozen=True)
class OscillationParameters(Parameters):
    """Parameters of the critic, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic; 0 turns it off.", minimum=0.0)
    oscillation_reset_dist: float = parameter(
        0.05, "Distance after which a robot may reverse again.", unit="m", minimum=0.0
    )
    oscillation_reset_angle: float = parameter(
        0.2, "Angle after which a robot may reverse again.", unit="rad", minimum=0.0
    )
    x_only_threshold: float = parameter(
        0.05, "Speed ahead below which turns and lateral motion may not reverse either.", unit="m/s", minimum=0.0
    )


class OscillationCritic(TrajectoryCritic):
    """Critic that forbids the reversal of a reversal, per axis, until the robot has moved or turned far enough."""

    names = ("dwb_critics::OscillationCritic", "dwb_critics::Oscillation")
    Parameters = OscillationParameters
    parameters: OscillationParameters

    def __init__(
        self, parameters: OscillationParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self.reset()

    def reset(self) -> None:
        """Implement `TrajectoryCritic.reset`."""
        self._signs = np.zeros(3)
        self._forbidden = np.zeros(3)
        self._since: Array | None = None

    def note(self, pose: Array, command: Array) -> None:
        """Implement `TrajectoryCritic.note`."""
        signs = np.sign(command)
        if abs(float(command[0])) > self.parameters.x_only_threshold:
            signs[1:] = 0.0
        reversed_axes = (signs != 0.0) & (signs == -self._signs)
        if reversed_axes.any():
            self._forbidden[reversed_axes] = self._signs[reversed_axes]
            self._since = np.array(pose)
        self._signs = np.where(signs != 0.0, signs, self._signs)
        if self._since is not None and self._has_moved(pose):
            self._forbidden[:] = 0.0
            self._since = None

    def _has_moved(self, pose: Array) -> bool:
        assert self._since is not None
        p = self.parameters
        away = math.hypot(float(pose[0] - self._since[0]), float(pose[1] - self._since[1]))
        turned = abs(float(wrap(pose[2] - self._since[2])))
        return away >= p.oscillation_reset_dist or turned >= p.oscillation_reset_angle

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        commands = trajectories.commands
        watched = np.ones(commands.shape, dtype=np.bool_)
        watched[np.abs(commands[:, 0]) > self.parameters.x_only_threshold, 1:] = False
        repeats = (watched & (self._forbidden != 0.0) & (np.sign(commands) == self._forbidden)).any(axis=1)
        return np.where(repeats, np.inf, 0.0)
