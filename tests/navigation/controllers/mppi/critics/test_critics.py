"""Each critic against its definition, written with plain numpy."""

import math
from dataclasses import replace

import numpy as np
import pytest

from daidalos.navigation.contracts import Scene
from daidalos.navigation.controllers.mppi.critics.constraint_critic import ConstraintCritic
from daidalos.navigation.controllers.mppi.critics.cost_critic import CostCritic, CostCriticParameters
from daidalos.navigation.controllers.mppi.critics.goal_angle_critic import GoalAngleCritic
from daidalos.navigation.controllers.mppi.critics.goal_critic import GoalCritic
from daidalos.navigation.controllers.mppi.critics.obstacles_critic import ObstaclesCritic, ObstaclesCriticParameters
from daidalos.navigation.controllers.mppi.critics.path_align_critic import PathAlignCritic, PathAlignCriticParameters
from daidalos.navigation.controllers.mppi.critics.path_align_legacy_critic import PathAlignLegacyCritic
from daidalos.navigation.controllers.mppi.critics.path_angle_critic import PathAngleCritic, PathAngleCriticParameters
from daidalos.navigation.controllers.mppi.critics.path_follow_critic import PathFollowCritic
from daidalos.navigation.controllers.mppi.critics.prefer_forward_critic import PreferForwardCritic
from daidalos.navigation.controllers.mppi.critics.twirling_critic import TwirlingCritic, TwirlingCriticParameters
from daidalos.navigation.controllers.mppi.critics.velocity_deadband_critic import (
    VelocityDeadbandCritic,
    VelocityDeadbandCriticParameters,
)
from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts
from daidalos.navigation.controllers.mppi_controller import furthest_reached
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.paths import distances_along

from ...scenes import control, ground, line

LIMITS = Limits(-0.3, 0.5, 1.8, -9.0, 9.0, 30.0)
ROBOT = Footprint.circle(0.2)


@pytest.fixture
def rollouts():
    generator = np.random.default_rng(4)
    samples = Rollouts.empty(50, 40)
    noise = np.repeat(generator.normal((0.1, 0.0), (0.3, 1.0), (50, 1, 2)), 40, axis=1).astype(np.float32)
    samples.drive(np.zeros(3), np.zeros(3), np.zeros((40, 2), dtype=np.float32), noise, LIMITS, 0.05)
    return samples


def scene(rollouts, path, footprint=ROBOT, **more):
    given = control(path, **more)
    free = np.ones(path.shape[0], dtype=bool)
    for i, (x, y, _) in enumerate(path):
        free[i] = given.costmap.cost_at(x, y) < 253
    furthest = furthest_reached(rollouts.x, rollouts.y, path[:, :2].copy())
    return Scene(given, footprint, distances_along(path), free, furthest, 0.05, LIMITS)


def costs_of(critic, rollouts, seen):
    rollouts.costs[:] = 0.0
    rollouts.collides[:] = False
    critic.score(rollouts, seen)
    return rollouts.costs.astype(float)


def test_the_furthest_point_is_the_one_that_some_end_is_nearest_to(rollouts):
    path = line((3.0, 0.0))
    ends = np.stack([rollouts.x[:, -1], rollouts.y[:, -1]], axis=-1)
    nearest = np.linalg.norm(ends[:, None] - path[None, :, :2], axis=2).argmin(axis=1)
    assert scene(rollouts, path).furthest == nearest.max()


def test_goal_critic_is_the_mean_distance_and_only_near_the_goal(rollouts):
    path = line((1.0, 0.3))
    expected = 5.0 * np.hypot(rollouts.x - 1.0, rollouts.y - 0.3).mean(axis=1)
    assert np.allclose(costs_of(GoalCritic(), rollouts, scene(rollouts, path)), expected, rtol=1e-4)
    assert not costs_of(GoalCritic(), rollouts, scene(rollouts, line((3.0, 0.0)))).any()


def test_goal_angle_critic_counts_within_the_tolerance_only(rollouts):
    near = scene(rollouts, line((0.1, 0.0), heading=3.0))
    turned = np.abs((rollouts.yaw.astype(float) - 3.0 + math.pi) % (2.0 * math.pi) - math.pi)
    assert np.allclose(costs_of(GoalAngleCritic(), rollouts, near), 3.0 * turned.mean(axis=1), rtol=1e-4)
    assert not costs_of(GoalAngleCritic(), rollouts, scene(rollouts, line((0.4, 0.0), heading=3.0))).any()


def test_path_align_critic_matches_points_by_length(rollouts):
    path = line((3.0, 0.4))
    along = distances_along(path)
    expected = []
    for b in range(50):
        points = np.stack([rollouts.x[b], rollouts.y[b]], axis=-1)[3::4].astype(float)
        travelled = np.cumsum(np.hypot(*np.diff(np.concatenate([[[0.0, 0.0]], points]), axis=0).T))
        index = np.minimum(np.searchsorted(along, travelled), path.shape[0] - 1)
        expected.append(10.0 * np.hypot(*(points - path[index, :2]).T).mean())
    assert np.allclose(costs_of(PathAlignCritic(), rollouts, scene(rollouts, path)), expected, rtol=1e-4)


def test_path_align_critic_is_silent_where_the_path_is_blocked(rollouts):
    blocked = ground([(0.5, 0.0), (0.55, 0.0), (0.6, 0.0)])
    assert not costs_of(PathAlignCritic(), rollouts, scene(rollouts, line((3.0, 0.0)), costmap=blocked)).any()


def test_path_follow_critic_draws_to_a_free_point_ahead(rollouts):
    path = line((3.0, 0.0))
    blocked = scene(rollouts, path, costmap=ground([(1.2, 0.0)]))
    target = path[blocked.next_free(blocked.furthest + 6)]
    assert blocked.path_free[np.flatnonzero((path == target).all(axis=1))[0]]
    expected = 5.0 * np.hypot(rollouts.x[:, -1] - target[0], rollouts.y[:, -1] - target[1])
    assert np.allclose(costs_of(PathFollowCritic(), rollouts, blocked), expected, rtol=1e-4)
    assert not costs_of(PathFollowCritic(), rollouts, scene(rollouts, line((1.0, 0.0)))).any()


def test_path_angle_critic_counts_when_the_robot_looks_away(rollouts):
    assert not costs_of(PathAngleCritic(), rollouts, scene(rollouts, line((3.0, 0.0)))).any()
    side = scene(rollouts, line((0.0, 3.0)))
    target = side.control.path[side.next_free(side.furthest + 4)]
    bearing = np.arctan2(target[1] - rollouts.y[:, -1], target[0] - rollouts.x[:, -1])
    away = np.abs((bearing - rollouts.yaw[:, -1] + math.pi) % (2.0 * math.pi) - math.pi)
    assert np.allclose(costs_of(PathAngleCritic(), rollouts, side), 2.0 * away, rtol=1e-3)


def test_prefer_forward_critic_is_the_distance_in_reverse(rollouts):
    expected = 5.0 * 0.05 * np.maximum(-rollouts.vx, 0.0).sum(axis=1)
    assert expected.max() > 0.0
    assert np.allclose(
        costs_of(PreferForwardCritic(), rollouts, scene(rollouts, line((3.0, 0.0)))), expected, rtol=1e-4
    )


def test_twirling_critic_is_the_mean_turn(rollouts):
    expected = 10.0 * np.abs(rollouts.wz).mean(axis=1)
    assert np.allclose(costs_of(TwirlingCritic(), rollouts, scene(rollouts, line((3.0, 0.0)))), expected, rtol=1e-4)


def test_cost_critic_sums_prices_and_notes_contact(rollouts):
    seen = scene(rollouts, line((3.0, 0.0)), costmap=ground([(0.7, 0.3)]))
    costs = costs_of(CostCritic(), rollouts, seen)
    costmap = seen.control.costmap
    for b in range(50):
        under = [
            costmap.cost_at(float(x), float(y)) for x, y in zip(rollouts.x[b, 1::2], rollouts.y[b, 1::2], strict=True)
        ]
        contact = any(253 <= c < 255 for c in under)
        assert contact == rollouts.collides[b]
        if contact:
            assert costs[b] >= 500_000.0
        else:
            assert costs[b] == pytest.approx(10.0 * np.mean((np.array(under) / 254.0) ** 3), rel=1e-3, abs=1e-6)
    assert rollouts.collides.any()
    assert not rollouts.collides.all()


def test_near_the_goal_only_what_costs_more_than_the_goal_counts(rollouts):
    seen = scene(rollouts, line((0.3, 0.0)), costmap=ground([(0.3, 0.35)]))
    costs = costs_of(CostCritic(), rollouts, seen)
    harmless = ~rollouts.collides
    far = scene(rollouts, line((0.3, 0.0)), costmap=seen.control.costmap, distance=2.0)
    assert (costs[harmless] <= costs_of(CostCritic(), rollouts, far)[harmless]).all()


def test_a_robot_that_touches_already_is_not_stuck(rollouts):
    seen = scene(rollouts, line((3.0, 0.0)), costmap=ground([(-0.15, 0.0)]))
    assert seen.control.costmap.cost_at(0.0, 0.0) == 253
    costs_of(CostCritic(), rollouts, seen)
    assert not rollouts.collides.all()


def test_the_outline_of_a_long_robot_is_considered_when_asked_for(rollouts):
    box = Footprint.of_corners(np.array([[0.5, 0.1], [0.5, -0.1], [-0.5, -0.1], [-0.5, 0.1]]))
    seen = scene(rollouts, line((3.0, 0.0)), box, costmap=ground([(0.9, 0.05)], radius=0.1))
    costs_of(CostCritic(), rollouts, seen)
    by_centre = rollouts.collides.copy()
    costs_of(CostCritic(CostCriticParameters(consider_footprint=True)), rollouts, seen)
    assert (rollouts.collides | ~by_centre).all()
    assert rollouts.collides.sum() > by_centre.sum()


def test_a_power_is_of_the_weighted_cost(rollouts):
    seen = scene(rollouts, line((3.0, 0.0)))
    once = costs_of(TwirlingCritic(), rollouts, seen)
    squared = costs_of(TwirlingCritic(TwirlingCriticParameters(cost_power=2)), rollouts, seen)
    assert np.allclose(squared, once**2, rtol=1e-4)


def test_path_align_critic_adds_angles_to_the_path_s_poses(rollouts):
    seen = scene(rollouts, line((3.0, 0.4)))
    with_angles = costs_of(PathAlignCritic(PathAlignCriticParameters(use_path_orientations=True)), rollouts, seen)
    without = costs_of(PathAlignCritic(), rollouts, seen)
    assert (with_angles >= without - 1e-4).all()
    assert (with_angles[np.abs(rollouts.wz).max(axis=1) > 1.0] > without[np.abs(rollouts.wz).max(axis=1) > 1.0]).all()


def test_path_align_legacy_critic_takes_the_nearest_pose(rollouts):
    path = line((3.0, 0.4))
    seen = scene(rollouts, path)
    near = path[: seen.furthest + 1]
    points = np.stack([rollouts.x, rollouts.y], axis=-1)[:, 3::4].astype(float)
    expected = 10.0 * np.hypot(*(points[:, :, None] - near[None, None, :, :2]).transpose(3, 0, 1, 2)).min(axis=2).mean(
        1
    )
    assert np.allclose(costs_of(PathAlignLegacyCritic(), rollouts, seen), expected, rtol=1e-4)


@pytest.mark.parametrize(("mode", "end", "silent"), [(0, (-3.0, 0.0), False), (1, (-3.0, 0.0), True)])
def test_path_angle_critic_lets_a_robot_reverse_when_asked_for(rollouts, mode, end, silent):
    critic = PathAngleCritic(PathAngleCriticParameters(mode=mode))
    assert costs_of(critic, rollouts, scene(rollouts, line(end))).any() != silent


def test_path_angle_critic_follows_the_side_that_the_path_faces(rollouts):
    path = line((-3.0, 0.0))
    path[:, 2] = 0.0  # driven backwards
    critic = PathAngleCritic(PathAngleCriticParameters(mode=2))
    assert not costs_of(critic, rollouts, scene(rollouts, path)).any()
    assert costs_of(critic, rollouts, scene(rollouts, line((-3.0, 0.0)))).any()


def test_constraint_critic_counts_speed_above_the_limit_and_curves_that_are_too_tight(rollouts):
    seen = scene(rollouts, line((3.0, 0.0)))
    assert not costs_of(ConstraintCritic(), rollouts, seen).any()
    rollouts.vy[:] = 0.4
    speed = np.hypot(rollouts.vx, 0.4) * np.sign(rollouts.vx)
    expected = 4.0 * 0.05 * (np.maximum(speed - 0.5, 0.0) + np.maximum(-0.3 - speed, 0.0)).sum(axis=1)
    assert np.allclose(costs_of(ConstraintCritic(), rollouts, seen), expected, rtol=1e-3)
    rollouts.vy[:] = 0.0
    steering = replace(seen, limits=replace(LIMITS, curvature_max=2.0))
    inside = np.maximum(0.5 - np.abs(rollouts.vx) / np.abs(rollouts.wz), 0.0).sum(axis=1)
    assert np.allclose(costs_of(ConstraintCritic(), rollouts, steering), 4.0 * 0.05 * inside, rtol=1e-3)


def test_velocity_deadband_critic_counts_what_lies_within(rollouts):
    critic = VelocityDeadbandCritic(VelocityDeadbandCriticParameters(deadband_velocities=(0.05, 0.0, 0.3)))
    within = np.maximum(0.05 - np.abs(rollouts.vx), 0.0) + np.maximum(0.3 - np.abs(rollouts.wz), 0.0)
    expected = 35.0 * 0.05 * within.sum(axis=1)
    assert np.allclose(costs_of(critic, rollouts, scene(rollouts, line((3.0, 0.0)))), expected, rtol=1e-3)


def test_obstacles_critic_repels_by_distance_and_notes_contact(rollouts):
    obstacle = np.array([0.725, 0.325])
    parameters = ObstaclesCriticParameters(cost_scaling_factor=4.0, inflation_radius=0.55)
    seen = scene(rollouts, line((3.0, 0.0)), costmap=ground([tuple(obstacle)]))
    costs = costs_of(ObstaclesCritic(parameters), rollouts, seen)
    for b in range(50):
        under = np.array(
            [
                seen.control.costmap.cost_at(float(x), float(y))
                for x, y in zip(rollouts.x[b], rollouts.y[b], strict=True)
            ]
        )
        assert rollouts.collides[b] == (under >= 253).any()
        if rollouts.collides[b]:
            assert costs[b] == pytest.approx(100_000.0)
            continue
        near = np.where(under > 0, np.log(252.0 / np.maximum(under, 1)) / 4.0, np.inf)
        repelled = np.maximum(0.55 - near, 0.0).mean()
        critical = np.maximum(0.1 - near, 0.0).sum()
        assert costs[b] == pytest.approx(1.5 * repelled + 20.0 * critical, rel=1e-3, abs=1e-5)
    assert rollouts.collides.any()
