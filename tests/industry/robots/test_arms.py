"""Data of arms: what is checked, and how an unknown name ends."""

from dataclasses import replace

import pytest

from daidalos.industry.robots import ARMS, Axis, arm_named


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
