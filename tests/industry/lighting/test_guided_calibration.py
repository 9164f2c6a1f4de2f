"""Guided calibration: a person at the keys, taking back, resuming, proposals, and the files."""

import math

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.industry.lighting.calibration import expected_errors, grid, miss
from daidalos.industry.lighting.calibration_file import (
    read_geometry,
    read_points,
    read_session,
    write_calibration,
    write_session,
)  # fmt: skip
from daidalos.industry.lighting.guided_calibration import GuidedCalibration
from daidalos.industry.lighting.kinematics import Angles, Geometry, Limits

TRUE = Geometry(Pose.from_xyz_rpy((0.3, -0.2, 2.8), (math.pi + 0.02, -0.03, 1.0)), 0.007, -0.006, 0.008)
START = Geometry(Pose.from_xyz_rpy((0.2, 0.0, 2.7), (math.pi, 0.0, 0.9)))
CORNERS = [(x, y, 0.0) for x in (-1.0, 1.0) for y in (-0.75, 0.75)]
TABLE = grid((-1.0, -0.75), (1.0, 0.75), 0.0, 5)


def person(guided):
    """Press keys until the spot is as near to the point as the finest step allows, then confirm."""
    task = guided.task
    wanted = TRUE.solutions(task.point)[task.is_flipped]
    for _ in range(10):
        guided.press("+")
    for _ in range(5):
        for key, rest in (("right", "pan"), ("up", "tilt")):
            other = {"right": "left", "up": "down"}[key]
            error = getattr(wanted, rest) - getattr(guided.angles, rest)
            if rest == "pan":
                error = math.remainder(error, 2 * math.pi)
            for _ in range(round(abs(error) / guided.step)):
                assert guided.press(key if error > 0 else other)
        guided.press("-")
    assert miss(TRUE, guided.angles, task.point) < 1e-3
    assert guided.press("\n")


def test_a_person_finds_the_head_with_arrow_keys():
    guided = GuidedCalibration(CORNERS, START, Limits())
    assert guided.progress == (0, 8)
    while guided.task is not None:
        person(guided)
    assert guided.progress == (8, 8)
    found = guided.result.geometry
    assert found.pose.position == pytest.approx(TRUE.pose.position, abs=0.003)
    assert max(miss(TRUE, found.solutions(target)[0], target) for target in CORNERS) < 1e-3


def test_after_four_directions_the_head_finds_the_next_by_itself():
    guided = GuidedCalibration(CORNERS, START, Limits())
    before = miss(TRUE, guided.angles, guided.task.point)
    for _ in range(4):
        person(guided)
    assert guided.task.is_flipped
    assert miss(TRUE, guided.angles, guided.task.point) < 0.2 * before


def test_confirmations_can_be_taken_back():
    guided = GuidedCalibration(CORNERS, START, Limits())
    person(guided)
    angles = guided.observations[0].angles
    guided.press("right")
    assert guided.press("u")
    assert guided.progress == (0, 8)
    assert guided.angles == angles
    assert not guided.press("u")
    assert not guided.press("x")


def test_a_proposal_lowers_the_expected_error():
    guided = GuidedCalibration(CORNERS, START, Limits())
    while guided.task is not None:
        person(guided)
    before = expected_errors(guided.result, TABLE).max() / guided.result.noise
    task = guided.add_proposal(TABLE)
    assert task == guided.task
    assert guided.progress == (8, 9)
    person(guided)
    assert expected_errors(guided.result, TABLE).max() / guided.result.noise < before


def test_a_flip_out_of_range_is_left_out():
    guided = GuidedCalibration(CORNERS, TRUE, Limits(tilt=(-0.2, 2.0)))
    while guided.task is not None:
        assert not guided.task.is_flipped
        guided.press("\n")
    assert len(guided.observations) == 4


def test_wrong_confirmations_are_reported():
    guided = GuidedCalibration(CORNERS, START, Limits())
    for number in range(8):
        guided.angles = Angles(0.1 * number**2, 0.3)
        guided.press("\n")
    assert guided.result is None
    assert "check the" in guided.problem or "check their order" in guided.problem


def test_a_session_is_resumed(tmp_path):
    guided = GuidedCalibration(CORNERS, START, Limits())
    for _ in range(5):
        person(guided)
    write_session(tmp_path / "s", "a", guided.observations)
    resumed = GuidedCalibration(CORNERS, START, Limits(), read_session(tmp_path / "s", "a"))
    assert resumed.observations == guided.observations
    assert (resumed.task, resumed.angles) == (guided.task, guided.angles)
    with pytest.raises(UserError, match="is a session of the head 'a', not of 'b'"):
        read_session(tmp_path / "s", "b")


def test_the_result_as_a_file(tmp_path):
    guided = GuidedCalibration(CORNERS, START, Limits())
    while guided.task is not None:
        person(guided)
    path = tmp_path / "calibration.yaml"
    write_calibration(path, "a", guided.result, guided.observations, 0.001)
    found = read_geometry(path)
    for one, other in zip(found.pose.orientation, guided.geometry.pose.orientation, strict=True):
        assert one == pytest.approx(other)
    assert found.pose.position == guided.geometry.pose.position
    assert (found.tilt_zero, found.beam_skew) == (guided.geometry.tilt_zero, guided.geometry.beam_skew)
    assert np.shape(guided.result.covariance) == (9, 9)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[]", "must be a mapping"),
        ("positon: []", "'positon' is unknown; did you mean 'position'"),
        ("position: [1, 2]", "'position' must be a list of 3 finite numbers"),
        ("position: [1, 2, .nan]", "'position' must be a list of 3 finite numbers"),
        ("position: [1, 2, 3]\norientation: [1, 1, 0, 0]", "must be a quaternion of length 1"),
        ("position: [1, 2, 3]\norientation: [1, 0, 0, 0]", "'tilt_zero' must be a finite number"),
    ],
)
def test_faults_of_a_result_are_named(tmp_path, text, words):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    with pytest.raises(UserError, match=words):
        read_geometry(path)


def test_points_of_a_file(tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text("- [0, 1, 2]\n- [3, 4, 5.5]\n")
    assert read_points(path) == [(0.0, 1.0, 2.0), (3.0, 4.0, 5.5)]
    path.write_text("- [0, 1]\n")
    with pytest.raises(UserError, match="'point 1' must be a list of 3"):
        read_points(path)
