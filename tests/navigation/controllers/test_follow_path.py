"""Following a path: goals, progress, failure tolerance."""

import math

import numpy as np
import pytest

from daidalos.navigation.contracts import Controller
from daidalos.navigation.controllers.follow_path import FollowPath
from daidalos.navigation.controllers.goal_checkers.simple_goal_checker import SimpleGoalChecker
from daidalos.navigation.controllers.path_handlers.feasible_path_handler import (
    FeasiblePathHandler,
    FeasiblePathHandlerParameters,
)
from daidalos.navigation.controllers.progress_checkers.simple_progress_checker import SimpleProgressChecker
from daidalos.navigation.errors import FailedToMakeProgress, InvalidPath, NoValidControl, PatienceExceeded

from .scenes import ground, line

GROUND = ground()
REST = np.zeros(3)


class Scripted(Controller):
    """Drives ahead, or fails as long as told."""

    look_ahead = 1.0

    def __init__(self):
        self.failing = False
        self.seen = None
        self.resets = 0

    def compute_velocity_commands(self, control):
        self.seen = control
        if self.failing:
            raise NoValidControl("blocked")
        return np.array([0.3, 0.0, 0.0])

    def set_speed_limit(self, speed_limit, *, percentage):
        pass

    def reset(self):
        self.resets += 1


@pytest.fixture
def follow():
    task = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), failure_tolerance=0.5)
    task.start(line((3.0, 0.0)))
    return task


def at(x, y=0.0, yaw=0.0):
    return np.array([x, y, yaw])


def test_the_controller_sees_what_is_ahead_and_how_far_it_is(follow):
    step = follow.step(at(1.0), REST, GROUND, 0.0)
    assert step.velocity[0] == 0.3
    assert step.distance_to_goal == pytest.approx(2.0)
    assert follow.controller.seen.path[-1, 0] == pytest.approx(2.0)
    assert follow.controller.seen.goal[0] == 3.0
    assert follow.controller.seen.xy_goal_tolerance == 0.25


def test_at_the_goal_the_robot_stands(follow):
    step = follow.step(at(2.9), REST, GROUND, 0.0)
    assert step.done
    assert not step.velocity.any()


def test_a_robot_that_does_not_move_fails_in_time(follow):
    follow.step(at(1.0), REST, GROUND, 0.0)
    follow.step(at(1.1), REST, GROUND, 9.9)
    with pytest.raises(FailedToMakeProgress, match=r"stuck, 1\.90 m before"):
        follow.step(at(1.1), REST, GROUND, 10.1)


def test_short_failures_are_borne_and_long_ones_are_not(follow):
    follow.step(at(0.5), REST, GROUND, 0.0)
    follow.controller.failing = True
    step = follow.step(at(0.5), REST, GROUND, 0.4)
    assert step.failure == "blocked"
    assert not step.velocity.any()
    follow.controller.failing = False
    follow.step(at(0.5), REST, GROUND, 0.45)
    follow.controller.failing = True
    follow.step(at(0.5), REST, GROUND, 0.9)
    with pytest.raises(PatienceExceeded, match="blocked"):
        follow.step(at(0.5), REST, GROUND, 1.0)


def test_without_tolerance_the_first_failure_counts():
    task = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), failure_tolerance=0.0)
    task.start(line((3.0, 0.0)))
    task.controller.failing = True
    with pytest.raises(NoValidControl):
        task.step(at(0.5), REST, GROUND, 0.0)


def test_with_unlimited_failure_tolerance_failures_never_count():
    task = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), failure_tolerance=-1.0)
    task.start(line((3.0, 0.0)))
    task.controller.failing = True
    assert all(task.step(at(0.1 * k), REST, GROUND, float(k)).failure for k in range(8))


def test_a_new_path_to_the_same_goal_does_not_reset_the_controller(follow):
    follow.replan(line((3.0, 0.5)))
    assert follow.controller.resets == 1
    follow.start(line((3.0, 0.5)))
    assert follow.controller.resets == 2


def test_a_new_goal_makes_the_robot_forget_that_it_was_at_the_last(follow):
    assert follow.step(at(2.8), REST, GROUND, 0.0).done
    follow.replan(line((3.0, 2.0), (3.0, 0.0)), new_goal=True)
    assert follow.controller.resets == 2
    assert not follow.step(at(2.8), REST, GROUND, 0.1).done


def test_a_bad_path_leaves_the_old_one(follow):
    with pytest.raises(InvalidPath):
        follow.replan(np.zeros((0, 3)))
    assert follow.step(at(1.0), REST, GROUND, 0.0).distance_to_goal == pytest.approx(2.0)


def test_nothing_to_follow():
    task = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker())
    with pytest.raises(InvalidPath, match="no path"):
        task.step(at(0.0), REST, GROUND, 0.0)


def test_a_path_of_the_map_is_followed_in_the_odometrys_frame(follow):
    frame = np.array([0.0, 1.0, np.pi / 2])
    follow.step(at(0.0, 2.0, np.pi / 2), REST, GROUND, 0.0, plan_frame=frame)
    assert np.allclose(follow.controller.seen.goal, [0.0, 4.0, np.pi / 2])


def square_corner():
    """Ahead for 2 m, a turn in place by 90 degrees, and 2 m to the left."""
    along = np.arange(0.0, 2.01, 0.1)
    out = np.stack([along, 0.0 * along, 0.0 * along], axis=-1)
    turn = np.array([[2.0, 0.0, yaw] for yaw in (0.5, 1.0, 0.5 * math.pi)])
    left = np.stack([2.0 + 0.0 * along, along, np.full(along.size, 0.5 * math.pi)], axis=-1)
    return np.concatenate([out, turn, left[1:]])


def reversal():
    """Ahead for 2 m and back again."""
    along = np.arange(0.0, 2.01, 0.1)
    return np.stack([np.concatenate([along, along[-2::-1]]), np.zeros(41), np.zeros(41)], axis=-1)


@pytest.mark.parametrize(
    ("plan", "changes", "end"),
    [
        (square_corner(), {}, (2.0, 0.9, 0.5 * math.pi)),
        (square_corner(), {"enforce_path_inversion": True}, (2.0, 0.9, 0.5 * math.pi)),
        (square_corner(), {"enforce_path_rotation": True}, (2.0, 0.0, 0.5 * math.pi)),
        (square_corner(), {"enforce_path_rotation": True, "minimum_rotation_angle": 2.0}, (2.0, 0.9, 0.5 * math.pi)),
        (reversal(), {}, (1.0, 0.0, 0.0)),
        (reversal(), {"enforce_path_inversion": True}, (2.0, 0.0, 0.0)),
        (reversal(), {"enforce_path_rotation": True}, (1.0, 0.0, 0.0)),
        (reversal(), {"prune_distance": 0.5}, (1.5, 0.0, 0.0)),
    ],
)
def test_what_the_feasible_path_handler_shows(plan, changes, end):
    handler = FeasiblePathHandler(FeasiblePathHandlerParameters(**changes))
    follow = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), path_handler=handler)
    follow.start(plan)
    pose = np.array([1.0, 0.0, 0.0])
    step = follow.step(pose, np.zeros(3), ground(), 0.0)
    assert step.path[-1] == pytest.approx(np.array(end), abs=0.11)


def test_the_path_goes_on_after_the_turn():
    handler = FeasiblePathHandler(FeasiblePathHandlerParameters(enforce_path_rotation=True))
    follow = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), path_handler=handler)
    follow.start(square_corner())
    costmap = ground()
    ends = [
        follow.step(np.array(pose), np.zeros(3), costmap, 0.0).path[-1, 1]
        for pose in ((1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 0.0, 1.4))
    ]
    assert ends[:2] == [0.0, 0.0]
    assert ends[2] > 1.5


def test_a_path_of_one_pose_can_be_refused():
    handler = FeasiblePathHandler(FeasiblePathHandlerParameters(reject_unit_path=True))
    follow = FollowPath(Scripted(), SimpleGoalChecker(), SimpleProgressChecker(), path_handler=handler)
    with pytest.raises(InvalidPath, match="reject_unit_path"):
        follow.start(np.zeros((1, 3)))
