"""Message classes: construction, checks, constants, comparison, copying; what a user of ROS 2's classes expects."""

from __future__ import annotations

import copy
import math
import pickle
from array import array
from collections import UserList, deque

import numpy as np
import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Point, PoseStamped, PoseWithCovariance, Vector3
from hypothesis import HealthCheck, given
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import Image, JointState, LaserScan
from std_msgs.msg import Bool, Byte, Header, Int8, String, UInt64
from test_msgs.msg import Arrays, BasicTypes, BoundedSequences, Constants, Defaults, Strings, UnboundedSequences

from daidalos.interfaces.codec import codec_of
from interfaces.messages import NAMES, PACKAGES, class_of, messages
from properties import examples


def names_of(package: str) -> list[str]:
    return [name for name in NAMES if name.split("/")[0] == package]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_class_has_the_members_of_rosidls(package):
    for name in names_of(package):
        kind = class_of(name)
        message = kind()
        fields = kind.get_fields_and_field_types()
        assert type(message).__slots__ == [f"_{field}" for field in fields]
        assert not hasattr(message, "__dict__")
        assert kind() == message
        assert len(kind.SLOT_TYPES) == len(fields)
        assert repr(message).startswith(f"{package}.{name.split('/')[1]}.{kind.__name__}(")
        for field in fields:
            setattr(message, field, getattr(message, field))
            assert f"{field}=" in repr(message)
            assert field in kind.__init__.__annotations__
        with pytest.raises(TypeError, match="unhashable"):
            hash(message)


@pytest.mark.parametrize("package", PACKAGES)
@examples(20, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(data=st.data())
def test_messages_are_equal_to_their_copies(package, data):
    kind = class_of(data.draw(st.sampled_from(names_of(package))))
    message = data.draw(messages(kind))
    for twin in (copy.copy(message), copy.deepcopy(message), pickle.loads(pickle.dumps(message))):
        assert twin == message
        assert type(twin) is kind


def test_fields_are_given_by_keyword_only():
    assert Point(x=1.0, z=2.0) == Point(z=2.0, x=1.0)
    with pytest.raises(TypeError, match="positional"):
        Point(1.0, 2.0, 3.0)
    with pytest.raises(AssertionError, match="constructor: w; Point has x, y, z"):
        Point(w=1.0)


def test_no_attribute_can_be_added():
    with pytest.raises(AttributeError, match="foo"):
        Point().foo = 1


@pytest.mark.parametrize(
    ("kind", "field", "value", "words"),
    [
        (Bool, "data", 1, "must be of type 'bool', not 'int'"),
        (String, "data", b"a", "must be of type 'str', not 'bytes'"),
        (String, "data", None, "must be of type 'str', not 'NoneType'"),
        (Int8, "data", 128, r"integer in \[-128, 127\], not 128"),
        (Int8, "data", 1.0, "must be of type 'int', not 'float'"),
        (UInt64, "data", -1, r"integer in \[0, 18446744073709551615\], not -1"),
        (Byte, "data", 1, "'bytes' with length 1, not 'int'"),
        (Byte, "data", b"ab", "'bytes' with length 1"),
        (Point, "x", 1, "must be of type 'float', not 'int': write 1.0"),
        (Point, "x", True, "must be of type 'float', not 'bool'"),
        (BasicTypes, "float32_value", 1e39, "range of float32, not 1e\\+39"),
        (Strings, "bounded_string_value", "x" * 23, "not longer than 22"),
        (PoseStamped, "pose", Point(), "sub message of type 'Pose', not 'Point'"),
        (LaserScan, "ranges", "1.0", "set or sequence, not 'str'"),
        (LaserScan, "ranges", 1.0, "set or sequence, not 'float'"),
        (LaserScan, "ranges", ["a"], "sequence of float32"),
        (LaserScan, "ranges", [1e39], "range of float32"),
        (JointState, "name", ["a", 1], "must be of type 'str', not 'int'"),
        (JointState, "name", {"a": 1}, "set or sequence, not 'dict'"),
        (Image, "data", [256], "sequence of uint8"),
        (PoseWithCovariance, "covariance", [0.0] * 35, "size of 36, not 35"),
        (PoseWithCovariance, "covariance", [1] * 36, "values of type 'float', not 'int'"),
        (PoseWithCovariance, "covariance", np.zeros(36, np.float32), "dtype of 'float64', not float32"),
        (BoundedSequences, "int32_values", [1, 2, 3, 4], "at most 3 values, not 4"),
        (Arrays, "string_values", ["a", "b"], "exactly 3 values, not 2"),
        (Arrays, "basic_types_values", [Point()] * 3, "sub message of type 'BasicTypes', not 'Point'"),
    ],
)
def test_wrong_values_are_named(kind, field, value, words):
    for attempt in (lambda: kind(**{field: value}), lambda: setattr(kind(), field, value)):
        with pytest.raises(AssertionError, match=words) as caught:
            attempt()
        assert f"'{field}'" in str(caught.value)


def test_numbers_are_kept_in_arrays_of_their_type():
    scan = LaserScan(ranges=[1.0, 2.0], intensities=np.array([3.0], np.float32))
    assert scan.ranges == array("f", [1.0, 2.0])
    assert scan.intensities == array("f", [3.0])
    for values in ((1.0, 2.0), {1.0, 2.0}, deque([1.0, 2.0]), UserList([1.0, 2.0]), np.array([1.0, 2.0])):
        scan.ranges = values
        assert scan.ranges.typecode == "f"
        assert sorted(scan.ranges) == [1.0, 2.0]
    image = Image(data=b"\1\2")
    assert image.data == array("B", [1, 2])
    image.data = np.array([[3, 4]], np.uint8).ravel()
    assert image.data == array("B", [3, 4])


def test_an_array_of_the_right_type_is_kept_not_copied():
    ranges = array("f", [1.0])
    scan = LaserScan(ranges=ranges)
    ranges.append(2.0)
    assert scan.ranges is ranges


def test_fixed_arrays_are_numpys():
    pose = PoseWithCovariance()
    assert pose.covariance.shape == (36,)
    assert pose.covariance.dtype == np.float64
    pose.covariance[7] = 0.5
    assert pose.covariance[7] == 0.5
    assert PoseWithCovariance().covariance[7] == 0.0
    assert pose != PoseWithCovariance()
    square = PoseWithCovariance(covariance=np.ones((6, 6)))
    assert square != PoseWithCovariance()
    assert codec_of(PoseWithCovariance).snapshot(square) == square


def test_lists_are_kept_so_that_what_is_appended_is_in_the_message():
    names = ["a"]
    state = JointState(name=names)
    names.append("b")
    assert state.name == ["a", "b"]


def test_defaults_are_those_of_the_definition():
    message = Defaults()
    assert (message.int8_value, message.uint64_value, message.bool_value) == (-50, 50000000, True)
    assert message.float32_value == 1.125
    assert UnboundedSequences().int32_values_default.tolist() == [0, 2147483647, -2147483648]
    assert Strings().string_value_default1 == "Hello world!"
    assert Strings.STRING_VALUE_DEFAULT1__DEFAULT == "Hello world!"
    first, second = UnboundedSequences(), UnboundedSequences()
    first.int32_values_default.append(1)
    assert len(second.int32_values_default) == 3


def test_constants_belong_to_class_and_object_and_stay():
    assert Constants.INT32_CONST == Constants().INT32_CONST == -30000
    assert Constants.BYTE_CONST == b"\x32"
    with pytest.raises(AttributeError, match=r"'Constants.INT32_CONST' is a constant"):
        Constants.INT32_CONST = 1
    with pytest.raises(AttributeError):
        Constants().INT32_CONST = 1
    with pytest.raises(AttributeError, match="is a constant"):
        Strings.STRING_VALUE_DEFAULT1__DEFAULT = "other"


def test_fields_and_types_are_spelt_as_in_idl():
    assert Header.get_fields_and_field_types() == {"stamp": "builtin_interfaces/Time", "frame_id": "string"}
    assert PoseWithCovariance.get_fields_and_field_types()["covariance"] == "double[36]"
    assert LaserScan.get_fields_and_field_types()["ranges"] == "sequence<float>"
    assert BoundedSequences.get_fields_and_field_types()["byte_values"] == "sequence<octet, 3>"
    assert Strings.get_fields_and_field_types()["bounded_string_value"] == "string<22>"
    Header.get_fields_and_field_types().clear()
    assert Header.get_fields_and_field_types()


def test_comparison_looks_at_class_and_every_field():
    assert Point(x=1.0) != Vector3(x=1.0)
    assert Point(x=1.0) != Point(x=1.5)
    assert Point() != "point"
    assert LaserScan(ranges=[1.0]) != LaserScan(ranges=[1.0, 2.0])


def test_a_message_shows_how_it_could_be_made():
    assert repr(Point(x=1.0)) == "geometry_msgs.msg.Point(x=1.0, y=0.0, z=0.0)"
    assert "ranges=[1.0, inf]" in repr(LaserScan(ranges=[1.0, math.inf]))


def test_services_and_actions_are_namespaces():
    assert AddTwoInts.Request(a=1).a == 1
    assert AddTwoInts.Event.get_fields_and_field_types()["request"].endswith("AddTwoInts_Request, 1>")
    assert Fibonacci.Impl.SendGoalService.Request(goal=Fibonacci.Goal(order=3)).goal.order == 3
    for kind in (AddTwoInts, Fibonacci):
        with pytest.raises(NotImplementedError, match="can not be instantiated"):
            kind()


def test_numbers_of_numpy_are_taken_where_a_float_is_one():
    assert Point(x=np.float64(1.5)).x == 1.5
    with pytest.raises(AssertionError, match="'float', not 'float32'"):
        Point(x=np.float32(1.5))


def test_bytes_are_taken_by_sequences_of_bytes():
    value = ParameterValue(byte_array_value=[b"\1", b"\2"])
    assert value.byte_array_value == [b"\1", b"\2"]
    with pytest.raises(AssertionError, match="'bytes' with length 1"):
        ParameterValue(byte_array_value=[1, 2])
