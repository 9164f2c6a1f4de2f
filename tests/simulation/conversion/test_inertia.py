import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.link import Inertial
from daidalos.simulation.conversion.inertia import principal_inertia

moment = st.floats(-0.1, 2)
product = st.floats(-0.5, 0.5)


def matrix_of(inertia):
    xx, xy, xz, yy, yz, zz = inertia
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@given(moment, moment, moment, product, product, product)
def test_what_comes_out_is_a_body(xx, yy, zz, xy, xz, yz):
    result = principal_inertia(Inertial(1.0, Pose(), (xx, xy, xz, yy, yz, zz)))
    a, b, c = np.sort(result.moments)
    assert a > 0
    assert a + b >= c * (1 - 1e-12)


def test_a_sound_inertia_is_kept():
    tensor = (0.4, 0.05, -0.02, 0.5, 0.03, 0.6)
    turn = Pose.from_xyz_rpy((1, 2, 3), (0.3, -0.4, 0.5))
    result = principal_inertia(Inertial(2.0, turn, tensor))
    assert result.changed == ""
    assert (result.mass, result.position) == (2.0, (1, 2, 3))
    axes = rotation_matrix(result.orientation)
    rotation = rotation_matrix(turn.orientation)
    expected = rotation @ matrix_of(tensor) @ rotation.T
    np.testing.assert_allclose(axes @ np.diag(result.moments) @ axes.T, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("tensor", "words"),
    [
        ((0, 0, 0, 0, 0, 0), "raised to at least"),
        ((-1, 0, 0, 1, 0, 1), "raised to at least"),
        ((1e-3, 0, 0, 1e-3, 0, 1), "no body has the moments"),
    ],
)
def test_repairs_are_told(tensor, words):
    assert words in principal_inertia(Inertial(1.0, Pose(), tensor)).changed
