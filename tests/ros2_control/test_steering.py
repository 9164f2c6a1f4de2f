"""Kinematics of steered bases."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.control.steering import SteeredBase

BASES = {
    "bicycle": SteeredBase(1.2, 0.3),
    "tricycle": SteeredBase(1.2, 0.3, traction_track=0.8),
    "ackermann": SteeredBase(1.2, 0.3, traction_track=0.8, steering_track=0.7),
}


@given(st.sampled_from(sorted(BASES)), st.floats(0.2, 3.0), st.floats(-0.35, 0.35), st.sampled_from([1.0, -1.0]))
def test_wheels_say_what_they_were_told(name: str, speed: float, curvature: float, way: float) -> None:
    base, turn = BASES[name], curvature * speed
    angle = base.steering_angle(way * speed, way * turn)
    assert angle is not None
    found = base.motion(base.wheel_speeds(way * speed, angle), base.wheel_angles(angle))
    assert found == pytest.approx((way * speed, way * turn), abs=1e-12)


@pytest.mark.parametrize("turn", [0.3, -0.3])
def test_every_wheel_rolls_about_the_same_point(turn: float) -> None:
    base, speed = BASES["ackermann"], 1.0
    angle = base.steering_angle(speed, turn)
    assert angle is not None
    centre = np.array([0.0, speed / turn])
    right, left = base.wheel_angles(angle)
    for steering, side in ((right, -0.35), (left, 0.35)):
        to_wheel = np.array([1.2, side]) - centre
        axle = np.array([-math.sin(steering), math.cos(steering)])
        assert abs(to_wheel[0] * axle[1] - to_wheel[1] * axle[0]) < 1e-12
    for wheel, side in zip(base.wheel_speeds(speed, angle), (-0.4, 0.4), strict=True):
        assert wheel * 0.3 == pytest.approx(turn * (centre[1] - side))


def test_a_base_that_stands_has_no_angle() -> None:
    assert BASES["bicycle"].steering_angle(0.0, 1.0) is None
    assert BASES["bicycle"].wheel_speeds(0.0, 0.5) == pytest.approx([0.0])
