"""The buffer of transforms against scipy, closed forms and the words that programs print."""

import math
import re
import threading

import numpy as np
import pytest
import tf2_py
import yaml
from geometry_msgs.msg import Quaternion
from hypothesis import given
from hypothesis import strategies as st
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.time import Time
from scipy.spatial.transform import Rotation, Slerp
from tf2_py import BufferCore

from ros.transforms import (
    SECOND,
    matrix,
    matrix_of,
    quaternion,
    quaternions,
    stamp,
    transform,
    translation,
    vectors,
)

LATEST = Time()


def at(seconds: float) -> Time:
    return Time(nanoseconds=round(seconds * SECOND))


def quarter_turn() -> tuple[float, float, float, float]:
    return (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))


# What a transform means


def test_a_transform_takes_coordinates_of_the_child_to_the_parent() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("map", "base", SECOND, (1.0, 2.0, 3.0), quarter_turn()), "me")
    found = buffer.lookup_transform_core("map", "base", at(1))
    assert found.header.frame_id == "map"
    assert found.child_frame_id == "base"
    assert found.header.stamp == stamp(SECOND)
    np.testing.assert_allclose(matrix_of(found) @ [1.0, 0.0, 0.0, 1.0], [1.0, 3.0, 3.0, 1.0], atol=1e-15)


def test_the_other_way_round_is_the_inverse() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("map", "base", SECOND, (1.0, 2.0, 3.0), quarter_turn()), "me")
    there = matrix_of(buffer.lookup_transform_core("map", "base", at(1)))
    back = matrix_of(buffer.lookup_transform_core("base", "map", at(1)))
    np.testing.assert_allclose(there @ back, np.eye(4), atol=1e-15)


def test_values_that_need_no_arithmetic_come_back_unchanged() -> None:
    buffer = BufferCore()
    sent = transform("a", "b", 7, (0.1, 0.2, 0.3), (0.6, 0.0, 0.0, 0.8))
    buffer.set_transform(sent, "me")
    assert buffer.lookup_transform_core("a", "b", LATEST) == sent


poses = st.tuples(vectors, quaternions)


@st.composite
def trees(draw: st.DrawFn) -> list[tuple[int, list[tuple[int, tuple[tuple[float, ...], tuple[float, ...]]]]]]:
    """Frames 1, 2, ...: the number of the parent, and poses at times; an empty time means static."""
    frames = []
    for number in range(1, draw(st.integers(2, 7))):
        parent = draw(st.integers(0, number - 1))
        times = draw(st.one_of(st.just([]), st.lists(st.integers(1, 40), min_size=2, max_size=5, unique=True)))
        frames.append((parent, [(time, draw(poses)) for time in sorted(times)] or [(0, draw(poses))]))
    return frames


def pose_at(history: list, time: float) -> np.ndarray:
    """A frame's pose in its parent, by scipy."""
    if len(history) == 1:
        return matrix(*history[0][1])
    times = [entry[0] for entry in history]
    result = np.eye(4)
    result[:3, :3] = Slerp(times, Rotation.from_quat([entry[1][1] for entry in history]))(time).as_matrix()
    for axis in range(3):
        result[axis, 3] = np.interp(time, times, [entry[1][0][axis] for entry in history])
    return result


@given(trees(), st.data())
def test_any_two_frames_of_any_tree_as_scipy_has_them(tree: list, data: st.DataObject) -> None:
    buffer = BufferCore()
    for number, (parent, history) in enumerate(tree, 1):
        for time, (xyz, xyzw) in history:
            message = transform(f"f{parent}", f"f{number}", time * 100_000_000, xyz, xyzw)
            (buffer.set_transform_static if time == 0 else buffer.set_transform)(message, "me")
    moving = [history for _, history in tree if len(history) > 1]
    first = max((history[0][0] for history in moving), default=1)
    last = min((history[-1][0] for history in moving), default=2)
    if first > last:
        return
    time = data.draw(st.integers(first * 100_000_000, last * 100_000_000))

    def to_root(number: int) -> np.ndarray:
        result = np.eye(4)
        while number:
            number, history = tree[number - 1]
            result = pose_at(history, time / 1e8) @ result
        return result

    source, target = data.draw(st.integers(0, len(tree))), data.draw(st.integers(0, len(tree)))
    found = buffer.lookup_transform_core(f"f{target}", f"f{source}", Time(nanoseconds=time))
    expected = np.linalg.inv(to_root(target)) @ to_root(source)
    np.testing.assert_allclose(matrix_of(found), expected, atol=1e-6)
    assert found.header.stamp == stamp(time)


@given(quaternions, quaternions, st.floats(0.0, 1.0))
def test_rotations_are_interpolated_on_the_shorter_arc_at_constant_speed(
    one: tuple[float, ...], two: tuple[float, ...], ratio: float
) -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", SECOND, xyzw=one), "me")
    buffer.set_transform(transform("a", "b", 2 * SECOND, xyzw=two), "me")
    found = quaternion(buffer.lookup_transform_core("a", "b", at(1 + ratio)))
    start, end, middle = map(Rotation.from_quat, (one, two, found))
    whole = (start.inv() * end).magnitude()
    if whole < math.pi - 1e-6:  # there the shorter arc is ambiguous
        assert (start.inv() * middle).magnitude() == pytest.approx(ratio * whole, abs=1e-7)
        assert (middle.inv() * end).magnitude() == pytest.approx((1 - ratio) * whole, abs=1e-7)
    assert math.hypot(*found) == pytest.approx(1.0, abs=1e-12)


def test_tiny_rotations_are_interpolated_without_loss() -> None:
    buffer = BufferCore()
    angle = 1e-9
    buffer.set_transform(transform("a", "b", SECOND), "me")
    buffer.set_transform(transform("a", "b", 2 * SECOND, xyzw=(0.0, 0.0, angle, 1.0)), "me")
    assert quaternion(buffer.lookup_transform_core("a", "b", at(1.25)))[2] == pytest.approx(angle / 4, rel=1e-9)


@given(quaternions)
def test_of_the_two_quaternions_of_a_rotation_always_the_same_is_reported(xyzw: tuple[float, ...]) -> None:
    found = []
    for sign in (1.0, -1.0):
        buffer = BufferCore()
        buffer.set_transform(transform("a", "b", 1, xyzw=[sign * part for part in xyzw]), "me")
        found.append(quaternion(buffer.lookup_transform_core("a", "b", LATEST)))
    assert found[0] == found[1]
    x, y, z, w = found[0]
    assert w > 0.5 or max((x, y, z), key=abs) >= 0.0 or w == 0.5


def test_a_quaternion_slightly_off_is_normalised() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", 1, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.004)), "me")
    buffer.set_transform(transform("b", "c", 1, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.004)), "me")
    found = buffer.lookup_transform_core("a", "c", LATEST)
    assert translation(found) == [2.0, 0.0, 0.0]
    assert quaternion(found) == [0.0, 0.0, 0.0, 1.0]


# Time


def test_time_zero_means_the_newest_common_time() -> None:
    buffer = BufferCore()
    for time in (1, 2, 3):
        buffer.set_transform(transform("a", "b", time * SECOND, (float(time), 0.0, 0.0)), "me")
    for time in (1, 2):
        buffer.set_transform(transform("a", "c", time * SECOND, (0.0, float(time), 0.0)), "me")
    found = buffer.lookup_transform_core("b", "c", LATEST)
    assert found.header.stamp == stamp(2 * SECOND)
    assert translation(found) == [-2.0, 2.0, 0.0]


def test_time_zero_of_static_frames_is_zero() -> None:
    buffer = BufferCore()
    buffer.set_transform_static(transform("a", "b", 5 * SECOND, (1.0, 0.0, 0.0)), "me")
    assert buffer.lookup_transform_core("a", "b", LATEST).header.stamp == stamp(0)
    assert buffer.lookup_transform_core("a", "b", at(99)).header.stamp == stamp(99 * SECOND)


def test_a_frame_in_itself_is_identity_at_any_time_even_when_unknown() -> None:
    buffer = BufferCore()
    found = buffer.lookup_transform_core("nowhere", "nowhere", at(3))
    assert found == transform("nowhere", "nowhere", 3 * SECOND)
    buffer.set_transform(transform("a", "b", 4 * SECOND), "me")
    assert buffer.lookup_transform_core("b", "b", LATEST).header.stamp == stamp(4 * SECOND)
    assert buffer.lookup_transform_core("a", "a", LATEST).header.stamp == stamp(0)


@given(st.permutations(range(1, 9)))
def test_the_order_of_arrival_does_not_matter(order: list[int]) -> None:
    buffer = BufferCore()
    for time in order:
        buffer.set_transform(transform("a", "b", time * SECOND, (float(time**2), 0.0, 0.0)), "me")
    for time in range(1, 8):
        middle = translation(buffer.lookup_transform_core("a", "b", at(time + 0.5)))[0]
        assert middle == pytest.approx((time**2 + (time + 1) ** 2) / 2)
    assert translation(buffer.lookup_transform_core("a", "b", LATEST))[0] == 64.0


def test_the_same_data_twice_is_kept_once() -> None:
    buffer = BufferCore()
    for _ in range(5):
        buffer.set_transform(transform("a", "b", SECOND, (1.0, 0.0, 0.0)), "me")
    with pytest.raises(tf2_py.ExtrapolationException, match=r"at time 2\.0+, but only time 1\.0+ is"):
        buffer.lookup_transform_core("a", "b", at(2))
    assert yaml.safe_load(buffer.all_frames_as_yaml())["b"]["rate"] == 10000.0


def test_a_correction_of_the_same_time_outweighs_what_was_there() -> None:
    buffer = BufferCore()
    for time, x in ((1, 1.0), (2, 2.0), (2, 20.0), (3, 3.0)):
        buffer.set_transform(transform("a", "b", time * SECOND, (x, 0.0, 0.0)), "me")
    assert translation(buffer.lookup_transform_core("a", "b", at(2)))[0] == 20.0
    assert translation(buffer.lookup_transform_core("a", "b", at(2.5)))[0] == 11.5
    assert translation(buffer.lookup_transform_core("a", "b", at(1.5)))[0] == 1.5


def test_a_change_of_parent_is_not_interpolated() -> None:
    buffer = BufferCore()
    buffer.set_transform_static(transform("root", "p1"), "me")
    buffer.set_transform_static(transform("root", "p2", xyz=(0.0, 9.0, 0.0)), "me")
    buffer.set_transform(transform("p1", "b", SECOND, (1.0, 0.0, 0.0)), "me")
    buffer.set_transform(transform("p2", "b", 2 * SECOND, (2.0, 0.0, 0.0)), "me")
    assert translation(buffer.lookup_transform_core("root", "b", at(1.9))) == [1.0, 0.0, 0.0]
    assert translation(buffer.lookup_transform_core("root", "b", at(2))) == [2.0, 9.0, 0.0]


def test_ten_seconds_are_remembered_by_default() -> None:
    buffer = BufferCore()
    for time in range(1, 30):
        buffer.set_transform(transform("a", "b", time * SECOND), "me")
    assert not buffer.can_transform_core("a", "b", at(17))[0]
    assert buffer.can_transform_core("a", "b", at(19))[0]
    assert buffer.get_cache_time() == Duration(seconds=10)


@pytest.mark.parametrize("length", [Duration(seconds=2), Duration(seconds=2).to_msg()])
def test_or_as_long_as_was_asked_for(length: object) -> None:
    buffer = BufferCore(length)
    for time in range(1, 30):
        buffer.set_transform(transform("a", "b", time * SECOND), "me")
    assert not buffer.can_transform_core("a", "b", at(25))[0]
    assert buffer.can_transform_core("a", "b", at(27))[0]


def test_what_is_older_than_that_is_refused_with_a_warning(capfd: pytest.CaptureFixture[str]) -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", 30 * SECOND), "me")
    buffer.set_transform(transform("a", "b", 19 * SECOND), "somebody")
    assert "TF_OLD_DATA" in (shown := capfd.readouterr().err)
    assert "frame b at time 19.000000 according to authority somebody" in shown
    assert not buffer.can_transform_core("a", "b", at(19))[0]


def test_a_time_may_be_a_message() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", SECOND), "me")
    assert buffer.can_transform_core("a", "b", stamp(SECOND)) == (True, "")
    assert buffer.lookup_transform_core("a", "b", stamp(SECOND)).header.stamp == stamp(SECOND)


@pytest.mark.parametrize("time", [None, 1.0, "now"])
def test_but_nothing_else(time: object) -> None:
    with pytest.raises(TypeError, match="time must have sec and nanosec, or nanoseconds"):
        BufferCore().can_transform_core("a", "b", time)
    with pytest.raises(TypeError, match="duration must have"):
        BufferCore(time or 3.0)


# What goes wrong, in the words that programs match


def filled() -> BufferCore:
    buffer = BufferCore()
    for time in (1, 2):
        buffer.set_transform(transform("a", "b", time * SECOND), "me")
    buffer.set_transform(transform("b", "once", SECOND), "me")
    buffer.set_transform_static(transform("x", "y"), "me")
    return buffer


@pytest.mark.parametrize(
    ("target", "source", "time", "kind", "words"),
    [
        ("no", "b", 1, tf2_py.LookupException, '"no" passed to lookupTransform argument target_frame does not exist. '),
        ("a", "no", 1, tf2_py.LookupException, '"no" passed to lookupTransform argument source_frame does not exist. '),
        (
            "",
            "b",
            1,
            tf2_py.InvalidArgumentException,
            'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            "a",
            "/b",
            1,
            tf2_py.InvalidArgumentException,
            'Invalid argument "/b" passed to lookupTransform argument source_frame - '
            "in tf2 frame_ids cannot start with a '/'",
        ),
        (
            "a",
            "y",
            1,
            tf2_py.ConnectivityException,
            "Could not find a connection between 'a' and 'y' because they are not part of the same tree."
            "Tf has two or more unconnected trees.",
        ),
        (
            "a",
            "b",
            3,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation into the future.  Requested time 3.000000 but the latest data is at "
            "time 2.000000, when looking up transform from frame [b] to frame [a]",
        ),
        (
            "b",
            "a",
            0.5,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation into the past.  Requested time 0.500000 but the earliest data is at "
            "time 1.000000, when looking up transform from frame [a] to frame [b]",
        ),
        (
            "a",
            "once",
            3,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation at time 3.000000, but only time 1.000000 is in the buffer, when "
            "looking up transform from frame [once] to frame [a]",
        ),
    ],
)
def test_why_there_is_no_transform(target: str, source: str, time: float, kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=f"^{re.escape(words)}$") as caught:
        filled().lookup_transform_core(target, source, at(time))
    assert isinstance(caught.value, tf2_py.TransformException)
    possible, reason = filled().can_transform_core(target, source, at(time))
    assert possible is False
    if kind in (tf2_py.ConnectivityException, tf2_py.ExtrapolationException):
        assert reason == words


@pytest.mark.parametrize(
    ("target", "source", "reason"),
    [
        ("no", "b", 'Invalid frame ID "no" passed to canTransform argument target_frame - frame does not exist'),
        ("a", "no", 'Invalid frame ID "no" passed to canTransform argument source_frame - frame does not exist'),
        (
            "",
            "b",
            'Invalid frame ID "" passed to canTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            "/a",
            "b",
            'Invalid frame ID "/a" passed to canTransform argument target_frame - '
            "in tf2 frame_ids cannot start with a '/'",
        ),
    ],
)
def test_why_frames_cannot_be_looked_up(target: str, source: str, reason: str) -> None:
    assert filled().can_transform_core(target, source, at(1)) == (False, reason)


def test_frames_that_are_no_strings_are_type_errors() -> None:
    with pytest.raises(TypeError, match="must be a str, not int"):
        filled().lookup_transform_core(1, "a", LATEST)


def test_a_loop_is_an_error_and_not_a_hang() -> None:
    buffer = BufferCore()
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a"), ("x", "y")):
        buffer.set_transform(transform(parent, child, SECOND), "me")
    for time in (LATEST, at(1)):
        for target, source in (("x", "a"), ("a", "x"), ("x", "b")):
            with pytest.raises(tf2_py.TransformException, match="contains a loop"):
                buffer.lookup_transform_core(target, source, time)
        assert buffer.can_transform_core("a", "c", time) == (True, "")


def test_an_ancestor_without_data_does_not_matter() -> None:
    buffer = BufferCore()
    for time in (1, 2, 3):
        buffer.set_transform(transform("base", "left", time * SECOND), "me")
        buffer.set_transform(transform("base", "right", time * SECOND), "me")
    buffer.set_transform(transform("map", "base", SECOND), "me")
    assert buffer.can_transform_core("left", "right", at(2.5)) == (True, "")
    assert buffer.can_transform_core("base", "right", at(2.5)) == (True, "")
    assert buffer.can_transform_core("map", "right", at(2.5))[0] is False


# What is refused


def test_slashes_before_names_are_dropped() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("/a", "/b", SECOND), "me")
    assert buffer.can_transform_core("a", "b", at(1)) == (True, "")


@pytest.mark.parametrize(
    ("message", "word"),
    [
        (transform("a", "a", 1), "TF_SELF_TRANSFORM"),
        (transform("/a", "a", 1), "TF_SELF_TRANSFORM"),
        (transform("", "b", 1), "TF_NO_FRAME_ID"),
        (transform("a", "", 1), "TF_NO_CHILD_FRAME_ID"),
        (transform("a", "/", 1), "TF_NO_CHILD_FRAME_ID"),
        (transform("a", "b", 1, (math.nan, 0.0, 0.0)), "TF_NAN_INPUT"),
        (transform("a", "b", 1, xyzw=(0.0, math.nan, 0.0, 1.0)), "TF_NAN_INPUT"),
        (transform("a", "b", 1, xyzw=(0.0, 0.0, 0.0, 0.0)), "TF_DENORMALIZED_QUATERNION"),
        (transform("a", "b", 1, xyzw=(0.0, 0.0, 0.0, 1.1)), "TF_DENORMALIZED_QUATERNION"),
    ],
)
@pytest.mark.parametrize("method", ["set_transform", "set_transform_static"])
def test_nonsense_is_ignored_with_an_error(
    message: object, word: str, method: str, capfd: pytest.CaptureFixture[str]
) -> None:
    buffer = BufferCore()
    getattr(buffer, method)(message, "somebody")
    shown = capfd.readouterr().err
    assert f"{word}: Ignoring transform" in shown
    assert '"somebody"' in shown
    assert buffer.all_frames_as_yaml() == "[]"


def test_infinite_coordinates_are_no_nonsense() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", 1, (math.inf, -math.inf, 0.0)), "me")
    assert buffer.can_transform_core("a", "b", LATEST) == (True, "")


def test_whatever_looks_like_the_message_will_do() -> None:
    class Looks:
        pass

    real = transform("a", "b", SECOND, (1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8))
    alike = Looks()
    for name in ("header", "child_frame_id", "transform"):
        setattr(alike, name, getattr(real, name))
    buffer = BufferCore()
    buffer.set_transform(alike, "me")
    assert buffer.lookup_transform_core("a", "b", LATEST) == real
    alike.transform = Looks()
    alike.transform.translation, alike.transform.rotation = Quaternion(), real.transform.translation
    with pytest.raises(TypeError, match="must have x, y, z"):
        buffer.set_transform(alike, "me")


# Static transforms and clearing


def test_static_transforms_outlive_clearing_and_others_do_not() -> None:
    buffer = BufferCore()
    buffer.set_transform_static(transform("a", "b", xyz=(1.0, 0.0, 0.0)), "me")
    buffer.set_transform(transform("b", "c", SECOND), "me")
    buffer.clear()
    assert buffer.can_transform_core("a", "b", at(5)) == (True, "")
    assert buffer.can_transform_core("b", "c", LATEST)[0] is False
    assert buffer.can_transform_core("b", "c", at(1))[0] is False
    buffer.set_transform(transform("b", "c", SECOND), "me")
    assert buffer.can_transform_core("a", "c", at(1)) == (True, "")


def test_after_clearing_earlier_times_are_welcome() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", 100 * SECOND), "me")
    buffer.clear()
    buffer.set_transform(transform("a", "b", SECOND), "me")
    assert buffer.can_transform_core("a", "b", at(1)) == (True, "")


def test_the_last_static_transform_counts() -> None:
    buffer = BufferCore()
    buffer.set_transform_static(transform("a", "b", xyz=(1.0, 0.0, 0.0)), "me")
    buffer.set_transform_static(transform("a", "b", xyz=(2.0, 0.0, 0.0)), "me")
    assert translation(buffer.lookup_transform_core("a", "b", at(7))) == [2.0, 0.0, 0.0]


def test_a_frame_may_become_static_and_movable_again() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", SECOND), "me")
    buffer.set_transform_static(transform("a", "b"), "me")
    assert buffer.can_transform_core("a", "b", at(7)) == (True, "")
    buffer.set_transform(transform("a", "b", SECOND), "me")
    assert buffer.can_transform_core("a", "b", at(7))[0] is False


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


# Many threads


def test_reading_while_writing() -> None:
    buffer = BufferCore(Duration(nanoseconds=2000))
    done = threading.Event()
    problems: list[Exception] = []

    def read() -> None:
        while not done.is_set():
            try:
                found = buffer.lookup_transform_core("a", "c", LATEST)
            except tf2_py.TransformException:
                continue
            except Exception as error:
                problems.append(error)
                return
            # Both halves always move in step, so a mixture of two times would show.
            if translation(found)[0] != 0.0:
                problems.append(AssertionError(found))

    readers = [threading.Thread(target=read) for _ in range(3)]
    for reader in readers:
        reader.start()
    for time in range(1, 3000):
        buffer.set_transform(transform("a", "b", time, (float(time), 0.0, 0.0)), "me")
        buffer.set_transform(transform("b", "c", time, (float(-time), 0.0, 0.0)), "me")
    done.set()
    for reader in readers:
        reader.join()
    assert problems == []
