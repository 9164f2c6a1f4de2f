"""What the buffer of transforms finds, against scipy and closed forms, and at which times."""

import math

import numpy as np
import pytest
import tf2_py
import yaml
from hypothesis import given
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.time import Time
from scipy.spatial.transform import Rotation, Slerp
from tf2_py import BufferCore

from ros.transforms import (
    LATEST,
    SECOND,
    at,
    matrix,
    matrix_of,
    quarter_turn,
    quaternion,
    quaternions,
    stamp,
    transform,
    translation,
    vectors,
)

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
