"""Geometry of KDL, and its transforms; and packages that only say something."""

import importlib
import math

import numpy as np
import pytest
import tf2_kdl
import tf2_ros
from geometry_msgs.msg import PointStamped, TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from PyKDL import Equal, Frame, Rotation, Twist, Vector, Wrench, addDelta, diff, dot
from rpyutils import import_c_library
from scipy.spatial.transform import Rotation as Reference

angles = st.floats(-3.1, 3.1)
numbers = st.floats(-10.0, 10.0)
vectors = st.builds(Vector, numbers, numbers, numbers)
rotations = st.builds(Rotation.RPY, angles, angles, angles)
frames = st.builds(Frame, rotations, vectors)


def matrix(rotation):
    return np.array([[rotation[row, col] for col in range(3)] for row in range(3)])


@given(angles, angles, angles)
def test_rotations_are_those_of_scipy(roll, pitch, yaw):
    rotation = Rotation.RPY(roll, pitch, yaw)
    reference = Reference.from_euler("xyz", [roll, pitch, yaw])
    assert np.allclose(matrix(rotation), reference.as_matrix())
    assert np.allclose(matrix(Rotation.Quaternion(*reference.as_quat())), reference.as_matrix())
    assert np.allclose(Reference.from_quat(rotation.GetQuaternion()).as_matrix(), reference.as_matrix())
    assert Equal(Rotation.RPY(*rotation.GetRPY()), rotation)
    assert Equal(Rotation.EulerZYZ(*rotation.GetEulerZYZ()), rotation, 1e-5)
    angle, axis = rotation.GetRotAngle()
    assert Equal(Rotation.Rot(axis, angle), rotation, 1e-5)


@given(frames, frames, vectors, vectors)
def test_frames(one, other, vector, second):
    assert Equal(one * (other * vector), (one * other) * vector, 1e-6)
    assert Equal(one.Inverse() * (one * vector), vector, 1e-6)
    assert Equal(addDelta(one, diff(one, other)), other, 1e-5)
    twist, wrench = Twist(vector, second), Wrench(second, vector)
    power = dot(twist, wrench)
    assert dot(one * twist, one * wrench) == pytest.approx(power, rel=1e-6, abs=1e-6)
    assert dot(twist.RefPoint(vector), wrench.RefPoint(vector)) == pytest.approx(power, rel=1e-6, abs=1e-6)


def test_vectors():
    vector = Vector(3, 0, 4)
    assert (vector.Norm(), vector.x(), list(-vector), vector * 2 == Vector(6, 0, 8)) == (5.0, 3.0, [-3, 0, -4], True)
    assert vector.Normalize() == 5.0
    assert Vector(1, 0, 0) * Vector(0, 1, 0) == Vector(0, 0, 1)
    with pytest.raises(IndexError, match="from 0 to 2"):
        vector[3]
    assert Frame.DH(1.0, 0.0, 2.0, math.pi / 2).p[1] == pytest.approx(1.0)


def test_transforms_and_conversions():
    transform = TransformStamped(child_frame_id="b")
    transform.header.frame_id = "a"
    transform.transform.translation.x = 1.0
    transform.transform.rotation.x, transform.transform.rotation.w = 1.0, 0.0
    there = tf2_ros.TransformRegistration().get(Vector)(Vector(1, 2, 3), transform)
    assert (list(there), there.header.frame_id) == ([2.0, -2.0, -3.0], "a")
    assert list(tf2_kdl.do_transform_frame(Frame(Vector(1, 2, 3)), transform).p) == [2.0, -2.0, -3.0]
    message = PointStamped()
    message.point.y = 5.0
    assert list(tf2_kdl.from_msg_vector(message)) == [0.0, 5.0, 0.0]
    assert tf2_kdl.to_msg_vector(there).point.z == -3.0


def test_qt_is_answered_by_a_word():
    with pytest.raises(ImportError, match="there is no Qt here"):
        importlib.import_module("python_qt_binding.QtWidgets")


def test_a_compiled_module_is_imported():
    assert import_c_library("_socket").__name__ == "_socket"
    with pytest.raises(ImportError, match="nothing_here"):
        import_c_library("nothing_here")
