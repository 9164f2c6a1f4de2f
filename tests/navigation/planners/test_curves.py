"""Dubins and Reeds-Shepp curves against closed forms and against a sampler of all words."""

import math
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.planners.curves import moved, sampled, shortest_curve
from properties import examples

ANGLES = st.floats(-math.pi, math.pi)
PLACES = st.floats(-6.0, 6.0)


@pytest.mark.parametrize(
    ("pose", "forward", "both"),
    [
        ((5.0, 0.0, 0.0), 5.0, 5.0),
        ((-5.0, 0.0, 0.0), 2 * math.pi + 5.0, 5.0),
        ((0.0, 2.0, math.pi), math.pi, math.pi),
        ((1.0, 1.0, math.pi / 2), math.pi / 2, math.pi / 2),
        ((-1.0, 1.0, -math.pi / 2), 3 * math.pi / 2, math.pi / 2),
        ((0.0, 0.0, math.pi), 7 * math.pi / 3, math.pi),
        ((4.0, 4.0, 0.0), None, None),
    ],
)
def test_lengths_are_those_of_closed_forms(pose, forward, both):
    if forward is not None:
        assert shortest_curve(*pose, False)[0] == pytest.approx(forward, abs=1e-6)
        assert shortest_curve(*pose, True)[0] == pytest.approx(both, abs=1e-6)
    else:
        # Two arcs and the tangent between them: LSR with centres 4 and 2 apart.
        rho = math.hypot(4.0, 2.0)
        turn = math.atan2(2.0, 4.0) + math.atan2(2.0, math.sqrt(rho**2 - 4.0))
        expected = 2.0 * turn + math.sqrt(rho**2 - 4.0)
        assert shortest_curve(*pose, False)[0] == pytest.approx(expected)
        assert shortest_curve(*pose, True)[0] == pytest.approx(expected)


@examples(150)
@given(x=PLACES, y=PLACES, yaw=ANGLES, both=st.booleans())
def test_curves_lead_to_their_poses(x, y, yaw, both):
    total, turns, lengths = shortest_curve(x, y, yaw, both)
    assert total == pytest.approx(np.abs(lengths).sum())
    assert both or (lengths >= 0.0).all()
    at = (0.0, 0.0, 0.0)
    for turn, length in zip(turns, lengths, strict=True):
        at = moved(*at, turn, length)
    assert at[:2] == pytest.approx((x, y), abs=1e-5)
    assert math.remainder(at[2] - yaw, 2 * math.pi) == pytest.approx(0.0, abs=1e-5)
    reverse = shortest_curve(*moved_frame(x, y, yaw), both)[0]
    assert reverse == pytest.approx(total, abs=1e-5) or not both
    poses = sampled(turns, lengths, 2.0, 0.0, 0.0, 0.0, 0.1)
    steps = [math.hypot(*(b[:2] - a[:2])) for a, b in pairwise(poses)]
    assert max(steps, default=0.0) <= 0.1 + 1e-9


def moved_frame(x, y, yaw):
    """Return the origin in the frame of a pose, with the direction of driving turned round by symmetry."""
    return (-x * math.cos(yaw) - y * math.sin(yaw), x * math.sin(yaw) - y * math.cos(yaw), -yaw)


@examples(60)
@given(data=st.data(), both=st.booleans())
def test_no_sampled_curve_is_shorter(data, both):
    """A curve of any turns and lengths leads somewhere; the shortest one there is at most as long."""
    turns = data.draw(st.lists(st.sampled_from([-1.0, 0.0, 1.0]), min_size=1, max_size=5))
    lengths = data.draw(st.lists(st.floats(-3.0 if both else 0.0, 3.0), min_size=len(turns), max_size=len(turns)))
    at = (0.0, 0.0, 0.0)
    for turn, length in zip(turns, lengths, strict=True):
        at = moved(*at, turn, length)
    assert shortest_curve(*at, both)[0] <= np.abs(lengths).sum() + 1e-6


@pytest.mark.parametrize("turn", [-1.0, 1.0])
@pytest.mark.parametrize("length", [0.3, 2.0493000298449142, 3.9, 6.1])
def test_one_arc_is_its_own_shortest_curve_forwards(turn, length):
    assert shortest_curve(*moved(0.0, 0.0, 0.0, turn, length), False)[0] == pytest.approx(length, abs=1e-6)


@pytest.mark.parametrize("words", [((-1.0, 1.0), (1.0, 2.0)), ((1.0, -1.0), (1.0, 0.5)), ((1.0, -1.0), (2.9, 2.9))])
def test_two_arcs_without_a_straight_part_are_found(words):
    at = (0.0, 0.0, 0.0)
    for turn, length in zip(*words, strict=True):
        at = moved(*at, turn, length)
    for both in (False, True):
        assert shortest_curve(*at, both)[0] <= sum(words[1]) + 1e-6


def test_a_grid_of_words_finds_no_shorter_reeds_shepp_curve():
    """Sample three-segment curves on a grid of lengths, keep those near one pose, and compare with the curve there."""
    steps = np.linspace(-math.pi, math.pi, 13)
    for turns in ((1.0, 0.0, 1.0), (1.0, -1.0, 1.0), (1.0, 0.0, -1.0)):
        for lengths in product(steps, repeat=3):
            at = (0.0, 0.0, 0.0)
            for turn, length in zip(turns, lengths, strict=True):
                at = moved(*at, turn, length)
            assert shortest_curve(*at, True)[0] <= np.abs(lengths).sum() + 1e-6
