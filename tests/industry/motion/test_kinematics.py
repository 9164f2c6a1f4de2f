"""Kinematics of arms against products of exponentials, closed forms at named poses, and properties."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm

from daidalos.industry.motion.kinematics import (
    Singularity,
    confdata,
    forward,
    inverse,
    joints_of_configuration,
    singularities,
    within_limits,
)
from daidalos.industry.robots import ARMS, Arm, Axis

Matrix = NDArray[np.float64]
arms = st.sampled_from(list(ARMS.values()))
shares = st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6)


def of_shares(arm: Arm, share: list[float]) -> Matrix:
    low, high = arm.limits.T
    return low + np.array(share) * (high - low)


def product_of_exponentials(arm: Arm, angles: Matrix) -> Matrix:
    """Return the pose of tool0 from six screws and the pose at angles zero."""
    up = arm.base_height + arm.lower_arm
    wrist = arm.shoulder_offset + arm.forearm
    screws = [
        ((0, 0, 1), (0, 0, 0)),
        ((0, 1, 0), (arm.shoulder_offset, 0, arm.base_height)),
        ((0, 1, 0), (arm.shoulder_offset, 0, up)),
        ((1, 0, 0), (0, 0, up + arm.elbow_offset)),
        ((0, 1, 0), (wrist, 0, up + arm.elbow_offset)),
        ((1, 0, 0), (0, 0, up + arm.elbow_offset)),
    ]
    pose = np.eye(4)
    for (axis, point), angle in zip(screws, angles, strict=True):
        twist = np.zeros((4, 4))
        twist[:3, :3] = np.cross(axis, np.eye(3)).T
        twist[:3, 3] = np.cross(point, axis)
        pose = pose @ expm(angle * twist)
    zero = np.array([[0, 0, 1, wrist + arm.flange], [0, 1, 0, 0], [-1, 0, 0, up + arm.elbow_offset], [0, 0, 0, 1.0]])
    return pose @ zero


def difference(one: Matrix, other: Matrix) -> Matrix:
    """Return the difference of angles [rad], whole turns apart."""
    return np.abs((one - other + math.pi) % (2 * math.pi) - math.pi)


@given(arms, shares)
@settings(max_examples=200, deadline=None)
def test_forward_is_the_product_of_exponentials(arm: Arm, share: list[float]) -> None:
    angles = of_shares(arm, share)
    np.testing.assert_allclose(forward(arm, angles), product_of_exponentials(arm, angles), atol=1e-12)


@given(arms, shares)
@settings(max_examples=500, deadline=None)
def test_every_solution_leads_to_the_pose(arm: Arm, share: list[float]) -> None:
    pose = forward(arm, of_shares(arm, share))
    solutions = inverse(arm, pose)
    assert solutions.reachable.any()
    for angles in solutions.joints[solutions.reachable]:
        np.testing.assert_allclose(forward(arm, angles), pose, atol=1e-9)
    inside = solutions.joints[solutions.within_limits]
    assert within_limits(arm, inside).all()


@given(arms, shares)
@settings(max_examples=500, deadline=None)
def test_the_angles_of_a_pose_are_among_its_solutions(arm: Arm, share: list[float]) -> None:
    angles = of_shares(arm, share)
    if singularities(arm, angles, angle=1e-3, distance=1e-3):
        return
    solutions = inverse(arm, forward(arm, angles))
    cfx = confdata(arm, angles)[3]
    assert difference(solutions.joints[cfx], angles).max() < 1e-7
    others = np.delete(solutions.joints, cfx, axis=0)
    assert (np.nanmax(difference(others, angles), axis=-1, initial=0.0, where=np.isfinite(others)) > 1e-7).sum() == (
        np.isfinite(others[:, 0]).sum()
    )


@given(arms, shares)
@settings(max_examples=300, deadline=None)
def test_solutions_stand_in_the_order_of_cfx(arm: Arm, share: list[float]) -> None:
    angles = of_shares(arm, share)
    if singularities(arm, angles, angle=1e-3, distance=1e-3):
        return
    solutions = inverse(arm, forward(arm, angles))
    found = solutions.joints[solutions.reachable]
    np.testing.assert_array_equal(confdata(arm, found)[:, 3], np.flatnonzero(solutions.reachable))


@given(arms, shares)
@settings(max_examples=300, deadline=None)
def test_a_configuration_gives_the_angles_back_with_their_turns(arm: Arm, share: list[float]) -> None:
    angles = of_shares(arm, share)
    cf = confdata(arm, angles)
    near_a_quadrant = np.abs(np.sin(2.0 * angles[[0, 3, 5]])) < 1e-5
    if singularities(arm, angles, angle=1e-3, distance=1e-3) or near_a_quadrant.any():
        return
    inner = arm.limits + np.array([[1e-6, -1e-6]])
    if not ((angles > inner[:, 0]) & (angles < inner[:, 1])).all():
        return
    found = joints_of_configuration(arm, forward(arm, angles), tuple(cf.tolist()))
    np.testing.assert_allclose(found, angles, atol=1e-7)


@pytest.mark.parametrize(
    ("degrees", "cf"),
    [
        ((0, 0, 0, 0, 30, 0), (0, 0, 0, 0)),
        ((-1, 0, 0, -1, -30, -1), (-1, -1, -1, 1)),
        ((91, 0, 0, 91, 30, 181), (1, 1, 2, 0)),
        ((0, 0, 0, -91, 30, -271), (0, -2, -4, 0)),
        ((0, 60, -105, 0, 30, 399), (0, 0, 4, 2)),
        ((0, 60, -105, 0, -30, 0), (0, 0, 0, 3)),
        ((0, -100, 0, 0, 30, 0), (0, 0, 0, 4)),
        ((0, -100, 0, 0, -30, 0), (0, 0, 0, 5)),
        ((0, -60, -109, 0, 30, 0), (0, 0, 0, 6)),
        ((0, -60, -109, 0, -30, 0), (0, 0, 0, 7)),
    ],
)
def test_confdata_of_poses_that_a_robot_programmer_can_see(degrees: tuple[float, ...], cf: tuple[int, ...]) -> None:
    assert tuple(confdata(ARMS["irb120"], np.radians(degrees))) == cf


def test_the_pose_at_angles_zero_is_that_of_the_drawing() -> None:
    pose = forward(ARMS["irb120"], np.zeros(6))
    np.testing.assert_allclose(pose[:3, 3], [0.374, 0.0, 0.63], atol=1e-15)
    np.testing.assert_allclose(pose[:3, :3], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-15)


def test_singularities_are_named() -> None:
    arm = ARMS["irb1600"]
    assert singularities(arm, np.zeros(6)) == Singularity.WRIST
    assert singularities(arm, np.radians([0, 30, -90, 0, 40, 0])) == Singularity.ELBOW
    # Axis 3 at -90 degrees stretches this arm; axis 2 then puts the wrist above axis 1.
    stretched = -math.asin(arm.shoulder_offset / (arm.lower_arm + arm.forearm))
    above = np.array([0.3, stretched, -math.pi / 2, 0.0, 0.0, 0.0])
    assert singularities(arm, above) == Singularity.WRIST | Singularity.ELBOW | Singularity.SHOULDER
    assert singularities(arm, np.radians([10, 20, 30, 40, 50, 60])) == 0


def test_the_singular_poses_are_solved() -> None:
    arm = ARMS["irb1600"]
    stretched = -math.asin(arm.shoulder_offset / (arm.lower_arm + arm.forearm))
    for angles in ([0.3, stretched, -math.pi / 2, 0.2, 0.0, 0.1], [0.4, 0.5, -math.pi / 2, 0.2, 1e-9, 0.1], [0] * 6):
        pose = forward(arm, np.array(angles))
        solutions = inverse(arm, pose)
        found = solutions.joints[solutions.reachable]
        assert len(found) >= 2
        np.testing.assert_allclose(forward(arm, found), np.broadcast_to(pose, (len(found), 4, 4)), atol=1e-9)


def test_axis_4_is_zero_in_the_wrist_singularity() -> None:
    arm = ARMS["irb120"]
    solutions = inverse(arm, forward(arm, np.radians([20, 10, -30, 15, 0, 25])))
    np.testing.assert_allclose(np.degrees(solutions.joints[:2]), [[20, 10, -30, 0, 0, 40]] * 2, atol=1e-9)
    assert solutions.within_limits[:2].all()


def test_a_pose_out_of_reach_has_no_solution() -> None:
    arm = ARMS["irb120"]
    pose = forward(arm, np.zeros(6))
    pose[0, 3] = 0.7
    solutions = inverse(arm, pose)
    assert not solutions.reachable.any()
    assert not solutions.within_limits.any()
    assert np.isnan(solutions.joints).all()
    with pytest.raises(ValueError, match=r"out of reach of ABB IRB 120-3/0.6 with cfx 0"):
        joints_of_configuration(arm, pose, (0, 0, 0, 0))


def test_the_reach_ends_where_the_maker_says() -> None:
    for arm in ARMS.values():
        assert arm.wrist_reach == pytest.approx(arm.reach, abs=0.008)


def test_shapes_are_kept() -> None:
    arm = ARMS["irb6700"]
    angles = np.random.default_rng(1).uniform(*arm.limits.T, (2, 3, 6))
    poses = forward(arm, angles)
    assert poses.shape == (2, 3, 4, 4)
    assert inverse(arm, poses).joints.shape == (2, 3, 8, 6)
    assert confdata(arm, angles).shape == (2, 3, 4)
    assert inverse(arm, np.empty((0, 4, 4))).joints.shape == (0, 8, 6)


def test_what_is_no_pose_is_refused() -> None:
    arm = ARMS["irb120"]
    good = forward(arm, np.zeros(6))
    wrong = [2.0 * good, np.full((4, 4), np.nan), good * [-1, 1, 1, 1], good + [[0, 0, 0, np.inf]] * 4]
    for matrix in wrong:
        with pytest.raises(ValueError, match="pose 1 is no rotation"):
            inverse(arm, np.stack([good, matrix]))
    with pytest.raises(ValueError, match=r"\(\.\.\., 4, 4\) is needed"):
        inverse(arm, np.eye(3))
    with pytest.raises(ValueError, match=r"\(\.\.\., 6\) is needed"):
        forward(arm, np.zeros(7))
    with pytest.raises(ValueError, match="not finite"):
        confdata(arm, np.full(6, np.nan))


def test_a_configuration_that_does_not_fit_names_the_axis() -> None:
    arm = ARMS["irb120"]
    pose = forward(arm, np.radians([10, 20, 30, 40, 50, 60]))
    with pytest.raises(ValueError, match="cfx is 8"):
        joints_of_configuration(arm, pose, (0, 0, 0, 8))
    with pytest.raises(ValueError, match=r"axis 4 is at 40.000 deg with cfx 0: quadrant 0, where cf4 is 1"):
        joints_of_configuration(arm, pose, (0, 1, 0, 0))
    with pytest.raises(ValueError, match=r"axis 6 would be at 780.000 deg, outside -400 to 400 deg"):
        joints_of_configuration(arm, pose, (0, 0, 8, 0))
    assert np.degrees(joints_of_configuration(arm, pose, (0, 0, -4, 0)))[5] == pytest.approx(-300)


@pytest.mark.parametrize(("cf4", "degrees"), [(0, 0.0), (-1, 0.0), (-4, -360.0), (-5, -360.0)])
def test_a_configuration_may_name_either_quadrant_at_a_border(cf4: int, degrees: float) -> None:
    wide = Axis.from_degrees(-400, 400, 100)
    arm = replace(ARMS["irb6700"], axes=(*ARMS["irb6700"].axes[:3], wide, wide, wide))
    pose = forward(arm, np.radians([10, 20, 30, 0, 50, 60]))
    assert np.degrees(joints_of_configuration(arm, pose, (0, cf4, 0, 0)))[3] == pytest.approx(degrees, abs=1e-6)
