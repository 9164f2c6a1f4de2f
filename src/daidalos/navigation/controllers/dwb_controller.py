"""DWB controller: the best of the trajectories of sampled commands (dynamic window approach)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.extensions import listing
from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.navigation.contracts import (
    ControlInput,
    Controller,
    NavigationContext,
    TrajectoryCritic,
    TrajectoryScene,
)
from daidalos.navigation.controllers.dwb.trajectories import GeneratorParameters, Trajectories, generate
from daidalos.navigation.errors import NoValidControl
from daidalos.navigation.extensions import TRAJECTORY_CRITICS


@dataclass(frozen=True)
class CriticClass(Parameters):
    """Parameter that chooses the class of a critic whose name is not its class."""

    class_name: str = parameter("", "Class of the critic; its name where empty.", name="class", read_only=True)


@dataclass(frozen=True)
class DwbParameters(GeneratorParameters):
    """Parameters of the controller, by their Nav2 names."""

    critics: tuple[str, ...] = parameter(
        ("RotateToGoal", "Oscillation", "BaseObstacle", "GoalAlign", "PathAlign", "PathDist", "GoalDist"),
        "What judges trajectories.",
        not_empty=True,
        read_only=True,
    )
    classes: Mapping[str, CriticClass] = per_name(CriticClass, by="critics", at="")
    default_critic_namespaces: tuple[str, ...] = parameter(
        ("dwb_critics",), "Packages of critics that are named without one.", read_only=True
    )
    forward_prune_distance: float = parameter(2.0, "Length of path ahead that is looked at.", unit="m", above=0.0)
    xy_goal_tolerance: float = parameter(
        0.25, "Distance to the goal within which the robot stops and turns to its yaw.", unit="m", minimum=0.0
    )
    trans_stopped_velocity: float = parameter(
        0.25, "Translational speed below which the robot counts as standing.", unit="m/s", minimum=0.0
    )
    short_circuit_trajectory_evaluation: bool = parameter(
        True, "Whether critics judge only trajectories that the critics before them found possible."
    )
    debug_trajectory_details: bool = parameter(
        False, "Whether a failure names the share of trajectories that each critic found impossible."
    )


class DwbController(Controller):
    """Dynamic window approach of sampled commands, after Fox, Burgard and Thrun 1997, with Nav2's critics.

    Each cycle simulates the commands that the robot can reach for a while, lets the critics judge the trajectories and
    gives the command with the least sum. The samples hold no standing robot, so a robot that must not move fails.

    Parameters
    ----------
    parameters : DwbParameters, optional
        Velocities, samples and names of critics.
    context : NavigationContext, optional
    critics : sequence of TrajectoryCritic, optional
        The parameter `critics` names them where they are left out.
    """

    names = ("dwb_core::DWBLocalPlanner",)
    Parameters = DwbParameters
    parameters: DwbParameters

    def __init__(
        self,
        parameters: DwbParameters | None = None,
        context: NavigationContext | None = None,
        critics: Sequence[TrajectoryCritic] | None = None,
    ) -> None:
        super().__init__(parameters, context)
        self.critics = self._make_critics() if critics is None else tuple(critics)
        self.period = 1.0 / self.context.frequency
        self._share = 1.0

    def _make_critics(self) -> tuple[TrajectoryCritic, ...]:
        p = self.parameters
        made = []
        for name in p.critics:
            chosen = p.classes.get(name, CriticClass()).class_name or name
            if "::" not in chosen and "." not in chosen:
                chosen = self._with_package(chosen)
            made.append(self.context.make(TRAJECTORY_CRITICS, chosen, "critics", below=name))
        return tuple(made)

    def _with_package(self, name: str) -> str:
        """Return a critic's name with the first package that has it; the name as it is where none does."""
        known = {other for extension in listing(TRAJECTORY_CRITICS) for other in extension.names}
        candidates = (f"{package}::{name}" for package in self.parameters.default_critic_namespaces)
        return next((one for one in candidates if one in known), name)

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return self.parameters.forward_prune_distance

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        p = self.parameters
        trajectories = generate(p, control.pose, control.velocity, self.period, self._share)
        scene = TrajectoryScene(control, self.context.footprint, p.xy_goal_tolerance, p.trans_stopped_velocity)
        costs, refused = self._judge(trajectories, scene)
        if not np.isfinite(costs).any():
            raise NoValidControl(self._failure(control.pose, costs.size, refused))
        command: Array = trajectories.commands[int(np.argmin(costs))].copy()
        for critic in self.critics:
            critic.note(control.pose, command)
        return command

    def _judge(self, trajectories: Trajectories, scene: TrajectoryScene) -> tuple[Array, list[int]]:
        """Return the cost of each trajectory, and how many each critic found impossible."""
        costs = np.zeros(trajectories.counts.size)
        refused = []
        for critic in self.critics:
            possible = np.isfinite(costs)
            if self.parameters.short_circuit_trajectory_evaluation and not possible.all():
                added = np.full(costs.size, np.inf)
                added[possible] = critic.score(trajectories.subset(possible), scene)
            else:
                added = critic.score(trajectories, scene)
            refused.append(int(np.count_nonzero(possible & ~np.isfinite(added))))
            costs += added
        return costs, refused

    def _failure(self, pose: Array, number: int, refused: list[int]) -> str:
        where = f"({float(pose[0]):.2f}, {float(pose[1]):.2f})"
        if number == 0:
            return f"no command is within the robot's limits at {where}: look at its velocities and accelerations"
        details = ""
        if self.parameters.debug_trajectory_details:
            shares = (
                f"{name} {100 * count / number:.0f} %"
                for name, count in zip(self.parameters.critics, refused, strict=True)
                if count
            )
            details = f": {', '.join(shares)}"
        return f"all of {number} trajectories from {where} are impossible{details}"

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`."""
        p = self.parameters
        fastest = p.max_speed_xy if p.max_speed_xy > 0.0 else p.max_vel_x
        share = speed_limit / 100.0 if percentage else speed_limit / fastest if fastest > 0.0 else 1.0
        self._share = 1.0 if speed_limit <= 0.0 else min(share, 1.0)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        for critic in self.critics:
            critic.reset()
