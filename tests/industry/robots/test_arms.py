"""Data of arms: what is checked, and how an unknown name ends."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.industry.robots import ARMS, Axis, arm_named
from daidalos.industry.robots.kuka import controller_angles, joint_angles


def test_names() -> None:
    assert arm_named("IRB120") is ARMS["irb120"]
    with pytest.raises(ValueError, match=r"there is no arm 'irb12'; did you mean 'irb120'"):
        arm_named("irb12")


def test_what_cannot_be_is_refused() -> None:
    arm = ARMS["irb120"]
    with pytest.raises(ValueError, match="lower_arm is -1"):
        replace(arm, lower_arm=-1.0)
    with pytest.raises(ValueError, match="axis 1 needs lower < upper"):
        replace(arm, axes=(Axis(1.0, -1.0, 1.0), *arm.axes[1:]))


def test_angles_of_kukas_controller() -> None:
    upright = np.zeros(6)
    np.testing.assert_allclose(np.degrees(controller_angles(upright)), [0, -90, 90, 0, 0, 0], atol=1e-12)
    joints = np.random.default_rng(1).uniform(-3, 3, (5, 6))
    np.testing.assert_allclose(joint_angles(controller_angles(joints)), joints, atol=1e-12)
    lower, upper = np.sort(np.degrees(controller_angles(ARMS["kr500_2mt"].limits.T)), axis=0)
    np.testing.assert_allclose(lower, [-185, -130, -94, -350, -118, -350])
    np.testing.assert_allclose(upper, [185, 20, 150, 350, 118, 350])
