"""Setting fields from dictionaries: whole messages as values, and classes that only look like messages."""

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Pose
from rosidl_runtime_py import set_message_fields
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory


class Stamped:
    """Looks like a message, but was not generated."""

    header = property(lambda self: self._header, lambda self, value: setattr(self, "_header", value))
    count = property(lambda self: self._count, lambda self, value: setattr(self, "_count", value))

    def __init__(self) -> None:
        self.header, self.count = Header(), 0

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        return {"header": "std_msgs/Header", "count": "int32"}


def test_a_message_may_be_a_value() -> None:
    pose = Pose()
    set_message_fields(pose, {"position": Point(x=1.0), "orientation": {"w": 0.5}})
    assert (pose.position, pose.orientation.w) == (Point(x=1.0), 0.5)


def test_what_looks_like_a_message_is_set_like_one() -> None:
    message = Stamped()
    stampers = set_message_fields(
        message, {"header": {"stamp": "now", "frame_id": "map"}, "count": "3"}, expand_time_now=True
    )
    for stamp in stampers:
        stamp(Time(sec=1))
    assert (message.header, message.count) == (Header(stamp=Time(sec=1), frame_id="map"), 3)
    with pytest.raises(TypeError, match=r"^Value 'auto' is expected to be a dictionary but is a str$"):
        set_message_fields(message, {"header": "auto"})


def test_yamls_sets_are_lists_as_gazebos_demonstrations_write_them() -> None:
    message = JointTrajectory()
    set_message_fields(message, {"joint_names": {"arm": None}, "points": [{"positions": {-1.57: None}}]})
    assert message.joint_names == ["arm"]
    assert list(message.points[0].positions) == [-1.57]
    with pytest.raises(TypeError, match=r"expected to be a list but is a dict"):
        set_message_fields(message, {"joint_names": {"arm": 1}})
