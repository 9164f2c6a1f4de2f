"""What assertions require, and what they say."""

import math
from types import SimpleNamespace

import pytest

from daidalos.common.errors import UserError
from daidalos.testing.conditions import condition, read_field
from daidalos.testing.graph import PoseValue


def test_limits_and_tolerances() -> None:
    both = condition(above=1, below=2)
    assert (both.holds(1.5), both.holds(1.0), both.holds(2.0)) == (True, False, False)
    assert both.text == "above 1 and below 2"
    near = condition(equals=1.0, tolerance=0.1)
    assert (near.holds(1.09), near.holds(1.11), near.text) == (True, False, "1 within 0.1")
    assert condition(between=(0, 1)).holds(1)
    assert condition(pytest.approx(2.0, abs=0.1)).holds(2.05)
    assert not condition(equals="a", tolerance=1.0).holds("b")
    with pytest.raises(UserError, match="the assertion has no condition"):
        condition(tolerance=0.1)


def test_angles_are_compared_within_a_turn() -> None:
    pose = PoseValue(1.0, 2.0, 0.0, 0.0, 0.0, math.pi - 0.01)
    assert condition(x=1.05, yaw=-math.pi, tolerance=0.1).holds(pose)
    assert not condition(x=1.05, yaw=0.0, tolerance=0.1).holds(pose)
    assert not condition(x=1.05, yaw=-math.pi, tolerance=0.1, yaw_tolerance=0.001).holds(pose)
    nearest = condition(x=2.0, tolerance=0.1)
    assert nearest.miss is not None
    assert nearest.miss(pose) == pytest.approx(1.0)


def test_fields_are_found_or_named() -> None:
    value = SimpleNamespace(pose=SimpleNamespace(x=[1.0, 2.0]))
    assert read_field(value, "pose.x[1]") == 2.0
    with pytest.raises(UserError, match=r"'pos\.x': SimpleNamespace has no 'pos'; did you mean 'pose'\?"):
        read_field(value, "pos.x")
    with pytest.raises(UserError, match=r"list has no '\[7\]'"):
        read_field(value, "pose.x[7]")
