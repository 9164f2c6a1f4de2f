"""A buffer of transforms that changes: static transforms, clearing, and many threads."""

import threading

import pytest
import tf2_py
from rclpy.duration import Duration
from tf2_py import BufferCore

from ros.transforms import (
    LATEST,
    SECOND,
    at,
    transform,
    translation,
)

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


# Many threads


@pytest.mark.slow
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
