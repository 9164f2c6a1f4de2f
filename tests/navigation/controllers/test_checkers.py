"""Goals that are reached and robots that get on."""

import math

import numpy as np

from daidalos.navigation.controllers.goal_checkers.simple_goal_checker import (
    SimpleGoalChecker,
    SimpleGoalCheckerParameters,
)
from daidalos.navigation.controllers.goal_checkers.stopped_goal_checker import StoppedGoalChecker
from daidalos.navigation.controllers.progress_checkers.pose_progress_checker import PoseProgressChecker
from daidalos.navigation.controllers.progress_checkers.simple_progress_checker import SimpleProgressChecker

GOAL = np.array([1.0, 2.0, math.pi])
REST = np.zeros(3)


def pose(dx=0.0, dy=0.0, dyaw=0.0):
    return GOAL + np.array([dx, dy, dyaw])


def test_position_and_yaw_count_and_yaw_goes_round():
    checker = SimpleGoalChecker()
    assert not checker.is_goal_reached(pose(0.3), GOAL, REST)
    assert not checker.is_goal_reached(pose(0.0, 0.0, 0.3), GOAL, REST)
    assert checker.is_goal_reached(pose(0.1, 0.1, 0.2 - 2.0 * math.pi), GOAL, REST)


def test_a_stateful_checker_does_not_ask_for_the_position_twice():
    for stateful in (True, False):
        checker = SimpleGoalChecker(SimpleGoalCheckerParameters(stateful=stateful))
        assert not checker.is_goal_reached(pose(0.2, 0.0, 1.0), GOAL, REST)
        assert checker.is_goal_reached(pose(0.3), GOAL, REST) is stateful
        checker.reset()
        assert not checker.is_goal_reached(pose(0.3), GOAL, REST)


def test_a_stopped_checker_waits_for_rest():
    checker = StoppedGoalChecker()
    assert not checker.is_goal_reached(pose(), GOAL, np.array([0.3, 0.0, 0.0]))
    assert not checker.is_goal_reached(pose(), GOAL, np.array([0.0, 0.0, -0.3]))
    assert checker.is_goal_reached(pose(), GOAL, np.array([0.1, 0.1, 0.1]))


def test_progress_is_leaving_a_circle_in_time():
    checker = SimpleProgressChecker()
    assert checker.check(pose(), 0.0)
    assert checker.check(pose(0.4), 9.0)
    assert not checker.check(pose(0.45), 10.5)
    assert checker.check(pose(0.6), 10.6)
    assert checker.check(pose(0.6), 20.0)
    assert not checker.check(pose(0.6), 21.0)
    checker.reset()
    assert checker.check(pose(0.6), 99.0)


def test_a_turn_is_progress_only_for_the_pose_checker():
    for checker, counts in ((SimpleProgressChecker(), False), (PoseProgressChecker(), True)):
        checker.check(pose(), 0.0)
        checker.check(pose(0.0, 0.0, 0.6), 9.0)
        assert checker.check(pose(0.0, 0.0, 0.6), 11.0) is counts
