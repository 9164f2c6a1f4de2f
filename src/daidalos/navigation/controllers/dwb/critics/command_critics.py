"""Critics of commands alone: preference of driving ahead, and of little turning."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.trajectories import Trajectories


@dataclass(frozen=True)
class PreferForwardParameters(Parameters):
    """Parameters of the critic, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    penalty: float = parameter(1.0, "Cost of driving backwards, and of turning nearly on the spot.", minimum=0.0)
    strafe_x: float = parameter(0.1, "Velocity ahead below which a robot turns on the spot.", unit="m/s")
    strafe_theta: float = parameter(0.2, "Turn rate below which a robot hardly turns.", unit="rad/s")
    theta_scale: float = parameter(10.0, "Cost of the turn rate.", unit="s/rad", minimum=0.0)


class PreferForwardCritic(TrajectoryCritic):
    """Critic of driving backwards, of hardly moving, and of the turn rate."""

    names = ("dwb_critics::PreferForwardCritic", "dwb_critics::PreferForward")
    Parameters = PreferForwardParameters
    parameters: PreferForwardParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        p = self.parameters
        ahead, turns = trajectories.commands[:, 0], np.abs(trajectories.commands[:, 2])
        penalized = (ahead < 0.0) | ((ahead < p.strafe_x) & (turns < p.strafe_theta))
        return p.scale * np.where(penalized, p.penalty, p.theta_scale * turns)


@dataclass(frozen=True)
class TwirlingParameters(Parameters):
    """Parameters of the critic, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)


class TwirlingCritic(TrajectoryCritic):
    """Critic of the absolute turn rate [rad/s]."""

    names = ("dwb_critics::TwirlingCritic", "dwb_critics::Twirling")
    Parameters = TwirlingParameters
    parameters: TwirlingParameters

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        return self.parameters.scale * np.abs(trajectories.commands[:, 2])
