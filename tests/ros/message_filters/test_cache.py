"""Remembered messages, against a plain list."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_filters import Cache, SimpleFilter
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.time import Time
from std_msgs.msg import String

from ros.message_filters.messages import Output, at, real


def time(seconds: float) -> Time:
    return Time(nanoseconds=round(seconds * 1e9))


@pytest.fixture
def cache() -> Cache:
    """With messages of the seconds 1 to 5."""
    cache = Cache(SimpleFilter(), 5)
    for seconds in range(6):
        cache.add(at(seconds, seconds))
    return cache


def test_an_empty_cache() -> None:
    empty = Cache(SimpleFilter(), 5)
    assert empty.getInterval(time(0), time(9)) == []
    for found in (
        empty.getElemAfterTime(time(0)),
        empty.getElemBeforeTime(time(9)),
        empty.getLastestTime(),
        empty.getOldestTime(),
        empty.getLast(),
    ):
        assert found is None


def test_an_interval_includes_its_ends(cache: Cache) -> None:
    assert [message.data for message in cache.getInterval(time(2), time(4))] == [2, 3, 4]
    assert [message.data for message in cache.getInterval(time(2.5), time(3.5))] == [3]
    assert cache.getInterval(time(2.5), time(2.7)) == []
    with pytest.raises(AssertionError, match="before it begins"):
        cache.getInterval(time(3), time(2))


def test_neighbours_of_a_time(cache: Cache) -> None:
    assert cache.getElemAfterTime(time(3)).data == cache.getElemBeforeTime(time(3)).data == 3
    assert cache.getElemAfterTime(time(3.1)).data == 4
    assert cache.getElemBeforeTime(time(3.9)).data == 3
    assert cache.getElemAfterTime(time(5.1)) is None
    assert cache.getElemBeforeTime(time(0.5)) is None


def test_ends(cache: Cache) -> None:
    assert cache.getLastestTime() == cache.getLatestTime() == time(5)
    assert cache.getOldestTime() == time(1)
    assert cache.getLast().data == 5


@given(st.lists(st.integers(0, 20), max_size=12), st.integers(1, 6), st.integers(0, 20), st.integers(0, 20))
def test_as_a_sorted_list_would(stamps: list[int], size: int, one: int, two: int) -> None:
    cache = Cache(SimpleFilter(), size)
    kept: list[tuple[int, int]] = []
    for number, stamp in enumerate(stamps):
        cache.add(at(stamp, number))
        kept = sorted([*kept, (stamp, number)])[-size:]
    begin, end = min(one, two), max(one, two)
    found = [message.data for message in cache.getInterval(time(begin), time(end))]
    assert found == [number for stamp, number in kept if begin <= stamp <= end]
    after = cache.getElemAfterTime(time(one))
    assert (after and after.data) == next((number for stamp, number in kept if stamp >= one), None)
    before = cache.getElemBeforeTime(time(one))
    assert (before and before.data) == next((number for stamp, number in reversed(kept) if stamp <= one), None)


def test_it_passes_everything_on() -> None:
    source = SimpleFilter()
    output = Output(Cache(source, 2))
    messages = [at(3), at(1), at(2), at(0)]
    for message in messages:
        source.signalMessage(message)
    assert output.calls == [(message,) for message in messages]


def test_real_messages_and_one_place_by_default() -> None:
    cache = Cache(SimpleFilter())
    cache.add(real(1, 1.0))
    cache.add(real(2, 2.0))
    assert cache.getInterval(time(0), time(9)) == [real(2, 2.0)]
    assert cache.getLastestTime() == Time(seconds=2, clock_type=ClockType.ROS_TIME)


def test_messages_without_a_stamp(capfd: pytest.CaptureFixture[str]) -> None:
    strict = Cache(SimpleFilter(), 5)
    output = Output(strict)
    strict.add(String(data="lost"))
    assert strict.getLast() is None
    assert output.calls == []
    assert "without a stamp" in capfd.readouterr().err
    lenient = Cache(SimpleFilter(), 5, allow_headerless=True)
    before = ROSClock().now()
    lenient.add(String(data="kept"))
    assert before <= lenient.getLastestTime() <= ROSClock().now()
    assert lenient.getElemAfterTime(before) == String(data="kept")
