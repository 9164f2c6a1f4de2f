"""Calibration of a moving head: exact where nothing is noisy, honest about errors where something is."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daidalos.common.pose3 import Pose
from daidalos.industry.lighting.calibration import (
    NOISE,
    CalibrationError,
    Observation,
    calibrate,
    expected_errors,
    grid,
    miss,
    propose,
)  # fmt: skip
from daidalos.industry.lighting.kinematics import Angles, Geometry
from daidalos.industry.lighting.law_of_sines import calibrate_by_sines, choose_line, distance_to_end

START = Geometry(Pose.from_xyz_rpy((0.0, 0.0, 2.5), (math.pi, 0.0, 0.0)))
CORNERS = [(x, y, 0.0) for x in (-1.0, 1.0) for y in (-0.75, 0.75)]
TABLE = grid((-1.0, -0.75), (1.0, 0.75), 0.0, 5)


def truth(yaw=1.0, x=0.3, y=-0.2, angles=(0.007, -0.006, 0.008)):
    return Geometry(Pose.from_xyz_rpy((x, y, 2.8), (math.pi + 0.02, -0.03, yaw)), *angles)


def observe(geometry, points, flips=2, noise=0.0, seed=0):
    rng = np.random.default_rng(seed)
    found = []
    for point in points:
        for one in geometry.solutions(point)[:flips]:
            error = noise * rng.normal(size=2)
            found.append(Observation(point, Angles(one.pan + error[0], one.tilt + error[1])))
    return found


@settings(max_examples=10, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(-0.5, 0.5), st.floats(-0.4, 0.4), st.tuples(*[st.floats(-0.008, 0.008)] * 3))
def test_without_noise_the_head_is_found(yaw, x, y, angles):
    true = truth(yaw, x, y, angles)
    found = calibrate(observe(true, CORNERS), START)
    assert found.geometry.tilt_zero == pytest.approx(angles[0], abs=2e-4)  # the prior draws a little
    # All corners at one tilt, under the table's middle, tell the skews from each other no more than the prior does.
    assert found.geometry.axis_skew + found.geometry.beam_skew == pytest.approx(angles[1] + angles[2], abs=6e-3)
    assert found.residual < 1e-4
    misses = [miss(true, found.geometry.solutions(target)[0], target) for target in CORNERS]
    assert max(misses) < 1e-4


def test_a_head_that_stands_is_found_from_a_start_that_hangs():
    true = Geometry(Pose.from_xyz_rpy((0.1, 0.2, -1.0), (0.02, 0.01, 2.0)))
    found = calibrate(observe(true, CORNERS), START)
    assert found.geometry.pose.position == pytest.approx(true.pose.position, abs=1e-4)


def test_the_covariance_is_that_of_many_calibrations():
    true, errors, expected = truth(), [], []
    for seed in range(40):
        found = calibrate(observe(true, CORNERS, noise=NOISE, seed=seed), START)
        errors.append(np.array(found.geometry.pose.position) - true.pose.position)
        expected.append(np.sqrt(np.diag(found.covariance)[:3]))
    ratio = np.std(errors, axis=0) / np.mean(expected, axis=0)
    assert np.all((ratio > 0.6) & (ratio < 1.5)), ratio


def test_expected_errors_are_those_that_come():
    true, squares, expected = truth(), [], []
    for seed in range(30):
        found = calibrate(observe(true, CORNERS, noise=NOISE, seed=seed), START)
        squares.append([miss(true, found.geometry.solutions(target)[0], target) ** 2 for target in TABLE])
        expected.append(expected_errors(found, TABLE))
    ratio = np.sqrt(np.mean(squares, axis=0)) / np.mean(expected, axis=0)
    assert 0.6 < np.median(ratio) < 1.5
    assert ratio.max() < 2.5


def test_both_flips_are_worth_more_than_one():
    one, both = (calibrate(observe(truth(), CORNERS, flips, NOISE), START) for flips in (1, 2))
    assert expected_errors(one, TABLE).max() > 5 * expected_errors(both, TABLE).max()


def test_the_proposed_point_helps_more_than_the_others():
    true = truth()
    given_ones = observe(true, CORNERS[:3], flips=1)
    found = calibrate(given_ones, START)
    candidates = [one for place in TABLE for one in observe(found.geometry, [place])]
    best = propose(found, TABLE, candidates)

    def worst_after(candidate):
        angles = min(true.solutions(candidate.point), key=lambda one: abs(one.tilt - candidate.angles.tilt))
        after = calibrate([*given_ones, Observation(candidate.point, angles)], START)
        return expected_errors(after, TABLE).max()

    others = [worst_after(one) for one in candidates[::6]]
    assert worst_after(best) <= np.min(others) * 1.1
    assert worst_after(best) < 0.8 * expected_errors(found, TABLE).max()


@pytest.mark.parametrize(
    ("observations", "words"),
    [
        ([], "0 points are too few"),
        (observe(truth(), CORNERS[:2]), "2 points are too few"),
        (observe(truth(), [(0.0, y, 0.0) for y in (-0.5, 0.0, 0.5)]), "do not determine the pose"),
        (
            [
                Observation(one.point, other.angles)
                for one, other in zip(
                    observe(truth(), CORNERS), observe(truth(), [CORNERS[i] for i in (1, 0, 2, 3)]), strict=True
                )
            ],
            "check their order",
        ),
        ([Observation((math.nan, 0.0, 0.0), Angles(0.0, 0.0))] * 4, "not finite"),
    ],
)
def test_what_does_not_determine_the_head_is_refused(observations, words):
    with pytest.raises(CalibrationError, match=words):
        calibrate(observations, START)


@given(st.floats(-3.0, 3.0), st.floats(0.5, 4.0), st.floats(0.2, 2.0))
def test_the_law_of_sines_gives_the_distance_on_both_sides_of_the_right_angle(along, away, length):
    head = np.array([along, away])
    ends = np.array([[0.0, 0.0], [length / 2, 0.0], [length, 0.0]]) - head

    def seen(one, other):
        return math.atan2(abs(float(np.linalg.det(np.array([one, other])))), float(one @ other))

    found = distance_to_end(length, seen(ends[0], ends[2]), seen(ends[1], ends[2]))
    assert found.distance == pytest.approx(float(np.linalg.norm(ends[2])), rel=1e-6)


def test_a_line_is_found_among_the_points():
    true = truth(angles=(0.0, 0.0, 0.0))
    points = [(-1.0, -0.75, 0.0), (1.0, 0.75, 0.0), (0.3, 0.75, 0.0), (1.0, -0.75, 0.0), (0.0, -0.75, 0.0)]
    observations = observe(true, points, 1)
    chosen = choose_line([*observations, *observe(true, points, 1)])  # each point twice
    assert [one.point for one in chosen] == [points[0], points[4], points[3], points[1]]
    assert choose_line(observations[:4]) is None
    assert choose_line([observations[0], observations[4], observations[3]]) is None


def test_the_method_of_the_workshop_finds_the_pose():
    true = truth(angles=(0.0, 0.0, 0.0))
    points = [(-1.0, -0.75, 0.0), (0.0, -0.75, 0.0), (1.0, -0.75, 0.0), (0.3, 0.75, 0.0)]
    found, end = calibrate_by_sines(observe(true, points, 1))
    assert found.pose.position == pytest.approx(true.pose.position, abs=1e-6)
    for target in TABLE:
        assert miss(true, found.solutions(target)[0], target) < 1e-6
    assert end.distance == pytest.approx(math.dist(true.pose.position, points[2]))
    # A pair of angles that is off by 0.05 degrees moves the distance as the amplification says.
    assert end.amplification * math.radians(0.05) == pytest.approx(0.0125, rel=0.6)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (CORNERS[:3], "needs 4 points"),
        (CORNERS, "must be in the middle"),
        ([(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 0.0), (1.4, 0.0, 0.0)], "must be beside the line"),
    ],
)
def test_points_that_the_law_of_sines_cannot_use(points, words):
    with pytest.raises(CalibrationError, match=words):
        calibrate_by_sines(observe(truth(), points, 1))
