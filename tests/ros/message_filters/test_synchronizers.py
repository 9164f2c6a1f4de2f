"""Messages brought together by time, against their readable definition."""

import itertools
import random
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_filters import ApproximateTimeSynchronizer, LatestTimeSynchronizer, SimpleFilter, TimeSynchronizer
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.time import Time
from std_msgs.msg import String

from ros.message_filters.messages import Made, Output, at, real


def sources(count: int = 2) -> list[SimpleFilter]:
    return [SimpleFilter() for _ in range(count)]


def data(output: Output) -> list[tuple[object, ...]]:
    return [tuple(message.data for message in messages) for messages in output.calls]


# The same time


def test_pairs() -> None:
    left, right = inputs = sources()
    output = Output(TimeSynchronizer(inputs, 1))
    for time in range(5):
        left.signalMessage(at(time, ("left", time)))
        right.signalMessage(at(time, ("right", time)))
    assert data(output) == [(("left", time), ("right", time)) for time in range(5)]


@pytest.mark.parametrize("count", range(1, 10))
def test_pairs_in_any_order(count: int) -> None:
    shuffled = random.Random(count)
    left, right = inputs = sources()
    output = Output(TimeSynchronizer(inputs, count))
    for time in shuffled.sample(range(count), count):
        left.signalMessage(at(time, time))
    assert output.calls == []
    for time in shuffled.sample(range(count), count):
        right.signalMessage(at(time, time))
    assert sorted(data(output)) == [(time, time) for time in range(count)]


def test_threes_and_additional_arguments() -> None:
    inputs = sources(3)
    output = Output(TimeSynchronizer(inputs, 5), "more")
    for number, source in enumerate(inputs):
        source.signalMessage(at(1, number))
    assert [message.data for message in output.calls[0][:3]] == [0, 1, 2]
    assert output.calls[0][3] == "more"


def test_each_message_is_used_once() -> None:
    left, right = inputs = sources()
    synchronizer = TimeSynchronizer(inputs, 5)
    output = Output(synchronizer)
    for message in (at(1, "a"), at(1, "b")):
        left.signalMessage(message)
    for _ in range(2):
        right.signalMessage(at(1, "c"))
    assert data(output) == [("b", "c")]
    assert [len(queue) for queue in synchronizer.queues] == [0, 1]


def test_the_oldest_is_dropped_when_there_are_too_many() -> None:
    left, right = inputs = sources()
    output = Output(TimeSynchronizer(inputs, 2))
    for time in (1, 2, 3):
        left.signalMessage(at(time, time))
    for time in (1, 2, 3):
        right.signalMessage(at(time, time))
    assert data(output) == [(2, 2), (3, 3)]


def test_real_messages_of_the_same_nanosecond() -> None:
    left, right = inputs = sources()
    output = Output(TimeSynchronizer(inputs, 5))
    left.signalMessage(real(1.000000001, 1.0))
    right.signalMessage(real(1.000000002, 2.0))
    assert output.calls == []
    right.signalMessage(real(1.000000001, 3.0))
    assert output.calls == [(real(1.000000001, 1.0), real(1.000000001, 3.0))]


def test_messages_without_a_stamp_are_refused() -> None:
    (source,) = inputs = sources(1)
    Output(TimeSynchronizer(inputs, 5))
    with pytest.raises(ValueError, match="a String has no stamp"):
        source.signalMessage(String())


def test_other_ways_to_tell_the_time() -> None:
    left, right = inputs = sources()
    output = Output(TimeSynchronizer(inputs, 5, time_getter=lambda message: Time(nanoseconds=len(message.data))))
    left.signalMessage(String(data="one"))
    right.signalMessage(String(data="two"))
    assert data(output) == [("one", "two")]


@pytest.mark.parametrize(
    "make", [lambda inputs: TimeSynchronizer(inputs, 9), lambda inputs: ApproximateTimeSynchronizer(inputs, 9, 1.0)]
)
def test_a_callback_may_feed_the_synchronizer(make: object) -> None:
    left, right = inputs = sources()
    synchronizer = make(inputs)
    output = Output(synchronizer)

    def feed(one: Made, two: Made) -> None:
        if one.data < 3:
            left.signalMessage(at(10 * one.data + 10, one.data + 1))
            right.signalMessage(at(10 * one.data + 10, one.data + 1))

    synchronizer.registerCallback(feed)
    left.signalMessage(at(0, 0))
    right.signalMessage(at(0, 0))
    assert data(output) == [(number, number) for number in range(4)]


def test_many_threads() -> None:
    inputs = sources(3)
    synchronizer = TimeSynchronizer(inputs, 1000)
    output = Output(synchronizer)
    threads = [
        threading.Thread(target=lambda one=source: [one.signalMessage(at(time, time)) for time in range(300)])
        for source in inputs
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(data(output)) == [(time, time, time) for time in range(300)]


# Nearly the same time


def test_nearly_the_same_time() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 0.1))
    for time in range(5):
        left.signalMessage(at(time, time))
        right.signalMessage(at(time + 0.09, time))
    assert data(output) == [(time, time) for time in range(5)]


def test_slop_apart_is_too_far() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 0.1))
    left.signalMessage(at(1.0))
    right.signalMessage(at(1.1))
    assert output.calls == []
    right.signalMessage(at(1.0999))
    assert len(output.calls) == 1


def test_the_nearest_partner_is_chosen() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 1.0))
    for time in (1.0, 1.5, 1.9):
        left.signalMessage(at(time, time))
    right.signalMessage(at(1.6, "x"))
    right.signalMessage(at(1.7, "y"))
    assert data(output) == [(1.5, "x"), (1.9, "y")]


def by_definition(arrivals: list[tuple[int, int]], count: int, size: int, slop: int) -> list[tuple[int, ...]]:
    """What comes out, tried in the plainest way: all combinations in the order of preference."""
    queues: list[dict[int, int]] = [{} for _ in range(count)]
    found = []
    for index, stamp in arrivals:
        queues[index][stamp] = stamp
        while len(queues[index]) > size:
            del queues[index][min(queues[index])]
        preferred = [
            [stamp] if number == index else sorted(queue, key=lambda one: abs(one - stamp))
            for number, queue in enumerate(queues)
        ]
        for combination in itertools.product(*preferred):
            near = all(abs(one - stamp) <= slop for one in combination)
            if near and max(combination) - min(combination) < slop and stamp in queues[index]:
                found.append(combination)
                for queue, one in zip(queues, combination, strict=True):
                    del queue[one]
                break
    return found


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 30)), max_size=25), st.integers(1, 5), st.integers(1, 12))
def test_as_defined(arrivals: list[tuple[int, int]], size: int, slop: int) -> None:
    inputs = sources(3)
    output = Output(ApproximateTimeSynchronizer(inputs, size, slop))
    for index, stamp in arrivals:
        inputs[index].signalMessage(at(stamp, stamp))
    assert data(output) == by_definition(arrivals, 3, size, slop)


def test_many_inputs_do_not_multiply_the_work() -> None:
    inputs = sources(12)
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 0.5))
    for time in range(10):  # ten candidates each: 10^11 combinations, none of which is near enough
        for source in inputs[1:-1]:
            source.signalMessage(at(1 + 0.01 * time))
        inputs[-1].signalMessage(at(1.75 + 0.01 * time))
    inputs[0].signalMessage(at(1.4))
    assert output.calls == []


def test_real_messages() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 0.1))
    left.signalMessage(real(1.0, 1.0))
    right.signalMessage(real(1.05, 2.0))
    assert output.calls == [(real(1.0, 1.0), real(1.05, 2.0))]


def test_offsets() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 0.1, queue_offset=[0, 2_000_000_000]))
    left.signalMessage(at(1.0, "left"))
    right.signalMessage(at(1.0, "too early"))
    right.signalMessage(at(3.05, "right"))
    left.signalMessage(at(1.1, "again"))
    right.signalMessage(at(3.1, "later"))
    assert data(output) == [("left", "right"), ("again", "later")]


def test_messages_without_a_stamp_are_dropped(capfd: pytest.CaptureFixture[str]) -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 10.0))
    left.signalMessage(String())
    right.signalMessage(String())
    assert output.calls == []
    assert "without a stamp" in capfd.readouterr().err


@pytest.mark.parametrize("options", [{"allow_headerless": True}, {"sync_arrival_time": True}, {"queue_offset": True}])
def test_unless_arrival_counts(options: dict[str, bool]) -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 10.0, **options))
    left.signalMessage(String(data="a"))
    right.signalMessage(String(data="b"))
    assert data(output) == [("a", "b")]


def test_arrival_may_count_for_all() -> None:
    left, right = inputs = sources()
    output = Output(ApproximateTimeSynchronizer(inputs, 10, 10.0, sync_arrival_time=True))
    left.signalMessage(at(1, "a"))
    right.signalMessage(at(1_000_000, "b"))
    assert data(output) == [("a", "b")]


def test_a_queue_given_without_its_number() -> None:
    inputs = sources()
    synchronizer = ApproximateTimeSynchronizer(inputs, 10, 0.1)
    output = Output(synchronizer)
    synchronizer.add(at(1, "a"), synchronizer.queues[0])
    synchronizer.add(at(1, "b"), synchronizer.queues[1])
    assert data(output) == [("a", "b")]


# The latest


class Hand:
    """A clock set by hand."""

    def __init__(self) -> None:
        self.clock = Clock(clock_type=ClockType.ROS_TIME)
        self.clock._set_ros_time_is_active(True)

    def set(self, seconds: float) -> None:
        self.clock.set_ros_time_override(Time(nanoseconds=round(seconds * 1e9), clock_type=ClockType.ROS_TIME))


def test_the_latest_at_the_rate_of_the_fastest() -> None:
    hand = Hand()
    slow, fast = inputs = sources()
    output = Output(LatestTimeSynchronizer(inputs, clock=hand.clock))
    for tenth in range(41):
        hand.set(1 + tenth / 10)
        if tenth % 10 == 5:
            slow.signalMessage(String(data=f"s{tenth}"))
        fast.signalMessage(String(data=f"f{tenth}"))
    # From when both have been heard of, each of the fast one's with the newest of the slow one's.
    assert data(output) == [(f"s{tenth - (tenth - 5) % 10}", f"f{tenth}") for tenth in range(5, 41)]


def test_another_becomes_the_fastest() -> None:
    hand = Hand()
    inputs = sources()
    output = Output(LatestTimeSynchronizer(inputs, clock=hand.clock))
    now = 1.0
    for periods in ((0.1, 1.0), (1.0, 0.1)):
        for tenth in range(100):
            hand.set(now + tenth / 10)
            for source, period in zip(inputs, periods, strict=True):
                if tenth % round(period * 10) == 0:
                    source.signalMessage(String(data=str(tenth)))
        now += 10.0
    late = data(output)[-50:]
    assert len({two for _, two in late}) == 50
    assert len({one for one, _ in late}) <= 6


def test_nothing_before_all_have_been_heard_of() -> None:
    inputs = sources()
    output = Output(LatestTimeSynchronizer(inputs))
    for _ in range(5):
        inputs[0].signalMessage(String())
    assert output.calls == []
