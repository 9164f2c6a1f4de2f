import contextlib

import pytest
from geometry_msgs.msg import Twist
from hypothesis import given
from hypothesis import strategies as st
from ros2cli.interfaces import prototype
from std_msgs.msg import Header, Int8

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.interface.show import Comments, definition_lines, nested_type
from daidalos.cli.ros2.interfaces import fill, message_class, parse_values, service_class


def test_values_are_a_dictionary():
    assert parse_values("{linear: {x: 2.0}}") == {"linear": {"x": 2.0}}
    assert parse_values("data: Hello World") == {"data": "Hello World"}
    assert parse_values("") == {}
    with pytest.raises(CliError, match="needs to be a dictionary in YAML format"):
        parse_values("3")


def test_malformed_values_are_met_with_the_place():
    with pytest.raises(CliError, match="line 1, column 11: ") as fault:
        parse_values("{linear: [}")
    assert "\n" not in str(fault.value)
    with pytest.raises(CliError, match="line 2, column "):
        parse_values("a: 1\nb: [1, }")


@given(st.text(max_size=40))
def test_any_text_is_a_dictionary_or_refused(text):
    with contextlib.suppress(CliError):
        assert isinstance(parse_values(text), dict)


def test_fields_are_set():
    twist = Twist()
    assert fill(twist, {"linear": {"x": 2}, "angular": {"z": 1.8}}) == []
    assert (twist.linear.x, twist.angular.z) == (2.0, 1.8)


def test_times_to_come_are_set_when_sent():
    header = Header()
    (stamp,) = fill(header, {"stamp": "now", "frame_id": "map"})
    from builtin_interfaces.msg import Time

    stamp(Time(sec=7))
    assert header.stamp.sec == 7


@pytest.mark.parametrize(
    ("message", "values", "fault"),
    [
        (
            Twist(),
            {"linear": {"q": 1}},
            "Failed to populate field: 'Vector3' object has no attribute 'q'$",
        ),
        (Twist(), {"liner": {"x": 1}}, "no attribute 'liner'\nDid you mean 'linear'\\?$"),
        (Int8(), {"data": 300}, r"must be an integer in \[-128, 127\], not 300"),
        (Int8(), {"data": "three"}, "invalid literal for int"),
        (Twist(), {"linear": 3}, "expected to be a dictionary but is a int"),
    ],
)
def test_what_cannot_be_set_is_said(message, values, fault):
    with pytest.raises(CliError, match=fault):
        fill(message, values)


def test_types():
    assert message_class("std_msgs/msg/Header") is Header
    assert message_class("std_msgs/Header") is Header
    with pytest.raises(CliError, match=r"^The passed message type is invalid\nDid you mean 'std_msgs/msg/String'"):
        message_class("std_msgs/msg/Strng")
    with pytest.raises(CliError, match=r"^The passed service type is invalid$"):
        service_class("std_srvs/srv/Nope")
    with pytest.raises(CliError, match=r"(?s)^bad\nThe package 'my_msgs' is not here.*colcon build"):
        message_class("my_msgs/msg/Num", "bad")
    with pytest.raises(CliError, match=r"^The passed message type is invalid$"):
        message_class("nonsense")


def test_prototypes_are_one_line():
    assert prototype("geometry_msgs/msg/Vector3") == "{x: 0.0, y: 0.0, z: 0.0}"
    assert prototype("example_interfaces/srv/AddTwoInts") == "{a: 0, b: 0}"
    assert prototype("example_interfaces/action/Fibonacci") == "{order: 0}"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("float64 x", None),
        ("Vector3  linear", "geometry_msgs/msg/Vector3"),
        ("std_msgs/Header header", "std_msgs/msg/Header"),
        ("std_msgs/msg/Header[] headers", "std_msgs/msg/Header"),
        ("Point[<=3] points", "geometry_msgs/msg/Point"),
        ("Header header", "std_msgs/msg/Header"),
        ("string<=10 name", None),
        ("uint8[3] rgb 1 2 3", None),
        ("uint8 RED=1", None),
        ("byte A = 2", None),
        ("---", None),
        ("", None),
        ("# Point p", None),
    ],
)
def test_nested_types(line, expected):
    assert nested_type(line, "geometry_msgs") == expected


def test_comments_are_shown_as_asked():
    outer = list(definition_lines("geometry_msgs/msg/PointStamped", Comments.OUTER))
    every = list(definition_lines("geometry_msgs/msg/PointStamped", Comments.ALL))
    none = list(definition_lines("geometry_msgs/msg/PointStamped", Comments.NONE))
    assert any(line.startswith("#") for line in outer)
    assert not any(line.startswith("\t") and "#" in line for line in outer)
    assert any(line.startswith("\t") and "#" in line for line in every)
    assert none[:4] == [
        "std_msgs/Header header",
        "\tbuiltin_interfaces/Time stamp",
        "\t\tint32 sec",
        "\t\tuint32 nanosec",
    ]
    assert not any("#" in line or not line for line in none)
