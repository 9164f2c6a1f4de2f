"""Messages to arrays and back."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import LaserScan

from daidalos.common.errors import UserError
from daidalos.nodes import conversions

FINITE = st.floats(-1e4, 1e4)
STAMP = Time(sec=7, nanosec=5)


@given(FINITE, FINITE, st.floats(-math.pi + 1e-9, math.pi))
def test_poses_come_back(x: float, y: float, yaw: float) -> None:
    pose = conversions.pose2_of(conversions.pose_message((x, y, yaw)))
    np.testing.assert_allclose(pose, [x, y, yaw], atol=1e-9)
    transform = conversions.transform_stamped((x, y, yaw), "map", "odom", STAMP)
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    np.testing.assert_allclose(conversions.pose2_of_transform(transform.transform), [x, y, yaw], atol=1e-9)


@given(st.floats(-3, 3), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_the_heading_is_that_of_the_first_of_yaw_pitch_roll(yaw: float, pitch: float, roll: float) -> None:
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat()
    quaternion = conversions.quaternion_message(0.0)
    quaternion.x, quaternion.y, quaternion.z, quaternion.w = x, y, z, w
    assert conversions.yaw_of(quaternion) == pytest.approx(yaw, abs=1e-9)


def test_paths_come_back() -> None:
    poses = np.array([[0.0, 1.0, 0.5], [2.0, -1.0, -3.0]])
    path = conversions.path_message(poses, "map", STAMP)
    assert path.header.frame_id == path.poses[1].header.frame_id == "map"
    np.testing.assert_allclose(conversions.path_array(path), poses, atol=1e-12)
    assert conversions.path_array(conversions.path_message(poses[:0], "map", STAMP)).shape == (0, 3)


def test_grids_come_back_row_by_row_from_the_origin() -> None:
    values = np.array([[-1, 0, 100], [7, 50, -1]], np.int8)
    grid = conversions.grid_message(values, 0.05, (1.5, -2.0), "map", STAMP)
    assert (grid.info.width, grid.info.height, grid.info.resolution) == (3, 2, pytest.approx(0.05))
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == (1.5, -2.0)
    assert list(grid.data) == [-1, 0, 100, 7, 50, -1]
    np.testing.assert_array_equal(conversions.grid_array(grid), values)


def test_velocities_are_stamped_where_a_frame_is_given() -> None:
    plain = conversions.twist_message((0.1, 0.2, 0.3), None, STAMP)
    assert (plain.linear.x, plain.linear.y, plain.angular.z) == (0.1, 0.2, 0.3)
    stamped = conversions.twist_message((0.1, 0.2, 0.3), "base_link", STAMP)
    assert (stamped.header.frame_id, stamped.header.stamp, stamped.twist) == ("base_link", STAMP, plain)


def test_a_scan_keeps_its_geometry() -> None:
    message = LaserScan(
        angle_min=-1.0, angle_increment=0.5, range_min=0.1, range_max=9.0, time_increment=0.25, ranges=[1.0, math.inf]
    )
    scan = conversions.scan_data(message, np.array([0.1, 0.2, 0.3]))
    assert (scan.angle_min, scan.angle_increment, scan.time_increment) == (-1.0, 0.5, 0.25)
    assert scan.sensor_pose == (0.1, 0.2, 0.3)
    np.testing.assert_array_equal(scan.ranges, np.array([1.0, math.inf], np.float32))


@pytest.mark.parametrize(
    ("name", "value"),
    [("width", 3), ("height", 4294967295), ("resolution", 0.0), ("resolution", -1.0), ("resolution", math.nan),
     ("resolution", math.inf)],
)  # fmt: skip
def test_a_grid_that_is_not_what_it_says_is_refused(name: str, value: float) -> None:
    message = conversions.grid_message(np.zeros((2, 2), np.int8), 0.5, (0.0, 0.0, 0.0), "map", Time())
    setattr(message.info, name, value)
    with pytest.raises(UserError, match="is not used"):
        conversions.grid_array(message)
    message = conversions.grid_message(np.zeros((2, 2), np.int8), 0.5, (math.nan, 0.0, 0.0), "map", Time())
    with pytest.raises(UserError, match="finite origin"):
        conversions.grid_array(message)
