"""Every pair of ROS types that share a type of gz is converted in both directions."""

import itertools

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseArray, TransformStamped, Twist, TwistStamped
from sensor_msgs.msg import LaserScan

from daidalos.nodes.ros_gz_bridge._conversions import find_converter, message_class
from daidalos.nodes.ros_gz_bridge._mapping import TYPES

STAMP = Time(sec=7)


def _pairs():
    for gz in sorted(set().union(*TYPES.values())):
        types = sorted(ros for ros, names in TYPES.items() if gz in names)
        yield from itertools.permutations(types, 2)


@pytest.mark.parametrize(("source", "target"), list(_pairs()))
def test_types_that_share_a_type_of_gz_are_converted(source, target):
    convert = find_converter(source, target, lambda: STAMP)
    assert convert is not None
    assert type(convert(message_class(source)())) is message_class(target)


def test_values_survive_and_a_missing_header_is_stamped():
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.5, -1.25
    stamped = find_converter("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped", lambda: STAMP)(twist)
    assert stamped.header.stamp == STAMP
    back = find_converter("geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist", lambda: STAMP)(stamped)
    assert back == twist
    pose = TransformStamped()
    pose.header.frame_id = "world"
    pose.transform.translation.y, pose.transform.rotation.z = 2.0, 1.0
    poses = PoseArray(header=pose.header)
    converted = find_converter("geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/PoseStamped", lambda: STAMP)(
        pose
    )
    assert converted.header == pose.header
    assert (converted.pose.position.y, converted.pose.orientation.z) == (2.0, 1.0)
    assert not poses.poses


def test_the_nearest_return_of_a_scan_is_its_range():
    scan = LaserScan(angle_min=-0.1, angle_max=0.1, range_min=0.1, range_max=4.0, ranges=[3.0, float("nan"), 2.0])
    found = find_converter("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range", lambda: STAMP)(scan)
    assert (found.range, found.max_range) == (2.0, 4.0)
    assert found.field_of_view == pytest.approx(0.2)


def test_types_without_a_common_type_of_gz_are_not_converted():
    assert find_converter("geometry_msgs/msg/Twist", "geometry_msgs/msg/Wrench", lambda: STAMP) is None
    assert TwistStamped is message_class("geometry_msgs/msg/TwistStamped")
