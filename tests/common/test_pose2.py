import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from daidalos.common import pose2

poses = arrays(np.float64, 3, elements=st.floats(-50.0, 50.0))


def as_matrix(pose: np.ndarray) -> np.ndarray:
    x, y, yaw = pose
    return np.array([[np.cos(yaw), -np.sin(yaw), x], [np.sin(yaw), np.cos(yaw), y], [0.0, 0.0, 1.0]])


@given(poses, poses)
def test_compose_is_the_product_of_matrices(a: np.ndarray, b: np.ndarray) -> None:
    assert as_matrix(pose2.compose(a, b)) == pytest.approx(as_matrix(a) @ as_matrix(b), abs=1e-9)


@given(poses, poses)
def test_between_undoes_compose(a: np.ndarray, b: np.ndarray) -> None:
    assert as_matrix(pose2.compose(a, pose2.between(a, b))) == pytest.approx(as_matrix(b), abs=1e-9)
    assert as_matrix(pose2.inverse(a)) == pytest.approx(np.linalg.inv(as_matrix(a)), abs=1e-9)


@given(st.floats(-1e4, 1e4))
def test_wrap_keeps_the_direction_in_half_open_range(angle: float) -> None:
    wrapped = float(pose2.wrap(angle))
    assert -np.pi <= wrapped < np.pi
    assert np.cos(wrapped) == pytest.approx(np.cos(angle), abs=1e-9)
    assert np.sin(wrapped) == pytest.approx(np.sin(angle), abs=1e-9)


def test_leading_axes_broadcast() -> None:
    many = np.array([[1.0, 2.0, 0.5], [0.0, -1.0, 3.0]])
    one = np.array([0.5, 0.0, 0.1])
    assert pose2.compose(many, one) == pytest.approx(np.array([pose2.compose(pose, one) for pose in many]))


def test_transform_points_moves_and_turns() -> None:
    moved = pose2.transform_points((1.0, 2.0, np.pi / 2), np.array([[1.0, 0.0], [0.0, 1.0]]))
    assert moved == pytest.approx(np.array([[1.0, 3.0], [0.0, 2.0]]))


def test_interpolation_takes_the_shorter_arc() -> None:
    middle = pose2.interpolate([0.0, 0.0, 3.0], [2.0, 0.0, -3.0], 0.5)
    assert middle[:2] == pytest.approx([1.0, 0.0])
    assert abs(middle[2]) == pytest.approx(np.pi)


@pytest.mark.parametrize("pieces", [1, 7, 1000])
def test_arcs_close_whatever_the_step(pieces: int) -> None:
    """A quarter of a circle of radius 2: the chord is exact, not a polygon."""
    pose = np.array((1.0, 0.0, np.pi / 2))
    for _ in range(pieces):
        pose = pose2.move_along_arc(pose, 2 * np.pi / 2 / pieces, np.pi / 2 / pieces)
    assert pose == pytest.approx((-1, 2, np.pi))


def test_an_arc_without_a_turn_is_straight() -> None:
    assert pose2.move_along_arc((0, 0, np.pi / 2), 3, 0, 1) == pytest.approx((-1, 3, np.pi / 2))
