"""Registering how things are transformed and converted, and using that."""

from dataclasses import dataclass, field

import pytest
import tf2_ros
from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header
from tf2_ros import (
    Buffer,
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)

from ros.transforms import SECOND, stamp, transform


@dataclass
class Thing:
    x: float = 0.0
    header: Header = field(default_factory=Header)


@dataclass
class OtherThing:
    x: float


@dataclass
class Message:
    x: float


def move(thing: Thing, by: TransformStamped) -> Thing:
    return Thing(thing.x + by.transform.translation.x, by.header)


@pytest.fixture
def buffer() -> Buffer:
    TransformRegistration().add(Thing, move)
    buffer = Buffer()
    for time in (1, 2):
        buffer.set_transform(transform("a", "b", time * SECOND, (10.0 * time, 0.0, 0.0)), "me")
    return buffer


def test_transform(buffer: Buffer) -> None:
    thing = Thing(1.0, Header(stamp=stamp(SECOND), frame_id="b"))
    found = buffer.transform(thing, "a", Duration(seconds=1))
    assert found.x == 11.0
    assert (found.header.frame_id, found.header.stamp) == ("a", stamp(SECOND))
    assert thing.x == 1.0


def test_transform_between_two_times(buffer: Buffer) -> None:
    thing = Thing(1.0, Header(stamp=stamp(SECOND), frame_id="b"))
    assert buffer.transform_full(thing, "b", Time(seconds=2), "a").x == -9.0


def test_transform_into_another_type(buffer: Buffer) -> None:
    ConvertRegistration().add_convert((Thing, OtherThing), lambda thing: OtherThing(2 * thing.x))
    thing = Thing(1.0, Header(stamp=stamp(SECOND), frame_id="b"))
    assert buffer.transform(thing, "a", new_type=OtherThing) == OtherThing(22.0)
    assert buffer.transform_full(thing, "b", Time(seconds=2), "a", new_type=OtherThing) == OtherThing(-18.0)


def test_types_that_nobody_registered(buffer: Buffer) -> None:
    with pytest.raises(TypeException, match="is not loaded or supported") as caught:
        buffer.transform(OtherThing(1.0), "a")
    assert caught.value.errstr == str(caught.value)
    register = ConvertRegistration()
    for get in (register.get_from_msg, register.get_to_msg, register.get_convert, TransformRegistration().get):
        with pytest.raises(TypeException):
            get(int)


def test_the_package_that_would_register_a_message_is_named() -> None:
    from sensor_msgs.msg import Illuminance

    with pytest.raises(TypeException, match="'import tf2_sensor_msgs'"):
        TransformRegistration().get(Illuminance)


def test_convert_by_way_of_a_message() -> None:
    register = ConvertRegistration()
    register.add_to_msg(OtherThing, lambda thing: Message(thing.x + 1))
    register.add_from_msg(float, lambda message: message.x)
    assert convert(OtherThing(1.0), float) == 2.0
    assert register.get_to_msg(OtherThing)(OtherThing(3.0)) == Message(4.0)
    with pytest.raises(TypeException):
        convert(OtherThing(1.0), str)


def test_convert_to_the_same_type_is_a_copy() -> None:
    thing = Thing(1.0)
    copy = convert(thing, Thing)
    assert copy == thing
    copy.header.frame_id = "changed"
    assert thing.header.frame_id == ""


def test_an_interface_that_implements_nothing() -> None:
    interface = BufferInterface()
    for call in (
        lambda: interface.lookup_transform("a", "b", Time()),
        lambda: interface.lookup_transform_full("a", Time(), "b", Time(), "c"),
        lambda: interface.can_transform("a", "b", Time()),
        lambda: interface.can_transform_full("a", Time(), "b", Time(), "c"),
    ):
        with pytest.raises(NotImplementedException) as caught:
            call()
        assert caught.value.errstr == "CanTransform or LookupTransform not implemented"


def test_stamped() -> None:
    thing = Thing(1.0)
    assert Stamped(thing, stamp(3), "f") is thing
    assert thing.header == Header(stamp=stamp(3), frame_id="f")


def test_print_me(buffer: Buffer, capsys: pytest.CaptureFixture[str]) -> None:
    buffer.registration.print_me()
    assert "Thing" in capsys.readouterr().out


def test_names() -> None:
    for name in tf2_ros.__all__:
        assert getattr(tf2_ros, name).__name__ == name if name.istitle() else hasattr(tf2_ros, name)
    with pytest.raises(AttributeError, match="no attribute 'Nothing'"):
        tf2_ros.Nothing  # noqa: B018
