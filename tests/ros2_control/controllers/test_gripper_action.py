"""Grippers that reach, stall, and let go."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.control.contracts import Goal
from daidalos.samples.controllers import GripperRequest, ParallelGripperRequest

PERIOD = PERIOD_NS * 1e-9
POSITION = "position_controllers/GripperActionController"
EFFORT = "effort_controllers/GripperActionController"
PARALLEL = "parallel_gripper_action_controller/GripperActionController"


class Rig:
    """A gripper whose finger moves as a function says: command and position to the next position."""

    def __init__(self, type_name: str, follow: Callable[[float, float], float], **values: Any) -> None:
        self.controller, self.commands, self.states = alone(type_name, joint="finger", **values)
        self.follow = follow
        self.now = 0

    def send(self, request: GripperRequest) -> Goal:
        self.feedback: list[Any] = []
        self.action = self.controller.actions["~/gripper_cmd"]
        goal = Goal(request, self.feedback.append)
        assert not self.action.refuse(request)
        self.action.start(goal)
        return goal

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / PERIOD)):
            self.now += PERIOD_NS
            cycle(self.controller, self.now)
            before = self.states.values[0]
            self.states.values[0] = self.follow(self.commands.values[0], before)
            self.states.values[1] = (self.states.values[0] - before) / PERIOD


def smooth(command: float, position: float) -> float:
    """Close with 5 cm/s."""
    return position + float(np.clip(command - position, -0.0005, 0.0005))


def blocked(command: float, position: float) -> float:
    """Meet something at 2 cm."""
    return min(smooth(command, position), 0.02)


def test_a_free_finger_reaches_its_goal() -> None:
    rig = Rig(POSITION, smooth, goal_tolerance=0.001)
    goal = rig.send(GripperRequest(0.04))
    rig.run(0.5)
    assert goal.status == ""
    assert len(rig.feedback) == 10
    rig.run(0.4)
    assert (goal.status, goal.result.reached_goal, goal.result.stalled) == ("succeeded", True, False)
    assert goal.result.position == pytest.approx(0.04, abs=1e-3)


@pytest.mark.parametrize(("allowed", "status"), [(True, "succeeded"), (False, "aborted")])
def test_something_in_between_stalls_it(allowed: bool, status: str) -> None:
    rig = Rig(POSITION, blocked, allow_stalling=allowed, stall_timeout=0.5, goal_tolerance=0.001)
    goal = rig.send(GripperRequest(0.04))
    rig.run(0.8)
    assert goal.status == ""
    rig.run(0.2)
    assert (goal.status, goal.result.stalled, goal.result.reached_goal) == (status, True, False)
    assert goal.result.position == pytest.approx(0.02)


def test_a_new_goal_replaces_the_old_one_and_cancelling_holds() -> None:
    rig = Rig(POSITION, smooth, goal_tolerance=0.001)
    first = rig.send(GripperRequest(0.04))
    rig.run(0.2)
    second = rig.send(GripperRequest(0.0))
    assert first.status == "aborted"
    rig.run(0.1)
    rig.action.cancel(second)
    assert second.status == "canceled"
    rig.run(0.2)
    assert rig.states.values[0] == pytest.approx(second.result.position, abs=6e-4)


def test_effort_comes_from_gains_and_stays_below_what_the_goal_allows() -> None:
    pushes: list[float] = []

    def heavy(command: float, position: float) -> float:
        pushes.append(command)
        return position + command * 1e-4

    rig = Rig(EFFORT, heavy, gains={"finger": {"p": 500.0}}, goal_tolerance=0.001)
    goal = rig.send(GripperRequest(0.04, max_effort=5.0))
    rig.run(2.0)
    assert goal.status == "succeeded"
    assert max(pushes) == pytest.approx(5.0)
    rig.controller.deactivate()
    assert rig.commands.values[0] == 0.0


def test_a_parallel_gripper_tells_effort_and_speed() -> None:
    rig = Rig(
        PARALLEL,
        smooth,
        max_effort_interface="finger/set_gripper_max_effort",
        max_velocity_interface="finger/set_gripper_max_velocity",
        max_velocity=0.3,
    )
    rig.send(ParallelGripperRequest(0.04, max_effort=7.0))
    rig.run(0.02)
    assert rig.commands.names[0] == "finger/position"
    assert rig.commands.values == pytest.approx([0.04, 7.0, 0.3])
    assert "'thumb' is not the gripper's joint" in rig.action.refuse(ParallelGripperRequest(0.0, joint="thumb"))
    assert "not a number" in rig.action.refuse(ParallelGripperRequest(float("nan")))
