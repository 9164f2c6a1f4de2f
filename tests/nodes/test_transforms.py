"""Waiting for the transform at a message's time: it comes, or it is known never to come."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from rclpy.clock import ROSClock
from rclpy.time import Time as RclpyTime

from daidalos.nodes.transforms import BlockingBuffer


@pytest.fixture
def buffer() -> BlockingBuffer:
    """A buffer whose clock is the test's."""
    buffer = BlockingBuffer()
    buffer.clock = ROSClock()
    buffer.clock._set_ros_time_is_active(True)
    return buffer


def set_clock(buffer: BlockingBuffer, second: float) -> None:
    buffer.clock.set_ros_time_override(RclpyTime(nanoseconds=int(second * 1e9), clock_type=buffer.clock.clock_type))


def hear(buffer: BlockingBuffer, second: int, x: float = 0.0) -> None:
    transform = TransformStamped(child_frame_id="base")
    transform.header.frame_id = "odom"
    transform.header.stamp = Time(sec=second)
    transform.transform.translation.x = x
    transform.transform.rotation.w = 1.0
    buffer.set_transform(transform, "test")


def test_it_comes_with_the_transforms_around_it(buffer: BlockingBuffer) -> None:
    future = buffer.transform_at("odom", "base", Time(sec=3))
    hear(buffer, 2, x=2.0)
    assert not future.done()
    hear(buffer, 4, x=4.0)
    assert future.done()
    assert future.result().transform.translation.x == pytest.approx(3.0)


def test_what_was_before_the_first_transform_never_comes(buffer: BlockingBuffer) -> None:
    future = buffer.transform_at("odom", "base", Time(sec=3))
    hear(buffer, 4)
    assert future.done()
    assert future.result() is None
    assert buffer.transform_at("odom", "base", Time(sec=3)).done()


def test_what_was_forgotten_never_comes(buffer: BlockingBuffer) -> None:
    hear(buffer, 2)
    future = buffer.transform_at("odom", "base", Time(sec=3))
    buffer.clear()
    assert not future.done()
    hear(buffer, 4)
    assert future.result() is None
    assert future.done()


def test_what_belongs_to_a_time_that_was_taken_back_never_comes(buffer: BlockingBuffer) -> None:
    set_clock(buffer, 120.0)
    hear(buffer, 119)
    future = buffer.transform_at("odom", "base", Time(sec=120))
    assert not future.done()
    set_clock(buffer, 5.0)
    buffer.clear()
    assert future.done()
    assert future.result() is None
