"""The joint trajectory controller, on joints that follow at once and on ones that do not."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, arm, cycle
from scipy.interpolate import CubicHermiteSpline

from daidalos.common.parameters import ParameterError
from daidalos.control.contracts import Goal
from daidalos.control.controllers.joint_trajectory import JointTrajectoryController
from daidalos.control.errors import StateError
from daidalos.control.interfaces import Interfaces
from daidalos.samples.controllers import (
    JointTolerance,
    SpeedCommand,
    TrajectoryCommand,
    TrajectoryPoint,
    TrajectoryRequest,
    TrajectoryResult,
    TrajectoryStateRequest,
)

TYPE = "joint_trajectory_controller/JointTrajectoryController"
JOINTS = ("shoulder", "elbow", "wrist")


class Rig:
    """A controller on joints that a function moves."""

    def __init__(self, follow: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None, **values: Any) -> None:
        given: dict[str, Any] = {
            "joints": list(JOINTS),
            "command_interfaces": ["position"],
            "state_interfaces": ["position", "velocity"],
        }
        self.warnings: list[str] = []
        context = {"warn": self.warnings.append}
        controller, self.commands, self.states = alone(TYPE, arm(), context, **(given | values))
        assert isinstance(controller, JointTrajectoryController)
        self.controller = controller
        self.now = 0
        self.follow = follow or (lambda commands, states: commands)
        self.said: list[Any] = []

    def run(self, seconds: float) -> np.ndarray:
        """Run for a time; return the commanded positions, one row each cycle."""
        rows = []
        for _ in range(round(seconds * 1e9 / PERIOD_NS)):
            self.now += PERIOD_NS
            self.said = cycle(self.controller, self.now)
            before = self.states.values[:3].copy()
            self.states.values[:3] = self.follow(self.commands.values[:3], before)
            self.states.values[3:] = (self.states.values[:3] - before) / (PERIOD_NS * 1e-9)
            rows.append(self.commands.values.copy())
        return np.array(rows)

    def publish(self, command: TrajectoryCommand) -> None:
        self.controller.subscriptions["~/joint_trajectory"].take(command)

    def send(self, command: TrajectoryCommand, **tolerances: Any) -> Goal:
        action = self.controller.actions["~/follow_joint_trajectory"]
        self.feedback: list[Any] = []
        goal = Goal(TrajectoryRequest(command, **tolerances), self.feedback.append)
        assert not action.refuse(goal.request)
        action.start(goal)
        return goal


def command(*points: tuple[float, Any], joints: tuple[str, ...] = JOINTS, start_ns: int = 0) -> TrajectoryCommand:
    """Return a trajectory of positions."""
    made = [TrajectoryPoint(time, np.array(positions, dtype=float)) for time, positions in points]
    return TrajectoryCommand(joints, tuple(made), start_ns)


def test_it_holds_where_it_was_activated() -> None:
    rig = Rig()
    rig.states.values[:3] = [0.5, -0.2, 1.0]
    rig.controller.activate(0)
    assert rig.run(0.05) == pytest.approx(np.tile([0.5, -0.2, 1.0], (5, 1)))


def test_it_does_not_begin_where_positions_are_unknown() -> None:
    rig = Rig()
    rig.states["elbow/position"] = np.nan
    with pytest.raises(StateError, match="'elbow' is not known"):
        rig.controller.activate(0)


def test_positions_alone_are_followed_in_lines() -> None:
    rig = Rig()
    rig.publish(command((1.0, [1.0, 0.5, -0.5]), (2.0, [0.0, 1.0, 0.0])))
    rows = rig.run(2.5)
    times = np.arange(1, 251) * 0.01
    knots = np.array([[0, 0, 0], [1.0, 0.5, -0.5], [0.0, 1.0, 0.0]])
    for joint in range(3):
        assert rows[:, joint] == pytest.approx(np.interp(times, [0, 1, 2], knots[:, joint]), abs=1e-9)


def test_velocities_are_followed_in_cubic_splines() -> None:
    rig = Rig()
    points = (
        TrajectoryPoint(1.0, np.array([1.0, 0.5, -0.5]), np.array([0.2, 0.0, -0.4])),
        TrajectoryPoint(2.0, np.array([0.0, 1.0, 0.0]), np.zeros(3)),
    )
    rig.publish(TrajectoryCommand(JOINTS, points))
    rows = rig.run(2.0)
    spline = CubicHermiteSpline(
        [0, 1, 2], [[0, 0, 0], [1.0, 0.5, -0.5], [0.0, 1.0, 0.0]], [[0, 0, 0], [0.2, 0.0, -0.4], [0, 0, 0]]
    )
    assert rows == pytest.approx(spline(np.arange(1, 201) * 0.01), abs=1e-9)


def test_joints_may_come_in_another_order() -> None:
    rig = Rig()
    rig.publish(command((0.5, [3.0, 1.0, 2.0]), joints=("wrist", "shoulder", "elbow")))
    assert rig.run(1.0)[-1] == pytest.approx([1.0, 2.0, 3.0])


def test_partial_goals_leave_the_other_joints() -> None:
    rig = Rig(allow_partial_joints_goal=True)
    rig.publish(command((0.5, [0.4, 0.6, 0.8])))
    rig.run(1.0)
    rig.publish(command((0.5, [1.0]), joints=("elbow",)))
    rows = rig.run(1.0)
    assert rows[:, [0, 2]] == pytest.approx(np.tile([0.4, 0.8], (100, 1)))
    assert rows[-1, 1] == pytest.approx(1.0)


def test_a_new_trajectory_takes_over_at_once() -> None:
    rig = Rig()
    first = rig.send(command((2.0, [2.0, 0.0, 0.0])))
    rig.run(1.0)
    second = rig.send(command((1.0, [0.0, 0.0, 0.0])))
    assert (first.status, first.result.code) == ("aborted", TrajectoryResult.INVALID_GOAL)
    rows = rig.run(1.2)
    assert rows[49, 0] == pytest.approx(0.5, abs=1e-9)
    assert rows[-1, 0] == pytest.approx(0.0, abs=1e-9)
    assert second.status == "succeeded"


def test_a_later_trajectory_waits_for_its_start_while_the_current_one_runs() -> None:
    rig = Rig()
    rig.publish(command((2.0, [2.0, 0.0, 0.0])))
    rig.run(0.5)
    rig.publish(command((1.0, [0.0, 1.0, 0.0]), start_ns=1_000_000_000))
    rows = rig.run(2.0)
    assert rows[:50, 0] == pytest.approx(np.arange(51, 101) * 0.01)
    assert rows[50:150, 0] == pytest.approx(1.0 - np.arange(1, 101) * 0.01)
    assert rows[-1] == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)


def test_waypoints_that_are_past_are_left_out() -> None:
    rig = Rig()
    rig.run(1.0)
    rig.publish(command((0.4, [9.0, 0.0, 0.0]), (1.5, [1.0, 0.0, 0.0]), start_ns=500_000_000))
    rows = rig.run(1.5)
    assert rows[:100, 0] == pytest.approx(np.arange(1, 101) * 0.01)
    assert rows[-1, 0] == pytest.approx(1.0)


def test_a_joint_without_end_takes_the_short_way() -> None:
    rig = Rig()
    rig.states["wrist/position"] = 3.0
    rig.controller.activate(0)
    rig.publish(command((1.0, [0.0, 0.0, -3.0])))
    rows = rig.run(1.5)
    assert rows[-1, 2] == pytest.approx(2 * np.pi - 3.0)
    assert np.all(np.diff(rows[:, 2]) >= -1e-12)


def test_no_interpolation_jumps_at_waypoints() -> None:
    rig = Rig(interpolation_method="none")
    rig.publish(command((0.5, [1.0, 0.0, 0.0]), (1.0, [2.0, 0.0, 0.0])))
    rows = rig.run(1.2)[:, 0]
    assert rows[:49] == pytest.approx(0.0)
    assert rows[50:99] == pytest.approx(1.0)
    assert rows[100:] == pytest.approx(2.0)


def test_velocities_alone_are_integrated_where_that_is_allowed() -> None:
    rig = Rig(allow_integration_in_goal_trajectories=True)
    points = (
        TrajectoryPoint(1.0, velocities=np.array([1.0, 0.0, 0.0])),
        TrajectoryPoint(2.0, velocities=np.zeros(3)),
    )
    rig.publish(TrajectoryCommand(JOINTS, points))
    assert rig.run(2.5)[-1, 0] == pytest.approx(1.0)


def test_time_runs_as_fast_as_it_is_told() -> None:
    rig = Rig(command_interfaces=["position", "velocity"], speed_scaling={"initial_scaling_factor": 0.5})
    rig.publish(command((0.0, (0.0, 0.0, 0.0)), (2.0, (1.0, 1.0, 1.0))))
    rows = rig.run(2.0)
    assert rows[-1] == pytest.approx([0.5] * 3 + [0.25] * 3, abs=0.01)
    speed = rig.controller.subscriptions["~/speed_scaling_input"].take
    speed(SpeedCommand(0.0))
    assert rig.run(1.0)[-1] == pytest.approx([0.5] * 3 + [0.0] * 3, abs=0.01)
    speed(SpeedCommand(-1.0))
    assert "-1" in rig.warnings[-1]
    speed(SpeedCommand(2.0))
    assert rig.run(0.45)[-1] == pytest.approx([0.95] * 3 + [1.0] * 3, abs=0.02)
    assert rig.said[-1].speed == 2.0
    rig.run(0.2)
    assert rig.commands.values[:3] == pytest.approx([1.0] * 3)


def test_the_hardware_may_tell_the_speed_and_be_told_it() -> None:
    rig = Rig(speed_scaling={"state_interface": "scaling/factor", "command_interface": "scaling/wanted"})
    assert "~/speed_scaling_input" not in rig.controller.subscriptions
    assert rig.controller.state_names[-1] == "scaling/factor"
    assert rig.controller.command_names[-1] == "scaling/wanted"


def test_a_goal_gives_feedback_and_succeeds() -> None:
    rig = Rig(action_monitor_rate=10.0)
    goal = rig.send(command((1.0, [1.0, 0.0, 0.0])))
    rig.run(0.99)
    assert goal.status == ""
    assert len(rig.feedback) == 10
    assert rig.feedback[5].desired.positions[0] == pytest.approx(0.51, abs=0.011)
    rig.run(0.1)
    assert (goal.status, goal.result.code) == ("succeeded", TrajectoryResult.SUCCESSFUL)


def stuck(commands: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Move all joints but the elbow."""
    return np.where([True, False, True], commands, states)


def test_a_path_tolerance_stops_the_joints_where_they_are() -> None:
    rig = Rig(stuck, constraints={"elbow": {"trajectory": 0.1}})
    goal = rig.send(command((1.0, [1.0, 1.0, 0.0])))
    rows = rig.run(1.0)
    assert (goal.status, goal.result.code) == ("aborted", TrajectoryResult.PATH_TOLERANCE_VIOLATED)
    assert "position of joint 'elbow' is off by 0.11, allowed is 0.1" in goal.result.text
    assert rows[-1, 0] == pytest.approx(0.1, abs=0.011)
    assert rows[-1, 1] == pytest.approx(0.0)


def test_a_goal_tolerance_aborts_when_the_time_for_it_is_over() -> None:
    rig = Rig(stuck, constraints={"goal_time": 0.5, "elbow": {"goal": 0.1}})
    goal = rig.send(command((1.0, [1.0, 1.0, 0.0])))
    rig.run(1.4)
    assert goal.status == ""
    rig.run(0.2)
    assert (goal.status, goal.result.code) == ("aborted", TrajectoryResult.GOAL_TOLERANCE_VIOLATED)


def test_a_late_joint_succeeds_within_its_time() -> None:
    def slow(commands: np.ndarray, states: np.ndarray) -> np.ndarray:
        return states + np.clip(commands - states, -0.008, 0.008)

    rig = Rig(slow, constraints={"goal_time": 1.0, "shoulder": {"goal": 0.01}})
    goal = rig.send(command((1.0, [1.0, 0.0, 0.0])))
    rig.run(1.2)
    assert goal.status == ""
    rig.run(0.3)
    assert goal.status == "succeeded"


def test_a_goal_brings_its_own_tolerances() -> None:
    rig = Rig(stuck, constraints={"elbow": {"trajectory": 0.1}})
    lifted = rig.send(command((1.0, [1.0, 1.0, 0.0])), path={"elbow": JointTolerance(position=-1.0)})
    rig.run(1.1)
    assert lifted.status == "succeeded"
    strict = rig.send(command((1.0, [0.0, 1.0, 0.0])), path={"elbow": JointTolerance(position=0.01)})
    rig.run(0.1)
    assert strict.result.code == TrajectoryResult.PATH_TOLERANCE_VIOLATED


def test_cancelling_holds() -> None:
    rig = Rig()
    goal = rig.send(command((2.0, [2.0, 0.0, 0.0])))
    rig.run(1.0)
    rig.controller.actions["~/follow_joint_trajectory"].cancel(goal)
    assert goal.status == "canceled"
    assert rig.run(1.0)[:, 0] == pytest.approx(1.0)


def test_deactivating_ends_running_and_waiting_goals() -> None:
    rig = Rig()
    running = rig.send(command((2.0, [2.0, 0.0, 0.0])))
    rig.run(0.1)
    waiting = rig.send(command((1.0, [0.0, 0.0, 0.0]), start_ns=5_000_000_000))
    rig.controller.deactivate()
    assert (running.status, waiting.status) == ("aborted", "aborted")


def test_velocity_commands_come_from_feedforward_and_gains() -> None:
    rig = Rig(
        lambda commands, states: states + commands * PERIOD_NS * 1e-9,
        command_interfaces=["velocity"],
        gains={joint: {"p": 5.0, "ff_velocity_scale": 1.0} for joint in JOINTS},
    )
    rig.publish(command((2.0, [1.0, -0.5, 0.3])))
    rig.run(2.5)
    assert rig.states.values[:3] == pytest.approx([1.0, -0.5, 0.3], abs=1e-3)
    rig.controller.deactivate()
    assert not rig.commands.values.any()


def test_all_derivatives_go_to_the_interfaces_that_there_are() -> None:
    rig = Rig(command_interfaces=["position", "velocity", "acceleration"])
    points = (TrajectoryPoint(1.0, np.array([1.0, 0.0, 0.0]), np.zeros(3)),)
    rig.publish(TrajectoryCommand(JOINTS, points))
    rows = rig.run(1.0)
    spline = CubicHermiteSpline([0, 1], [0, 1], [0, 0])
    times = np.arange(1, 101) * 0.01
    assert rows[:99, 0] == pytest.approx(spline(times)[:99])
    assert rows[:99, 3] == pytest.approx(spline(times, nu=1)[:99])
    assert rows[:99, 6] == pytest.approx(spline(times, nu=2)[:99])


def test_it_says_its_state_and_answers_what_it_will_want() -> None:
    rig = Rig()
    rig.publish(command((1.0, [1.0, 0.0, 0.0])))
    rig.run(0.5)
    state = rig.said[0]
    assert state.topic == "~/controller_state"
    assert state.desired.positions[0] == pytest.approx(0.5)
    assert state.error.positions[0] == pytest.approx(0.01)
    assert state.output.positions[0] == pytest.approx(0.5)
    answer = rig.controller.services["~/query_state"].answer(TrajectoryStateRequest(750_000_000))
    assert answer.point.positions[0] == pytest.approx(0.75)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            command((1.0, [1.0]), joints=("knee",)),
            "joint 'knee' is not one of the controller's: shoulder, elbow, wrist",
        ),
        (command((1.0, [1.0]), joints=("elbow",)), "partial goals are not allowed: shoulder, wrist"),
        (command((1.0, [1.0, 2.0]), joints=("elbow", "elbow")), "'elbow' is there twice"),
        (command(joints=()), "no joint names"),
        (command(), "no points"),
        (command((1.0, [0, 0, 0]), (1.0, [0, 0, 0])), "point 2 is not after the one before"),
        (command((-1.0, [0, 0, 0])), "is negative"),
        (command((1.0, [0, 0])), "has 2 positions for 3 joints"),
        (command((1.0, [0, 0, np.nan])), "that are not numbers"),
        (command((1.0, [0, 0, 0]), start_ns=1), "it ended 0.000 s ago|it ended 1.000 s ago"),
        (TrajectoryCommand(JOINTS, (TrajectoryPoint(1.0, velocities=np.zeros(3)),)), "has no positions"),
        (
            TrajectoryCommand(JOINTS, (TrajectoryPoint(1.0, np.zeros(3), np.array([0.0, 1.0, 0.0])),)),
            "a velocity for joint 'elbow': 1",
        ),
    ],
)
def test_what_cannot_be_followed_is_refused(given: TrajectoryCommand, message: str) -> None:
    rig = Rig()
    rig.run(2.0)
    rig.publish(given)
    with pytest.raises(AssertionError):
        rig.send(given)
    assert len(rig.warnings) == 1
    import re

    assert re.search(message, rig.warnings[0])
    assert not rig.run(0.5).any()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"command_interfaces": ["position", "effort"]}, "cannot be position, effort together"),
        ({"state_interfaces": ["velocity"]}, "must have position"),
        ({"command_interfaces": ["torque"]}, "may have position"),
        ({"command_joints": ["elbow", "knee"]}, "'knee', which is not in joints"),
    ],
)
def test_wrong_parameters_are_named(values: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Rig(**values)


def test_interfaces_of_another_name_can_be_commanded() -> None:
    rig = Rig(command_joints=["a/shoulder", "a/elbow", "a/wrist"])
    assert isinstance(rig.commands, Interfaces)
    assert rig.commands.names == ("a/shoulder/position", "a/elbow/position", "a/wrist/position")
