"""The smooth control law: it arrives at the target's position and heading within its limits, ahead and backwards."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daidalos.common.pose2 import wrap
from daidalos.navigation.controllers.ego_polar import EgoPolarLaw, egocentric_coordinates

LAW = EgoPolarLaw(
    k_phi=3.0, k_delta=2.0, beta=0.4, lambda_=2.0, slowdown_radius=0.25, v_linear_min=0.05, v_linear_max=0.25,
    v_angular_max=0.75,
)  # fmt: skip
TARGET = np.array([1.0, 0.5, 0.4])


@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("start", [(-1.0, 0.0, 0.0), (-1.0, 2.0, -1.0), (0.0, -1.0, 1.2), (-0.5, 0.5, -0.6)])
def test_it_arrives_with_the_targets_heading_within_its_limits(
    start: tuple[float, float, float], backward: bool
) -> None:
    pose, target = np.array(start), TARGET.copy()
    if backward:  # the same curve, driven with the back ahead
        pose[2] += math.pi
        target[2] += math.pi
    for _ in range(2000):
        speed, turn = LAW.velocity(pose, target, backward=backward)
        assert abs(speed) <= LAW.v_linear_max + 1e-9
        assert abs(turn) <= LAW.v_angular_max + 1e-9
        assert (speed < 0.0) == backward
        pose = LAW.next_pose(pose, target, 0.02, backward=backward)
        if math.hypot(*(pose - target)[:2]) < 0.01:
            break
    else:
        pytest.fail(f"it ended at {pose}")
    assert abs(wrap(pose[2] - target[2])) < 0.1


def test_backwards_mirrors_ahead() -> None:
    ahead = LAW.velocity(np.zeros(3), np.array([1.0, 0.3, 0.2]))
    back = LAW.velocity(np.zeros(3), np.array([-1.0, 0.3, -0.2]), backward=True)
    assert back == pytest.approx((-ahead[0], -ahead[1]))


def test_curvature_by_hand() -> None:
    """At 2 m with the target 90 degrees off the line of sight, worked out from the paper's equation (15)."""
    r, phi, delta = egocentric_coordinates(np.zeros(3), np.array([2.0, 0.0, math.pi / 2]))
    assert (r, phi, delta) == pytest.approx((2.0, math.pi / 2, 0.0))
    steering = math.atan(3.0 * math.pi / 2)
    assert LAW.curvature(np.zeros(3), np.array([2.0, 0.0, math.pi / 2])) == pytest.approx(-2.0 * steering / 2.0)


def test_at_the_target_it_stands_still_or_creeps_straight() -> None:
    assert LAW.velocity(TARGET, TARGET) == (LAW.v_linear_min, 0.0)
    without_slowdown = EgoPolarLaw(3.0, 2.0, 0.4, 2.0, 0.0, 0.0, 0.25, 0.75)
    assert without_slowdown.velocity(np.zeros(3), np.array([1.0, 0.0, 0.0])) == (0.25, 0.0)
