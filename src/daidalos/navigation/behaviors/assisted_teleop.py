"""Behavior that passes a person's velocities on, slower before obstacles."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.behaviors.collision import time_to_contact
from daidalos.navigation.contracts import Behavior, BehaviorStep, Input, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import InvalidInput, TimedOut


@dataclass(frozen=True)
class AssistedTeleopParameters(Parameters):
    """Parameters of the behaviour, by their Nav2 names; `command_timeout` is ours."""

    projection_time: float = parameter(1.0, "How far ahead a velocity is checked for collisions.", unit="s", above=0.0)
    simulation_time_step: float = parameter(0.1, "Time between two poses that are checked.", unit="s", above=0.0)
    cmd_vel_teleop: str = parameter(
        "cmd_vel_teleop", "Topic of the person's velocities.", not_empty=True, read_only=True
    )
    command_timeout: float = parameter(
        0.5, "Age of the person's last velocity from which the robot stands.", unit="s", above=0.0
    )


class AssistedTeleop(Behavior[float]):
    """Behavior that drives as a person does, and slows down so that no obstacle is touched.

    A velocity that would lead to a contact within `projection_time` is scaled by the part of that time until the
    contact. It succeeds when a message comes on ``preempt_teleop``, and fails when its time is over. Its command is
    the time allowance [s]; 0 for no limit.
    """

    names = ("nav2_behaviors::AssistedTeleop",)
    Parameters = AssistedTeleopParameters
    parameters: AssistedTeleopParameters
    action = "nav2_msgs/action/AssistedTeleop"
    feedback = "current_teleop_duration"

    def __init__(
        self, parameters: AssistedTeleopParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._time_allowance = 0.0
        self._begun = 0.0
        self._command = np.zeros(3)
        self._commanded = -np.inf
        self._is_ended = False

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Behavior.inputs`."""
        return (
            Input(self.parameters.cmd_vel_teleop, np.ndarray, self.add_command),
            Input("preempt_teleop", type(None), self.end),
        )

    @classmethod
    def command(cls, goal: Any) -> float:
        """Implement `Behavior.command`."""
        return float(goal.time_allowance)

    def add_command(self, velocity: Array, now: float) -> None:
        """Take a velocity (x, y, yaw) of the person at a time [s]; one that is not finite stops the robot."""
        self._command = velocity if np.isfinite(velocity).all() else np.zeros(3)
        self._commanded = now

    def end(self) -> None:
        """End the behaviour at its next cycle."""
        self._is_ended = True

    def start(self, command: float, pose: Array, now: float) -> None:
        """Implement `Behavior.start`."""
        if not command >= 0.0:
            raise InvalidInput(f"time_allowance must not be negative, but is {command} s")
        self._time_allowance, self._begun = command, now
        self._commanded = -np.inf
        self._is_ended = False

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Implement `Behavior.step`."""
        p = self.parameters
        passed = now - self._begun
        if self._is_ended:
            return BehaviorStep(np.zeros(3), True, passed)
        if self._time_allowance and passed > self._time_allowance:
            raise TimedOut(f"the time allowance of {self._time_allowance:g} s is over")
        if not 0.0 <= now - self._commanded <= p.command_timeout or not self._command.any():
            return BehaviorStep(np.zeros(3), False, passed)
        free = time_to_contact(
            costmap, self.context.footprint, pose, self._command, p.projection_time, p.simulation_time_step
        )
        return BehaviorStep(self._command * (free / p.projection_time), False, passed)
