"""Joint trajectory controller: moves joints along splines and checks tolerances."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.rate_gate import RateGate
from daidalos.control.contracts import Action, Controller, Goal, Service, Subscription
from daidalos.control.controllers.joint_trajectory_parameters import JointTrajectoryParameters
from daidalos.control.errors import StateError
from daidalos.control.interfaces import interface_names
from daidalos.control.pid import Pid
from daidalos.control.tolerances import Tolerances
from daidalos.control.trajectory import Trajectory, integrated, waypoints
from daidalos.control.trajectory_checks import problem_with
from daidalos.description.joint import JointType
from daidalos.samples.controllers import (
    SpeedCommand,
    TrajectoryCommand,
    TrajectoryFeedback,
    TrajectoryPoint,
    TrajectoryRequest,
    TrajectoryResult,
    TrajectorySample,
    TrajectoryStateRequest,
    TrajectoryStateResponse,
)
from daidalos.samples.sensors import Sample

Motion = tuple[Array, Array, Array]
"""Positions, velocities and accelerations (n,)."""

_ORDER = ("position", "velocity", "acceleration")
_REPLACED = TrajectoryResult(TrajectoryResult.INVALID_GOAL, "Current goal cancelled due to new incoming action.")


class JointTrajectoryController(Controller):
    """Controller of trajectories from ``~/joint_trajectory`` and from the action ``~/follow_joint_trajectory``.

    A new trajectory takes over at its start; one that starts later leaves the current one running until then.
    Waypoints that are past are left out. Joints that it does not mention stay, where partial goals are allowed.
    """

    names = ("joint_trajectory_controller/JointTrajectoryController",)
    Parameters = JointTrajectoryParameters
    parameters: JointTrajectoryParameters

    def configure(self) -> None:
        """Set the interface names; find continuous joints."""
        p = self.parameters
        self._joints = p.joints
        self.command_names = interface_names(p.command_joints or p.joints, p.command_interfaces)
        self.state_names = interface_names(p.joints, [kind for kind in _ORDER if kind in p.state_interfaces])
        self._count = len(p.joints)
        scaling = p.speed_scaling
        self.command_names += (scaling.command_interface,) if scaling.command_interface else ()
        self.state_names += (scaling.state_interface,) if scaling.state_interface else ()
        self._speed = scaling.initial_scaling_factor
        robot = self.context.robot
        self._endless = np.array(
            [
                p.gains[name].angle_wraparound
                or (robot is not None and name in robot.joints and robot.joints[name].type is JointType.CONTINUOUS)
                for name in p.joints
            ]
        )
        self._closed = not p.open_loop_control and p.command_interfaces[0] in ("velocity", "effort")
        self._monitor = RateGate(p.action_monitor_rate)
        self._goal: Goal | None = None
        self._pending: tuple[TrajectoryCommand, Goal | None] | None = None
        self._take_gains()

    def reconfigure(self, parameters: JointTrajectoryParameters) -> None:
        """Apply changed gains and tolerances."""
        super().reconfigure(parameters)
        self._take_gains()

    def _take_gains(self) -> None:
        gains = [self.parameters.gains[joint] for joint in self._joints]
        self._pid = Pid([one.clamped for one in gains])
        self._feedforward = np.array([one.ff_velocity_scale for one in gains])
        limits = [self.parameters.joint_constraints[joint] for joint in self._joints]
        self._path_tolerances = Tolerances.of([one.trajectory for one in limits])
        self._goal_tolerances = Tolerances.of(
            [one.goal for one in limits], self.parameters.constraints.stopped_velocity_tolerance
        )

    # In and out

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """State of the controller."""
        return {"~/controller_state": TrajectorySample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Trajectories, and their speed factor."""
        taken = {"~/joint_trajectory": Subscription(TrajectoryCommand, self._take)}
        if not self.parameters.speed_scaling.state_interface:
            taken["~/speed_scaling_input"] = Subscription(SpeedCommand, self._take_speed)
        return taken

    @property
    def services(self) -> Mapping[str, Service]:
        """Query of the trajectory's state at a time."""
        return {"~/query_state": Service(TrajectoryStateRequest, self._answer)}

    @property
    def actions(self) -> Mapping[str, Action]:
        """Action that follows a trajectory."""
        action = Action(TrajectoryRequest, self._refuse, self._start_goal, self._cancel)
        return {"~/follow_joint_trajectory": action}

    def _take(self, command: TrajectoryCommand) -> None:
        problem = problem_with(command, self.parameters, self.now_ns)
        if problem:
            self.context.warn(f"trajectory not accepted: {problem}")
            return
        self._replace(command, None)

    def _take_speed(self, command: SpeedCommand) -> None:
        if not (math.isfinite(command.factor) and command.factor >= 0.0):
            self.context.warn(f"speed scaling of {command.factor:g} not accepted: expected a number from 0 on")
            return
        self._speed = command.factor

    def _refuse(self, request: TrajectoryRequest) -> str:
        problem = problem_with(request.trajectory, self.parameters, self.now_ns)
        unknown = next((name for name in (*request.path, *request.goal) if name not in self._joints), "")
        return problem or (f"tolerance for '{unknown}', which is not a joint of the controller" if unknown else "")

    def _start_goal(self, goal: Goal) -> None:
        self._replace(goal.request.trajectory, goal)

    def _cancel(self, goal: Goal) -> None:
        if self._pending is not None and self._pending[1] is goal:
            self._pending = None
        if self._goal is goal:
            self._goal = None
            self._hold(self._actual()[0])
        goal.finish("canceled", TrajectoryResult(TrajectoryResult.SUCCESSFUL, "canceled"))

    def _answer(self, question: TrajectoryStateRequest) -> TrajectoryStateResponse:
        if question.time_ns < self._begun_ns:
            return TrajectoryStateResponse(known=False)
        elapsed = (question.time_ns - self._start_ns) * 1e-9
        return TrajectoryStateResponse(True, self._joints, _point(self._trajectory.sample(elapsed), elapsed))

    # Life

    def activate(self, now_ns: int) -> None:
        """Hold the joints at the last command, or at their positions."""
        self.now_ns = now_ns
        position = self._actual()[0]
        names = self.parameters.command_interfaces
        if "position" in names and self.parameters.set_last_command_interface_value_as_state_on_activation:
            place = names.index("position") * self._count
            last = self.commands.read()[place : place + self._count]
            position = np.where(np.isnan(last), position, last) if len(last) == self._count else position
        if np.isnan(position).any():
            joint = self._joints[int(np.argmax(np.isnan(position)))]
            raise StateError(f"the position of joint '{joint}' is not known yet")
        self._pid.reset()
        self._start_ns = self._begun_ns = now_ns
        self._pending = None
        self._hold(position)

    def deactivate(self) -> None:
        """Cancel the goal and stop."""
        ended = TrajectoryResult(TrajectoryResult.INVALID_GOAL, "the controller was deactivated")
        self._end_goal("aborted", ended)
        self._drop_pending(ended)
        if self.parameters.command_interfaces[0] in ("velocity", "effort"):
            joints = self.parameters.command_joints or self.parameters.joints
            self._write(np.zeros(len(self.parameters.command_interfaces) * len(joints)))

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Follow the trajectory."""
        if self._pending is not None and self._pending[0].start_ns <= now_ns:
            (command, goal), self._pending = self._pending, None
            self._begin(command, goal, self._desired_at(command.start_ns), command.start_ns)
        if self.parameters.speed_scaling.state_interface:
            told = float(self.states.read()[-1])
            self._speed = told if math.isfinite(told) and told >= 0.0 else self._speed
        if self._moving:
            # What the trajectory's clock is slow by.
            self._start_ns += round((1.0 - self._speed) * period * 1e9)
        actual = self._actual()
        desired = self._desired_at(now_ns)
        error = self._errors(desired, actual)
        if self._supervise(now_ns, desired, actual, error):
            desired = self._desired_at(now_ns)
            error = self._errors(desired, actual)
        output = self._command(desired, error, period)
        self._write(output)
        if self.context.has_subscribers("~/controller_state"):
            yield self._sample(now_ns, desired, actual, error, output)

    # Trajectories

    def _replace(self, command: TrajectoryCommand, goal: Goal | None) -> None:
        """Replace the trajectory by a new one, now or at its start."""
        self._drop_pending(_REPLACED)
        if command.start_ns > self.now_ns:
            self._pending = (command, goal)
            return
        begin = replace(command, start_ns=command.start_ns or self.now_ns)
        from_desired = self.parameters.interpolate_from_desired_state or self.parameters.open_loop_control
        start = self._desired_at(self.now_ns) if from_desired else self._actual()
        self._begin(begin, goal, start, self.now_ns)

    def _begin(self, command: TrajectoryCommand, goal: Goal | None, start: Motion, begun_ns: int) -> None:
        """Start a trajectory from a state at an instant."""
        self._end_goal("aborted", _REPLACED)
        self._trajectory = self._plan(command, start, (begun_ns - command.start_ns) * 1e-9)
        self._start_ns, self._begun_ns = command.start_ns, begun_ns
        self._moving, self._goal = True, goal
        if goal is not None:
            request = goal.request
            self._path = self._path_tolerances.changed(self._joints, request.path)
            self._at_goal = self._goal_tolerances.changed(self._joints, request.goal)
            wanted = request.goal_time or self.parameters.constraints.goal_time
            self._goal_time = wanted if wanted > 0.0 else math.inf
            self._monitor.restart()

    def _plan(self, command: TrajectoryCommand, start: Motion, offset: float) -> Trajectory:
        """Return a trajectory of all joints; it goes through `start` at `offset` [s] after its own start."""
        columns = [self._joints.index(joint) for joint in command.joints]
        times, *given = waypoints(command.points, len(columns))
        at_rest = np.zeros(self._count)
        stay = (self._desired_at(self.now_ns)[0], at_rest, at_rest)
        rows = [_filled(values, columns, rest) for values, rest in zip(given, stay, strict=True)]
        if np.isnan(rows[0]).any():  # only velocities are given
            rows[0] = integrated(times, rows[1], start[0])
        future = times >= offset - 1e-9
        times, rows = times[future], [one[future] for one in rows]
        turns = np.where(self._endless, np.round((start[0] - rows[0][0]) / (2 * np.pi)), 0.0)
        rows[0] = rows[0] + 2 * np.pi * turns
        if times[0] > offset + 1e-9:
            times = np.concatenate(([offset], times))
            rows = [np.vstack((first, row)) for first, row in zip(start, rows, strict=True)]
        positions, velocities, accelerations = rows
        return Trajectory(
            times,
            positions,
            velocities,
            accelerations,
            steps=self.parameters.interpolation_method == "none",
            keep_velocity=self.parameters.allow_nonzero_velocity_at_trajectory_end,
        )

    def _hold(self, position: Array) -> None:
        self._trajectory = Trajectory(np.zeros(1), position[None, :])
        self._moving = False

    def _desired_at(self, time_ns: int) -> Motion:
        position, velocity, acceleration = self._trajectory.sample((time_ns - self._start_ns) * 1e-9)
        if self._speed == 1.0:
            return position, velocity, acceleration
        return position, velocity * self._speed, acceleration * self._speed**2

    # Watching

    def _supervise(self, now_ns: int, desired: Motion, actual: Motion, error: Motion) -> bool:
        """Check tolerances and the goal; return whether the joints must hold instead."""
        if not self._moving:
            return False
        late = (now_ns - self._start_ns) * 1e-9 - self._trajectory.duration
        goal = self._goal
        if goal is None:
            timeout = self.parameters.cmd_timeout
            expired = timeout > 0.0 and late > timeout
            if expired:
                self._hold(actual[0])
            return expired
        if self._monitor.is_due(now_ns):
            elapsed = (now_ns - self._start_ns) * 1e-9
            points = (_point(one, elapsed) for one in (desired, actual, error))
            goal.feedback(TrajectoryFeedback(now_ns, self._joints, *points))
        if late < -1e-9:
            problem = self._path.violation(self._joints, *error)
            return bool(problem) and self._give_up(actual, TrajectoryResult.PATH_TOLERANCE_VIOLATED, problem)
        problem = self._at_goal.violation(self._joints, *error)
        if not problem:
            self._end_goal("succeeded", TrajectoryResult(TrajectoryResult.SUCCESSFUL, "Goal successfully reached!"))
            return False
        if late > self._goal_time:
            return self._give_up(actual, TrajectoryResult.GOAL_TOLERANCE_VIOLATED, problem)
        return False

    def _give_up(self, actual: Motion, code: int, problem: str) -> bool:
        self.context.warn(f"trajectory aborted: {problem}")
        self._end_goal("aborted", TrajectoryResult(code, f"Aborted: {problem}"))
        self._hold(actual[0])
        return True

    def _end_goal(self, status: str, result: TrajectoryResult) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            goal.finish(status, result)

    def _drop_pending(self, result: TrajectoryResult) -> None:
        pending, self._pending = self._pending, None
        if pending is not None and pending[1] is not None:
            pending[1].finish("aborted", result)

    # Interfaces

    def _actual(self) -> Motion:
        """Return the measured state; NaN where there is no measurement."""
        values = np.full((3, self._count), np.nan)
        measured = self.states.read()[: len(self.parameters.state_interfaces) * self._count].reshape(-1, self._count)
        values[: len(measured)] = measured
        return values[0], values[1], values[2]

    def _errors(self, desired: Motion, actual: Motion) -> Motion:
        position = desired[0] - actual[0]
        position = np.where(self._endless, np.remainder(position + np.pi, 2 * np.pi) - np.pi, position)
        return position, desired[1] - actual[1], desired[2] - actual[2]

    def _command(self, desired: Motion, error: Motion, period: float) -> Array:
        columns = []
        for interface in self.parameters.command_interfaces:
            if self._closed:
                rate = None if np.isnan(error[1]).any() else error[1]
                columns.append(self._feedforward * desired[1] + self._pid.update(error[0], period, rate))
            else:
                columns.append(desired[_ORDER.index(interface)])
        commanded = self.parameters.command_joints or self._joints
        if len(commanded) != self._count:  # some joints are only watched
            chosen = [self._joints.index(name) for name in commanded]
            columns = [column[chosen] for column in columns]
        return np.concatenate(columns)

    def _write(self, output: Array) -> None:
        """Command the joints and, if configured, the hardware's speed scaling."""
        scales = self.parameters.speed_scaling.command_interface
        self.commands.write(np.append(output, self._speed) if scales else output)

    def _sample(self, now_ns: int, desired: Motion, actual: Motion, error: Motion, output: Array) -> TrajectorySample:
        elapsed = (now_ns - self._start_ns) * 1e-9
        names = self.parameters.command_interfaces
        columns = dict(zip(names, np.split(output, len(names)), strict=True))
        return TrajectorySample(
            stamp_ns=now_ns,
            topic="~/controller_state",
            frame_id="",
            joints=self._joints,
            desired=_point(desired, elapsed),
            actual=_point(actual, elapsed),
            error=_point(error, elapsed),
            output=TrajectoryPoint(
                elapsed,
                columns.get("position"),
                columns.get("velocity"),
                columns.get("acceleration"),
                columns.get("effort"),
            ),
            speed=self._speed,
        )


def _point(motion: Motion, time: float) -> TrajectoryPoint:
    return TrajectoryPoint(time, *(None if np.isnan(one).any() else one for one in motion))


def _filled(values: Array, columns: list[int], rest: Array) -> Array:
    """Return waypoints (k, n) of all joints: `values` in the columns, `rest` (n,) in the others.

    Where a waypoint says nothing all of it is NaN.
    """
    rows = np.tile(rest, (len(values), 1))
    rows[np.isnan(values).any(axis=1)] = np.nan
    rows[:, columns] = values
    return rows
