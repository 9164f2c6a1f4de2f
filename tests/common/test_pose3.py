import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from daidalos.common.pose3 import (
    Pose,
    quaternion_between,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    quaternion_from_rpy,
    quaternion_from_yaw,
    rotate,
    rotation_matrix,
    rotation_vector,
    slerp,
    yaw_from_quaternion,
)

angle = st.floats(-3.1, 3.1)
length = st.floats(-10, 10)
poses = st.builds(
    lambda x, y, z, r, p, w: Pose.from_xyz_rpy((x, y, z), (r, p, w)),
    length,
    length,
    length,
    angle,
    angle,
    angle,
)


@given(angle, angle, angle)
def test_rpy_is_scipys_extrinsic_xyz(roll, pitch, yaw):
    expected = Rotation.from_euler("xyz", (roll, pitch, yaw)).as_matrix()
    np.testing.assert_allclose(rotation_matrix(quaternion_from_rpy(roll, pitch, yaw)), expected, atol=1e-12)


@given(poses, poses)
def test_composition_is_that_of_matrices(a, b):
    np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-9)
    np.testing.assert_allclose(a.inverse.matrix, np.linalg.inv(a.matrix), atol=1e-9)


@given(poses)
def test_matrix_round_trip(pose):
    np.testing.assert_allclose(Pose.from_matrix(pose.matrix).matrix, pose.matrix, atol=1e-9)
    x, y, z = pose.position
    again = Pose.from_xyz_rpy((x, y, z), pose.rpy)
    np.testing.assert_allclose(again.matrix, pose.matrix, atol=1e-6)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1)])
def test_half_turns_convert_from_matrices(axis):
    turn = Rotation.from_rotvec(np.pi * np.array(axis))
    np.testing.assert_allclose(rotation_matrix(quaternion_from_matrix(turn.as_matrix())), turn.as_matrix(), atol=1e-9)


@pytest.mark.parametrize("end", [(1, 0, 0), (-1, 0, 0), (0, 0, -1), (0.6, 0.8, 0.0)])
def test_rotation_between_vectors(end):
    np.testing.assert_allclose(rotate(quaternion_between((1.0, 0, 0), end), (1.0, 0, 0)), end, atol=1e-9)


@given(st.tuples(*[st.floats(-1.7, 1.7)] * 3))
def test_rotation_vectors_are_scipys(vector):
    quaternion = quaternion_from_rotation_vector(vector)
    np.testing.assert_allclose(rotation_matrix(quaternion), Rotation.from_rotvec(vector).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(rotation_vector(quaternion), vector, atol=1e-12)
    np.testing.assert_allclose(rotation_vector(tuple(-part for part in quaternion)), vector, atol=1e-12)


@given(angle)
def test_yaw_is_that_of_rpy(yaw):
    assert quaternion_from_yaw(yaw) == quaternion_from_rpy(0.0, 0.0, yaw)
    assert yaw_from_quaternion(quaternion_from_yaw(yaw)) == pytest.approx(yaw)


@given(poses, poses, st.floats(0.0, 1.0))
def test_slerp_turns_evenly_along_the_shorter_arc(start, end, share):
    a, b = Rotation.from_quat(start.orientation), Rotation.from_quat(end.orientation)
    expected = a * Rotation.from_rotvec(share * (a.inv() * b).as_rotvec())
    actual = Rotation.from_quat(slerp(start.orientation, end.orientation, share))
    half_turn = np.linalg.norm((a.inv() * b).as_rotvec()) > np.pi - 1e-6  # both ways round are as short
    assert half_turn or (actual.inv() * expected).magnitude() < 1e-7
