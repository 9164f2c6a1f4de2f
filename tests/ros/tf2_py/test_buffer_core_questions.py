"""What else a buffer of transforms is asked: between two times, for common times, as text, for velocities."""

import math

import pytest
import tf2_py
import yaml
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_py import BufferCore

from ros.transforms import (
    LATEST,
    SECOND,
    at,
    filled,
    stamp,
    transform,
    translation,
)

# Two times


def moving() -> BufferCore:
    """A car drives along x at 1 m/s and a ball beside it along y at 2 m/s."""
    buffer = BufferCore()
    for time in range(1, 6):
        buffer.set_transform(transform("world", "car", time * SECOND, (float(time), 0.0, 0.0)), "me")
        buffer.set_transform(transform("world", "ball", time * SECOND, (0.0, 2.0 * time, 0.0)), "me")
    return buffer


def test_from_one_time_to_another() -> None:
    found = moving().lookup_transform_full_core("car", at(4), "ball", at(2), "world")
    assert translation(found) == [-4.0, 4.0, 0.0]
    assert found.header.stamp == stamp(4 * SECOND)
    assert (found.header.frame_id, found.child_frame_id) == ("car", "ball")
    assert moving().can_transform_full_core("car", at(4), "ball", at(2), "world") == (True, "")


def test_a_frame_to_itself_at_another_time() -> None:
    assert translation(moving().lookup_transform_full_core("car", at(5), "car", at(2), "world")) == [-3.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("target", "source", "fixed", "argument"),
    [("no", "ball", "world", "target"), ("car", "no", "world", "source"), ("car", "ball", "no", "fixed")],
)
def test_unknown_frames_of_two_times(target: str, source: str, fixed: str, argument: str) -> None:
    with pytest.raises(tf2_py.LookupException, match=f'^"no" passed to lookupTransform argument {argument}_frame does'):
        moving().lookup_transform_full_core(target, at(4), source, at(2), fixed)
    possible, reason = moving().can_transform_full_core(target, at(4), source, at(2), fixed)
    assert not possible
    assert f"canTransform argument {argument}_frame - frame does not exist" in reason


def test_times_out_of_reach_of_two_times() -> None:
    with pytest.raises(tf2_py.ExtrapolationException, match="into the future"):
        moving().lookup_transform_full_core("car", at(9), "ball", at(2), "world")
    assert "into the past" in moving().can_transform_full_core("car", at(4), "ball", at(0.5), "world")[1]


# The newest common time


def test_the_latest_common_time() -> None:
    buffer = moving()
    buffer.set_transform(transform("world", "car", 7 * SECOND), "me")
    found = buffer.get_latest_common_time("car", "ball")
    assert found == Time(seconds=5)
    assert found.clock_type == ClockType.SYSTEM_TIME
    assert buffer.get_latest_common_time("world", "car") == Time(seconds=7)
    assert buffer.get_latest_common_time("car", "world") == Time(seconds=7)
    assert buffer.get_latest_common_time("car", "car") == Time(seconds=7)


def test_no_common_time() -> None:
    buffer = moving()
    with pytest.raises(tf2_py.LookupException, match=r'^"no" passed to get_latest_common_time does not exist\. $'):
        buffer.get_latest_common_time("car", "no")
    buffer.set_transform(transform("mars", "rover", SECOND), "me")
    with pytest.raises(tf2_py.TransformException, match="Could not find a connection between 'car' and 'rover'"):
        buffer.get_latest_common_time("car", "rover")


# The tree as text


def test_the_tree_as_yaml() -> None:
    buffer = BufferCore()
    assert buffer.all_frames_as_yaml() == "[]"
    for tenth in range(21):
        buffer.set_transform(transform("map", "base", SECOND + tenth * SECOND // 10), "odometry")
    buffer.set_transform_static(transform("base", "laser"), "description")
    assert yaml.safe_load(buffer.all_frames_as_yaml()) == {
        "base": {
            "parent": "map",
            "broadcaster": "odometry",
            "rate": 10.5,
            "most_recent_transform": 3.0,
            "oldest_transform": 1.0,
            "buffer_length": 2.0,
        },
        "laser": {
            "parent": "base",
            "broadcaster": "description",
            "rate": 10000.0,
            "most_recent_transform": 0.0,
            "oldest_transform": 0.0,
            "buffer_length": 0.0,
        },
    }


def test_the_tree_as_sentences() -> None:
    buffer = BufferCore()
    assert buffer.all_frames_as_string() == ""
    buffer.set_transform(transform("map", "base", 1), "me")
    buffer.set_transform(transform("base", "laser", 1), "me")
    assert buffer.all_frames_as_string() == (
        "Frame base exists with parent map.\nFrame laser exists with parent base.\n"
    )


def test_the_tree_as_a_drawing() -> None:
    buffer = BufferCore()
    assert buffer._allFramesAsDot() == 'digraph G {\n"no tf data received"\n}'
    buffer.set_transform(transform("map", "base", SECOND), "me")
    drawing = buffer._allFramesAsDot(at(3))
    assert '"map" -> "base"[label="Broadcaster: me\\nAverage rate: 10000.000 Hz' in drawing
    assert "2.000 sec old" in drawing
    assert drawing.count("{") == drawing.count("}")


def test_names_of_frames() -> None:
    buffer = filled()
    assert buffer._getFrameStrings() == ["b", "a", "once", "y", "x"]
    assert buffer._frameExists("a")
    assert not buffer._frameExists("no")
    assert buffer._chain("a", LATEST, "once", LATEST, "a") == ["once", "b", "a"]


# Velocities


def test_the_velocity_of_something_that_drives_straight() -> None:
    linear, angular = moving().lookupVelocityCore("car", "ball", at(3), Duration(seconds=1))
    assert linear == pytest.approx((1.0, -2.0, 0.0))
    assert angular == pytest.approx((0.0, 0.0, 0.0))


def test_the_velocity_of_something_that_turns() -> None:
    buffer = BufferCore()
    rate = 0.4
    for step in range(101):
        half = rate * step * 0.01 / 2
        buffer.set_transform(
            transform("world", "disc", SECOND + step * 10_000_000, xyzw=(0.0, 0.0, math.sin(half), math.cos(half))),
            "me",
        )
    buffer.set_transform_static(transform("disc", "rim", xyz=(2.0, 0.0, 0.0)), "me")
    linear, angular = buffer.lookupVelocityCore("rim", "world", at(1.5), Duration(seconds=0.02))
    assert angular == pytest.approx((0.0, 0.0, rate), abs=1e-9)
    heading = rate * 0.5
    expected = (-2.0 * rate * math.sin(heading), 2.0 * rate * math.cos(heading), 0.0)
    assert linear == pytest.approx(expected, abs=1e-5)
    by_point = buffer.lookupVelocityFullCore(
        "disc", "world", "world", (2.0, 0.0, 0.0), "disc", at(1.5), Duration(seconds=0.02)
    )
    assert by_point[0] == pytest.approx(expected, abs=1e-5)
    assert by_point[1] == pytest.approx(angular, abs=1e-9)
