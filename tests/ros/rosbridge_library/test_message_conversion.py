"""Messages as JSON and back."""

import json
import math

import pytest
from geometry_msgs.msg import PoseStamped
from rosbridge_library.internal import message_conversion, ros_loader
from rosbridge_library.internal.message_conversion import extract_values, populate_instance
from sensor_msgs.msg import JointState, LaserScan, PointCloud2
from std_msgs.msg import ByteMultiArray, Float64, String


@pytest.mark.parametrize(
    "message",
    [
        String(data="x"),
        JointState(name=["a"], position=[1.5, -2.0]),
        PointCloud2(data=[1, 2, 255], width=3),
        LaserScan(ranges=[1.0, 2.0], angle_min=0.5),
        ByteMultiArray(data=[b"\x01", b"\xff"]),
    ],
    ids=lambda message: type(message).__name__,
)
def test_what_is_written_as_json_is_read_again(message):
    values = json.loads(json.dumps(extract_values(message)))
    values.pop("header", None)
    again = populate_instance(values, type(message)())
    if hasattr(message, "header"):
        again.header = message.header
    assert again == message


def test_bytes_are_base64_and_numbers_that_json_lacks_are_null():
    assert extract_values(PointCloud2(data=[1, 2, 255]))["data"] == "AQL/"
    assert extract_values(Float64(data=math.inf)) == {"data": None}


def test_headers_are_stamped():
    pose = populate_instance({"header": {"frame_id": "map"}, "pose": {"position": {"x": 1}}}, PoseStamped())
    assert (pose.header.frame_id, pose.pose.position.x) == ("map", 1.0)
    assert pose.header.stamp.sec > 0


def test_faults_are_named():
    with pytest.raises(message_conversion.NonexistentFieldException, match=r"does not have a field pose\.positon"):
        populate_instance({"pose": {"positon": {}}}, PoseStamped())
    with pytest.raises(message_conversion.FieldTypeMismatchException, match="requires a string for field data"):
        populate_instance({"data": 5}, String())
    with pytest.raises(message_conversion.InvalidMessageException):
        extract_values("text")
    with pytest.raises(ros_loader.InvalidTypeStringException):
        ros_loader.get_message_class("String")
    with pytest.raises(ros_loader.InvalidModuleException):
        ros_loader.get_service_class("nothing_msgs/Thing")
    with pytest.raises(ros_loader.InvalidClassException):
        ros_loader.get_action_class("test_msgs/Thing")


def test_classes_by_name():
    assert ros_loader.get_message_class("std_msgs/String") is ros_loader.get_message_class("std_msgs/msg/String")
    assert ros_loader.get_service_request_instance("std_srvs/srv/SetBool").data is False
    assert ros_loader.get_action_goal_instance("test_msgs/Fibonacci").order == 0
