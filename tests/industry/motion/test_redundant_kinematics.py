"""The kinematics of YuMi's arms, against poses and arm angles that RobotStudio prints."""

import numpy as np
import pytest

from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.industry.motion.redundant_kinematics import forward_of, inverse_of, within_ranges
from daidalos.industry.robots.yumi import HOME_DEG, YUMI, YUMI_ARM

ROBOTSTUDIO = (
    # Angles from the base on [deg], position [mm] with the base 206 mm lower, roll, pitch, yaw [deg], arm angle [deg]:
    # the reference values of Elias and Wen, "Redundancy Parameterization of the ABB YuMi Robot Arm" (2025).
    ([0] * 7, (341.5, 0, 598), (0, 90, 0), 0),
    ([20] * 7, (292.46, 234.73, 348.75), (148.67, 16.13, 175.45), 6.86),
    ([30] * 7, (165.49, 290.86, 255.37), (157.34, -19.80, -175.99), 14.50),
    ([-40] * 7, (-219.17, 12.62, 796.12), (13.67, -3.39, -152.29), 106.67),
    ([-80] * 7, (-126.60, 499.23, 441.88), (5.30, 17.08, 34.27), 99.01),
    ([104, -31, 1, -18, -55, 117, 69], (32.02, 91.43, 763.94), (157.59, 43.43, 170.70), 19.58),
    ([162, 1, -23, -88, 241, 98, -44], (45.84, 32.22, 846.74), (-98.58, 43.30, -76.21), 80.07),
    ([-20, -139, -144, 77, -263, 128, -104], (-47.12, -136.89, 270.77), (-106.88, -60.36, 122.56), 139.68),
    ([67, -142, 121, 78, -38, 113, -194], (-100.23, 3.25, 338.01), (43.05, -59.81, 44.29), -146.69),
    ([-58, -138, -35, 70, -283, 133, 207], (-123.66, 141.01, 425.04), (-118.25, -37.89, -10.09), 165.86),
)


def turns_between(first, second):
    return np.abs(np.angle(np.exp(1j * (np.asarray(first) - second))))


@pytest.mark.parametrize("case", range(len(ROBOTSTUDIO)))
def test_poses_and_arm_angles_are_those_of_robotstudio(case):
    angles, position, rpy, arm_angle = ROBOTSTUDIO[case]
    pose, found = forward_of(YUMI_ARM, np.radians(np.array(angles, dtype=float)))
    wanted = Pose((0.0, 0.0, 0.0), quaternion_from_rpy(*np.radians(rpy))).matrix
    np.testing.assert_allclose(1e3 * pose[:3, 3] + [0, 0, 206], position, atol=0.006)
    np.testing.assert_allclose(pose[:3, :3], wanted[:3, :3], atol=2e-4)
    assert turns_between(found, np.radians(arm_angle)) < np.radians(0.006)


def test_the_left_arm_begins_where_abbs_synchronisation_position_is():
    pose, _ = forward_of(YUMI_ARM, np.radians(HOME_DEG["left"]))
    # What YuMi's controller shows there in the frame of its body.
    np.testing.assert_allclose(1e3 * (YUMI.side("left") @ pose)[:3, 3], (-9.58, 182.61, 198.63), atol=1.0)


def test_the_inverse_finds_poses_with_their_arm_angles_within_the_ranges():
    joints = np.random.default_rng(1).uniform(*YUMI_ARM.limits.T, (200, 7))
    poses, arm_angles = forward_of(YUMI_ARM, joints)
    found = inverse_of(YUMI_ARM, poses, arm_angles)
    solved = np.isfinite(found).all(axis=1)
    assert solved.mean() > 0.95
    again, angles = forward_of(YUMI_ARM, found[solved])
    np.testing.assert_allclose(again, poses[solved], atol=5e-9)
    assert turns_between(angles, arm_angles[solved]).max() < 5e-9
    assert within_ranges(YUMI_ARM, found[solved]).all()


def test_the_solution_is_near_the_beginning():
    rng = np.random.default_rng(2)
    joints = rng.uniform(*(0.8 * YUMI_ARM.limits).T, (100, 7))
    poses, arm_angles = forward_of(YUMI_ARM, joints)
    found = inverse_of(YUMI_ARM, poses, arm_angles, joints + rng.normal(0.0, 0.02, joints.shape))
    assert np.median(np.abs(found - joints).max(axis=1)) < 1e-8


def test_the_arm_angle_turns_the_elbow_and_keeps_the_tool():
    pose, arm_angle = forward_of(YUMI_ARM, np.radians(HOME_DEG["left"]))
    around = arm_angle + np.radians([-15.0, 15.0])
    found = inverse_of(YUMI_ARM, np.stack([pose, pose]), around, np.radians(HOME_DEG["left"]))
    again, angles = forward_of(YUMI_ARM, found)
    np.testing.assert_allclose(again, np.stack([pose, pose]), atol=1e-8)
    assert turns_between(angles, around).max() < 1e-8


def test_what_is_out_of_reach_or_no_pose_is_said():
    pose = np.eye(4)
    pose[0, 3] = 1.0
    assert np.isnan(inverse_of(YUMI_ARM, pose)).all()
    with pytest.raises(ValueError, match="pose 0 is no rotation with a finite translation"):
        inverse_of(YUMI_ARM, np.full((4, 4), np.nan))
    with pytest.raises(ValueError, match="arm angles must be finite"):
        inverse_of(YUMI_ARM, np.eye(4), np.nan)
    with pytest.raises(ValueError, match=r"\(6,\), but \(\.\.\., 7\) is needed"):
        forward_of(YUMI_ARM, np.zeros(6))
