"""Turning to a point and driving there ends at the point, from anywhere."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.controllers.mppi.proposals import turn_then_drive
from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts

REST = np.zeros(3)
LIMITS = Limits(-0.2, 0.5, 1.8, -2.5, 2.5, 3.2)


@given(
    x=st.floats(-3.0, 3.0),
    y=st.floats(-3.0, 3.0),
    yaw=st.floats(-math.pi, math.pi),
    dx=st.floats(-0.3, 0.3),
    dy=st.floats(-0.3, 0.3),
)
def test_the_robot_ends_at_the_point(x, y, yaw, dx, dy):
    controls = turn_then_drive(np.array([x, y, yaw]), REST, (x + dx, y + dy), LIMITS, 100, 0.05)
    assert np.abs(controls[:, 0]).max() <= 0.5 + 1e-6
    assert np.abs(controls[:, 1]).max() <= 1.8 + 1e-6
    rollouts = Rollouts.empty(1, 100)
    pose = np.array([x, y, yaw])
    rollouts.drive(pose, np.zeros(3), controls, np.zeros((1, 100, 2), dtype=np.float32), LIMITS, 0.05)
    end = math.hypot(rollouts.x[0, -1] - x - dx, rollouts.y[0, -1] - y - dy)
    assert end < 0.02


def test_at_the_point_it_stands():
    assert not turn_then_drive(np.array([1.0, 2.0, 0.3]), REST, (1.0, 2.0), LIMITS, 20, 0.05).any()


def test_it_does_not_drive_before_it_faces_the_point():
    controls = turn_then_drive(np.zeros(3), REST, (0.0, 1.0), LIMITS, 40, 0.05)
    assert controls[0, 0] == 0.0
    assert controls[0, 1] > 0.0
    assert np.diff(controls[:, 1]).max() <= 3.2 * 0.05 + 1e-6
    turned = 0.05 * np.cumsum(controls[:, 1])
    assert (controls[turned < math.pi / 2 - 0.2, 0] == 0.0).all()
