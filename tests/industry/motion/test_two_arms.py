"""Paths of YuMi's two arms that keep their links apart."""

import numpy as np
import pytest

from daidalos.industry.motion.self_collision import closest_links
from daidalos.industry.motion.two_arms import TwoArmFault, TwoArms
from daidalos.industry.robots.yumi import HOME_DEG, YUMI
from daidalos.nodes.irb14000_description._two_arms import pose_above

HOME = np.radians([HOME_DEG["left"], HOME_DEG["right"]])


@pytest.fixture
def arms():
    tool = np.eye(4)
    tool[2, 3] = 0.126
    return TwoArms(YUMI, {"left": tool, "right": tool})


def grips(x, z):
    return {"left": pose_above(x, 0.12, z, np.pi / 2), "right": pose_above(x, -0.12, z, -np.pi / 2)}


def test_both_tools_go_straight_in_step(arms):
    start = arms.position_at(HOME, grips(0.36, 0.13), then=grips(0.44, 0.13))
    path = arms.straight(start, grips(0.44, 0.13))
    for joints in path:
        poses = arms.tool_poses(joints)
        distance = poses["left"][:3, 3] - poses["right"][:3, 3]
        np.testing.assert_allclose(distance, (0.0, 0.24, 0.0), atol=1e-8)
        np.testing.assert_allclose(poses["left"][:3, :3], grips(0.0, 0.0)["left"][:3, :3], atol=1e-8)
    np.testing.assert_allclose(arms.tool_poses(path[-1])["right"], grips(0.44, 0.13)["right"], atol=1e-8)
    assert closest_links(YUMI, path).distances.min() >= arms.margin


def test_a_free_path_goes_around_the_other_arm(arms):
    rng, lower, upper = np.random.default_rng(5), *YUMI.arm.limits.T
    ends = rng.uniform(0.7 * lower, 0.7 * upper, (400, 2, 2, 7))
    ways = ends[:, :1] + np.linspace(0.0, 1.0, 60)[:, None, None] * (ends[:, 1:] - ends[:, :1])
    distances = closest_links(YUMI, ways).distances
    crossing = (distances[:, [0, -1]] > 0.01).all(axis=1) & (distances.min(axis=1) < -0.02)
    before, after = ends[np.flatnonzero(crossing)[0]]
    path = arms.free(before, after)
    assert closest_links(YUMI, path).distances.min() >= arms.margin
    np.testing.assert_allclose(path[[0, -1]], [before, after])
    assert np.abs(np.diff(path, axis=0)).max() < 0.051
    np.testing.assert_array_equal(path, TwoArms(YUMI, seed=1).free(before, after))


def test_a_way_through_the_other_arm_is_refused_with_the_links(arms):
    right = arms.position_at(HOME, {"right": pose_above(0.38, 0.0, 0.12, -np.pi / 2)})
    left = arms.position_at(right, {"left": pose_above(0.38, 0.2, 0.12, np.pi / 2)})
    with pytest.raises(
        TwoArmFault, match=r"left link \d comes within -?\d+ mm of right link \d after \d+ % of the way"
    ):
        arms.straight(left, {"left": pose_above(0.38, 0.03, 0.12, np.pi / 2)})


def test_what_cannot_be_reached_is_said(arms):
    with pytest.raises(TwoArmFault, match=r"the left arm cannot reach \(900, 0, 200\) mm"):
        arms.position_at(HOME, {"left": pose_above(0.9, 0.0, 0.2, 0.0)})
    with pytest.raises(TwoArmFault, match="has no arm 'middle', but left and right"):
        arms.position_at(HOME, {"middle": np.eye(4)})


def test_times_keep_to_the_speeds_and_derivatives_fit(arms):
    goal = arms.position_at(HOME, grips(0.36, 0.13))
    timed = arms.timed(arms.free(HOME, goal), 0.5)
    speeds = np.abs(np.gradient(timed.positions, timed.times, axis=0)).max(axis=(0, 1))
    assert (speeds <= 0.5 * YUMI.arm.speeds * 1.01).all()
    assert (speeds / (0.5 * YUMI.arm.speeds)).max() > 0.9
    np.testing.assert_allclose(timed.positions[[0, -1]], [HOME, goal], atol=1e-9)
    np.testing.assert_allclose(timed.velocities[[0, -1]], 0.0, atol=1e-9)
    inner = np.gradient(timed.positions, timed.times, axis=0)[2:-2]
    np.testing.assert_allclose(timed.velocities[2:-2], inner, atol=0.02)
