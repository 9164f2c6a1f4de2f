"""What is ahead of the robot."""

import math

import numpy as np
import pytest

from daidalos.common.pose2 import between
from daidalos.navigation.controllers.plan_ahead import PlanAhead
from daidalos.navigation.errors import InvalidPath
from daidalos.navigation.paths import with_headings

from .scenes import line

SAME = np.zeros(3)


def test_what_is_behind_is_forgotten_and_what_is_far_is_not_shown():
    handler = PlanAhead()
    handler.set_plan(line((5.0, 0.0)))
    path, goal, distance = handler.ahead(np.array([1.0, 0.1, 0.0]), SAME, 2.0)
    assert path[0, 0] == pytest.approx(1.0)
    assert path[-1, 0] == pytest.approx(3.0)
    assert goal[0] == 5.0
    assert distance == pytest.approx(4.0)


def test_at_the_end_one_pose_is_left():
    handler = PlanAhead()
    handler.set_plan(line((1.0, 0.0)))
    path, _, distance = handler.ahead(np.array([2.0, 0.0, 0.0]), SAME, 2.0)
    assert path.shape == (1, 3)
    assert distance == 0.0


def test_a_path_that_comes_back_is_not_cut_short():
    there, back = line((3.0, 0.0)), line((0.0, 0.1), (3.0, 0.1))
    handler = PlanAhead(max_robot_pose_search_dist=1.0)
    handler.set_plan(with_headings(np.concatenate([there[:, :2], back[:, :2]])))
    _, _, distance = handler.ahead(np.array([0.3, 0.08, 0.0]), SAME, 2.0)
    assert distance > 5.0


def test_the_robot_never_goes_back_along_the_path():
    handler = PlanAhead()
    handler.set_plan(line((5.0, 0.0)))
    handler.ahead(np.array([1.0, 0.0, 0.0]), SAME, 1.0)
    assert handler.ahead(np.array([0.2, 0.0, 0.0]), SAME, 1.0)[2] == pytest.approx(4.0)


def test_a_plan_in_another_frame_is_moved_into_the_costmaps():
    frame = np.array([1.0, -2.0, math.pi / 2])
    handler = PlanAhead()
    handler.set_plan(line((2.0, 0.0)))
    path, goal, _ = handler.ahead(np.array([1.0, -1.5, 0.0]), frame, 9.0)
    assert np.allclose(goal, [1.0, 0.0, math.pi / 2])
    assert np.allclose(between(frame, path)[:, 1], 0.0)
    assert path[0, 1] == pytest.approx(-1.5)


@pytest.mark.parametrize("plan", [np.zeros((0, 3)), np.zeros((2, 2)), np.full((2, 3), np.nan)])
def test_plans_that_are_none_are_refused(plan):
    handler = PlanAhead()
    with pytest.raises(InvalidPath):
        handler.set_plan(plan)
    assert not handler.has_plan
