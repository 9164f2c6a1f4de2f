"""What planners and controllers ask of paths."""

import math

import numpy as np
import pytest

from daidalos.navigation.paths import distances_along, path_length, with_headings

CORNER = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])


def test_each_pose_looks_at_the_next_and_the_last_as_it_arrives():
    path = with_headings(CORNER)
    assert np.allclose(path[:, 2], [0.0, math.pi / 2, math.pi / 2])
    assert np.array_equal(path[:, :2], CORNER)


def test_the_last_heading_can_be_given():
    assert with_headings(CORNER, final_heading=-1.0)[-1, 2] == -1.0


def test_a_path_of_one_pose_keeps_a_heading():
    assert with_headings(CORNER[:1], initial_heading=0.7)[0, 2] == 0.7


def test_lengths():
    path = with_headings(CORNER)
    assert distances_along(path).tolist() == [0.0, 1.0, 3.0]
    assert path_length(path) == pytest.approx(3.0)
    assert path_length(path[:1]) == 0.0
