"""The controller as a whole: it follows, avoids, stops and turns, or says why it cannot."""

import numpy as np
import pytest

from daidalos.common.parameters import parameters_from
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.dwb_controller import DwbController, DwbParameters
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl

from .dwb.test_trajectories import WAFFLE
from .scenes import control, ground, line

ROBOT = NavigationContext(footprint=Footprint.circle(0.2))


def controller(**more):
    return DwbController(DwbParameters(**WAFFLE, **more), ROBOT)


def drive(path, costmap, cycles, **more):
    """Simulate a perfect robot that follows; return its poses and velocities."""
    one = controller(**more)
    pose, velocity, poses, velocities = np.zeros(3), np.zeros(3), [], []
    for _ in range(cycles):
        passed = int(np.argmin(np.hypot(*(path[:, :2] - pose[:2]).T)))
        wanted = one.compute_velocity_commands(control(path[passed:], costmap, pose, velocity))
        velocity = velocity + np.clip(wanted - velocity, [-0.125, 0.0, -0.16], [0.125, 0.0, 0.16])
        heading = pose[2] + 0.5 * velocity[2] * 0.05
        pose = pose + 0.05 * np.array([velocity[0] * np.cos(heading), velocity[0] * np.sin(heading), velocity[2]])
        poses.append(pose)
        velocities.append(velocity)
    return np.array(poses), np.array(velocities)


@pytest.mark.slow
def test_a_path_is_followed_to_the_pose_of_the_goal():
    poses, velocities = drive(line((1.5, 0.6), heading=-1.0), ground(), 300)
    assert np.hypot(*(poses[-1, :2] - (1.5, 0.6))) < 0.25
    assert abs(poses[-1, 2] + 1.0) < 0.25
    assert velocities[20:80, 0].mean() > 0.2


@pytest.mark.slow
def test_what_the_planner_did_not_know_is_not_touched():
    costmap = ground([(0.8, 0.1), (0.85, 0.1)])
    poses, _ = drive(line((1.6, 0.0)), costmap, 200)
    assert min(np.hypot(*(p[:2] - (0.82, 0.1))) for p in poses) > 0.2


def test_a_failure_names_the_critics():
    wall = ground([(x, y) for x in np.arange(-0.5, 0.5, 0.04) for y in np.arange(-0.5, 0.5, 0.04)])
    with pytest.raises(NoValidControl, match=r"trajectories from \(0.00, 0.00\) are impossible: BaseObstacle 100 %"):
        controller(debug_trajectory_details=True).compute_velocity_commands(control(line((1.0, 0.0)), wall))


def test_a_robot_without_velocities_is_told_so():
    with pytest.raises(NoValidControl, match="look at its velocities"):
        DwbController(DwbParameters(), ROBOT).compute_velocity_commands(control(line((1.0, 0.0))))


def test_evaluation_that_is_not_cut_short_chooses_the_same():
    given = control(line((2.0, 0.3)), ground([(0.7, 0.0)]))
    cut, whole = (controller(short_circuit_trajectory_evaluation=short) for short in (True, False))
    assert np.array_equal(cut.compute_velocity_commands(given), whole.compute_velocity_commands(given))


def test_speed_limits_and_their_end():
    one, given = controller(), control(line((2.0, 0.0)))
    for limit, percentage, fastest in ((0.1, False, 0.1), (50.0, True, 0.13), (0.0, False, 0.26)):
        one.set_speed_limit(limit, percentage=percentage)
        assert 0.6 * fastest < one.compute_velocity_commands(given)[0] <= fastest + 1e-9


def test_a_critic_has_a_class_beside_its_name():
    parameters = parameters_from(DwbParameters, {"critics": ["Straight"], "Straight.class": "GoalAlign", **WAFFLE})
    assert [type(critic).__name__ for critic in DwbController(parameters, ROBOT).critics] == ["GoalAlignCritic"]
