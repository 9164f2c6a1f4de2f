"""Transformed messages against scipy, closed forms and the buffer that uses them."""

from copy import deepcopy
from itertools import starmap

import numpy as np
import pytest
import tf2_geometry_msgs
from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    PolygonStamped,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    QuaternionStamped,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    WrenchStamped,
)
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from rclpy.duration import Duration
from rclpy.time import Time
from scipy.spatial.transform import Rotation
from std_msgs.msg import Header
from tf2_ros import Buffer, convert

from ros.transforms import SECOND, matrix, matrix_of, quaternions, stamp, transform, vectors

transforms = st.builds(lambda xyz, xyzw: transform("a", "b", 7, xyz, xyzw), vectors, quaternions)
poses = st.builds(
    lambda xyz, xyzw: Pose(
        position=Point(x=xyz[0], y=xyz[1], z=xyz[2]),
        orientation=Quaternion(x=xyzw[0], y=xyzw[1], z=xyzw[2], w=xyzw[3]),
    ),
    vectors,
    quaternions,
)
OTHER = Header(stamp=stamp(3), frame_id="b")


def xyz(message: object) -> list[float]:
    return [message.x, message.y, message.z]


def pose_matrix(pose: Pose) -> np.ndarray:
    q = pose.orientation
    return matrix(xyz(pose.position), [q.x, q.y, q.z, q.w])


def half_turn() -> TransformStamped:
    """Half a turn about x, and a step along x."""
    return transform("a", "b", 2 * SECOND, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


# Against scipy


@given(transforms, vectors)
def test_points(by: TransformStamped, point: tuple[float, ...]) -> None:
    message = PointStamped(header=OTHER, point=Point(**dict(zip("xyz", point, strict=True))))
    found = tf2_geometry_msgs.do_transform_point(message, by)
    np.testing.assert_allclose(xyz(found.point), (matrix_of(by) @ [*point, 1.0])[:3], atol=1e-12)
    assert found.header == by.header


@given(transforms, vectors)
def test_vectors_are_turned_but_not_moved(by: TransformStamped, vector: tuple[float, ...]) -> None:
    before = deepcopy(by)
    message = Vector3Stamped(header=OTHER, vector=Vector3(**dict(zip("xyz", vector, strict=True))))
    found = tf2_geometry_msgs.do_transform_vector3(message, by)
    np.testing.assert_allclose(xyz(found.vector), matrix_of(by)[:3, :3] @ vector, atol=1e-12)
    assert np.linalg.norm(xyz(found.vector)) == pytest.approx(np.linalg.norm(vector))
    assert by == before


@given(transforms, poses)
def test_poses(by: TransformStamped, pose: Pose) -> None:
    expected = matrix_of(by) @ pose_matrix(pose)
    bare = tf2_geometry_msgs.do_transform_pose(pose, by)
    assert isinstance(bare, Pose)
    np.testing.assert_allclose(pose_matrix(bare), expected, atol=1e-9)
    stamped = PoseStamped(header=OTHER, pose=pose)
    for function in (tf2_geometry_msgs.do_transform_pose_stamped, tf2_geometry_msgs.do_transform_pose):
        found = function(stamped, by)
        assert found.pose == bare
        assert found.header == by.header
    many = tf2_geometry_msgs.do_transform_pose_array(PoseArray(header=OTHER, poses=[pose, pose]), by)
    assert many == PoseArray(header=by.header, poses=[bare, bare])


@given(transforms, quaternions)
def test_orientations(by: TransformStamped, xyzw: tuple[float, ...]) -> None:
    message = QuaternionStamped(header=OTHER, quaternion=Quaternion(**dict(zip("xyzw", xyzw, strict=True))))
    found = tf2_geometry_msgs.do_transform_quaternion(message, by).quaternion
    difference = Rotation.from_matrix(matrix_of(by)[:3, :3]) * Rotation.from_quat(xyzw)
    difference *= Rotation.from_quat([found.x, found.y, found.z, found.w]).inv()
    assert difference.magnitude() < 1e-7


@given(transforms, transforms)
def test_transforms(by: TransformStamped, inner: TransformStamped) -> None:
    inner.header.frame_id, inner.child_frame_id = "b", "c"
    found = tf2_geometry_msgs.do_transform_transform(inner, by)
    np.testing.assert_allclose(matrix_of(found), matrix_of(by) @ matrix_of(inner), atol=1e-9)
    assert (found.header, found.child_frame_id) == (by.header, "c")


@given(transforms, st.lists(st.tuples(*[st.floats(-10, 10, width=32)] * 3), max_size=4))
def test_polygons(by: TransformStamped, points: list[tuple[float, ...]]) -> None:
    message = PolygonStamped(header=OTHER)
    message.polygon.points = list(starmap(lambda x, y, z: Point32(x=x, y=y, z=z), points))
    found = tf2_geometry_msgs.do_transform_polygon_stamped(message, by)
    assert len(found.polygon.points) == len(points)
    for point, moved in zip(points, found.polygon.points, strict=True):
        np.testing.assert_allclose(xyz(moved), (matrix_of(by) @ [*point, 1.0])[:3], atol=1e-5)
    assert found.header == by.header


@given(transforms, vectors, vectors)
def test_wrenches(by: TransformStamped, force: tuple[float, ...], torque: tuple[float, ...]) -> None:
    message = WrenchStamped(header=OTHER)
    message.wrench.force = Vector3(**dict(zip("xyz", force, strict=True)))
    message.wrench.torque = Vector3(**dict(zip("xyz", torque, strict=True)))
    found = tf2_geometry_msgs.do_transform_wrench(message, by)
    np.testing.assert_allclose(xyz(found.wrench.force), matrix_of(by)[:3, :3] @ force, atol=1e-12)
    np.testing.assert_allclose(xyz(found.wrench.torque), matrix_of(by)[:3, :3] @ torque, atol=1e-12)


@given(transforms, hnp.arrays(np.float64, (6, 6), elements=st.floats(-3, 3)))
def test_covariances(by: TransformStamped, root: np.ndarray) -> None:
    covariance = root @ root.T
    rotation = np.kron(np.eye(2), matrix_of(by)[:3, :3])
    expected = rotation @ covariance @ rotation.T
    found = tf2_geometry_msgs.transform_covariance(covariance.ravel(), by)
    np.testing.assert_allclose(np.reshape(found, (6, 6)), expected, atol=1e-9)
    message = PoseWithCovarianceStamped(header=OTHER)
    message.pose.covariance = covariance.ravel()
    whole = tf2_geometry_msgs.do_transform_pose_with_covariance_stamped(message, by)
    np.testing.assert_allclose(np.reshape(whole.pose.covariance, (6, 6)), expected, atol=1e-9)
    assert whole.pose.pose == tf2_geometry_msgs.do_transform_pose(message.pose.pose, by)


# Closed forms


def test_half_a_turn_is_exact() -> None:
    message = PointStamped(point=Point(x=1.0, y=2.0, z=3.0))
    assert xyz(tf2_geometry_msgs.do_transform_point(message, half_turn()).point) == [2.0, -2.0, -3.0]
    pose = Pose(position=Point(x=1.0, y=2.0, z=3.0), orientation=Quaternion(x=1.0, w=0.0))
    moved = tf2_geometry_msgs.do_transform_pose(pose, half_turn())
    assert moved == Pose(position=Point(x=2.0, y=-2.0, z=-3.0), orientation=Quaternion(w=1.0))


def test_half_a_turn_about_z_exchanges_covariances() -> None:
    quarter = transform("a", "b", xyzw=(0.0, 0.0, 0.5**0.5, 0.5**0.5))
    covariance = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    covariance[0, 5] = covariance[5, 0] = 0.5
    expected = np.diag([2.0, 1.0, 3.0, 5.0, 4.0, 6.0])
    expected[1, 5] = expected[5, 1] = 0.5
    found = tf2_geometry_msgs.transform_covariance(covariance.ravel().tolist(), quarter)
    np.testing.assert_allclose(found.reshape(6, 6), expected, atol=1e-12)


def test_quaternions_of_any_length() -> None:
    double = transform("a", "b", xyzw=(2.0, 0.0, 0.0, 0.0))
    message = PointStamped(point=Point(x=1.0, y=2.0, z=3.0))
    assert xyz(tf2_geometry_msgs.do_transform_point(message, double).point) == [1.0, -2.0, -3.0]
    none = transform("a", "b", xyzw=(0.0, 0.0, 0.0, 0.0))
    assert xyz(tf2_geometry_msgs.do_transform_point(message, none).point) == [1.0, 2.0, 3.0]


def test_the_result_shares_nothing_with_the_transform() -> None:
    by = half_turn()
    found = tf2_geometry_msgs.do_transform_point(PointStamped(), by)
    found.header.frame_id, found.header.stamp.sec = "changed", 99
    assert by == half_turn()


# Through a buffer


@pytest.mark.parametrize(
    "kind",
    [
        PointStamped,
        Vector3Stamped,
        QuaternionStamped,
        PoseStamped,
        PoseArray,
        PoseWithCovarianceStamped,
        PolygonStamped,
        TransformStamped,
        WrenchStamped,
    ],
)
def test_buffers_transform_what_is_registered(kind: type) -> None:
    buffer = Buffer()
    buffer.set_transform(half_turn(), "me")
    message = kind(header=Header(stamp=stamp(2 * SECOND), frame_id="b"))
    for found in (
        buffer.transform(message, "a", Duration(seconds=1)),
        buffer.transform_full(message, "a", Time(seconds=2), "a", Duration(seconds=1)),
        buffer.transform(message, "a", new_type=kind),
    ):
        assert type(found) is kind
        assert found.header == Header(stamp=stamp(2 * SECOND), frame_id="a")
    assert convert(message, kind) == message
    assert tf2_geometry_msgs.to_msg_msg(message) is tf2_geometry_msgs.from_msg_msg(message) is message


def test_it_offers_the_messages_that_it_transforms() -> None:
    assert tf2_geometry_msgs.PoseStamped is PoseStamped
    assert tf2_geometry_msgs.PointStamped is PointStamped
    assert tf2_geometry_msgs.Vector3Stamped is Vector3Stamped
