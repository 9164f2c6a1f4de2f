"""Gripper controllers: move until the goal is reached or the gripper stalls."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.common.rate_gate import RateGate
from daidalos.control.contracts import Action, Controller, Goal
from daidalos.control.pid import Gains, Pid
from daidalos.samples.controllers import GripperRequest, GripperState, ParallelGripperRequest
from daidalos.samples.sensors import Sample

_ACTION = "~/gripper_cmd"


@dataclass(frozen=True)
class GripperParameters(Parameters):
    """Parameters of the gripper controllers, with ROS's names."""

    joint: str = parameter("", "Joint that opens and closes.", not_empty=True, read_only=True)
    action_monitor_rate: float = parameter(
        20.0, "How often a goal gives feedback.", unit="Hz", minimum=0.1, read_only=True
    )
    goal_tolerance: float = parameter(
        0.01, "Distance to the goal that counts as reached.", unit="m or rad", minimum=0.0
    )
    max_effort: float = parameter(
        0.0, "Largest effort where a goal names none; 0 for no limit.", unit="N or N m", minimum=0.0
    )
    allow_stalling: bool = parameter(False, "Whether a goal succeeds when the gripper stalls on an object.")
    stall_velocity_threshold: float = parameter(
        0.001, "Velocity below which the gripper may be stalled.", unit="m/s or rad/s", minimum=0.0
    )
    stall_timeout: float = parameter(
        1.0, "How long the gripper has to be that slow to count as stalled.", unit="s", minimum=0.0
    )
    gains: dict[str, Gains] = per_name(Gains, by="joint")


@dataclass(frozen=True)
class ParallelGripperParameters(GripperParameters):
    """Parameters of the parallel gripper, with interfaces for the maximum effort and speed."""

    max_effort: float = parameter(
        10.0, "Largest effort where a goal names none; 0 for no limit.", unit="N or N m", minimum=0.0
    )
    max_effort_interface: str = parameter(
        "", "Full name of the interface for the largest effort; empty for none.", read_only=True
    )
    max_velocity_interface: str = parameter(
        "", "Full name of the interface for the largest velocity; empty for none.", read_only=True
    )
    max_velocity: float = parameter(0.1, "Largest velocity where a goal names none.", unit="m/s or rad/s", minimum=0.0)
    state_interfaces: tuple[str, ...] = parameter(
        ("position", "velocity"), "Interfaces that are measured.", read_only=True
    )


class PositionGripperController(Controller):
    """Position controller of a gripper."""

    names = ("position_controllers/GripperActionController",)
    Parameters = GripperParameters
    command_kind = "position"
    request: ClassVar[type[GripperRequest]] = GripperRequest
    parameters: GripperParameters

    def configure(self) -> None:
        """Set the interface names."""
        self.command_names = (f"{self.parameters.joint}/{self.command_kind}",)
        self.state_names = (f"{self.parameters.joint}/position", f"{self.parameters.joint}/velocity")
        self._monitor = RateGate(self.parameters.action_monitor_rate)
        self._goal: Goal | None = None

    @property
    def actions(self) -> Mapping[str, Action]:
        """Action of the gripper."""
        return {_ACTION: Action(self.request, self._refuse, self._start, self._cancel)}

    def _refuse(self, request: GripperRequest) -> str:
        if not math.isfinite(request.position):
            return f"the position is not a number: {request.position}"
        joint, named = self.parameters.joint, request.joint if isinstance(request, ParallelGripperRequest) else ""
        return f"'{named}' is not the gripper's joint, '{joint}' is" if named not in ("", joint) else ""

    def _start(self, goal: Goal) -> None:
        self._end("aborted")
        self._goal = goal
        self._target = goal.request.position
        self._effort = goal.request.max_effort or self.parameters.max_effort or math.inf
        self._moved_ns = self.now_ns
        self._monitor.restart()

    def _cancel(self, goal: Goal) -> None:
        if goal is self._goal:
            self._hold()
            self._end("canceled")

    def activate(self, now_ns: int) -> None:
        """Hold the finger at its position."""
        self.now_ns = now_ns
        self._effort, self._output = self.parameters.max_effort or math.inf, 0.0
        self._hold()

    def deactivate(self) -> None:
        """Cancel the goal."""
        self._end("aborted")

    def _hold(self) -> None:
        self._target = float(self.states.read()[0])

    def _end(self, status: str, stalled: bool = False, reached: bool = False) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            goal.finish(status, self._state(stalled, reached))

    def _state(self, stalled: bool, reached: bool) -> GripperState:
        position, velocity = map(float, self.states.read())
        return GripperState(self.now_ns, self.parameters.joint, position, velocity, self._output, stalled, reached)

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Command the finger, and check the goal."""
        position, velocity = self.states.read()
        self._watch(now_ns, self._target - float(position), abs(float(velocity)))
        self._command(self._target - float(position), -float(velocity), period)
        return ()

    def _watch(self, now_ns: int, error: float, speed: float) -> None:
        if speed > self.parameters.stall_velocity_threshold:
            self._moved_ns = now_ns
        if self._goal is None:
            return
        if abs(error) < self.parameters.goal_tolerance:
            self._end("succeeded", reached=True)
        elif (now_ns - self._moved_ns) * 1e-9 > self.parameters.stall_timeout:
            self._end("succeeded" if self.parameters.allow_stalling else "aborted", stalled=True)
        elif self._monitor.is_due(now_ns):
            self._goal.feedback(self._state(stalled=False, reached=False))

    _moved_ns = 0

    def _command(self, error: float, error_rate: float, period: float) -> None:
        self.commands.write(np.array([self._target]))


class EffortGripperController(PositionGripperController):
    """Effort controller of a gripper with feedback of the position error."""

    names = ("effort_controllers/GripperActionController",)
    command_kind = "effort"

    def configure(self) -> None:
        """Create the PID loop."""
        super().configure()
        self._pid = Pid([self.parameters.gains.get(self.parameters.joint, Gains())])

    def activate(self, now_ns: int) -> None:
        """Hold the finger at its position."""
        self._pid.reset()
        super().activate(now_ns)

    def deactivate(self) -> None:
        """Set the effort to zero."""
        super().deactivate()
        self.commands.write(np.zeros(1))

    def _command(self, error: float, error_rate: float, period: float) -> None:
        wanted = self._pid.update(np.array([error]), period, np.array([error_rate]))
        limited = np.clip(wanted, -self._effort, self._effort)
        self._output = float(limited[0])
        self.commands.write(limited)


class ParallelGripperController(PositionGripperController):
    """Position controller of a gripper with limits of effort and velocity."""

    names = ("parallel_gripper_action_controller/GripperActionController",)
    Parameters = ParallelGripperParameters
    request = ParallelGripperRequest
    parameters: ParallelGripperParameters

    def configure(self) -> None:
        """Set the interface names, including those of maximum effort and speed."""
        super().configure()
        extra = (self.parameters.max_effort_interface, self.parameters.max_velocity_interface)
        self.command_names = (*self.command_names, *(name for name in extra if name))

    def activate(self, now_ns: int) -> None:
        """Hold the finger at its position."""
        self._speed = self.parameters.max_velocity
        super().activate(now_ns)

    def _start(self, goal: Goal) -> None:
        super()._start(goal)
        self._speed = goal.request.max_velocity or self.parameters.max_velocity

    def _command(self, error: float, error_rate: float, period: float) -> None:
        values = [self._target]
        if self.parameters.max_effort_interface:
            values.append(self._effort)
        if self.parameters.max_velocity_interface:
            values.append(self._speed)
        self.commands.write(np.array(values))
