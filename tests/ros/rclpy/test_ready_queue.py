"""The queue that executors wait on."""

import threading
import time
from contextlib import suppress

import pytest
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.impl.ready_queue import ReadyQueue
from rclpy.impl.timer import TimerHandle

MS = 1_000_000


def test_items_come_out_in_their_order() -> None:
    queue = ReadyQueue()
    assert queue.empty()
    for number in range(5):
        queue.put(number)
    assert [queue.get(None) for _ in range(5)] == list(range(5))
    assert queue.empty()


def test_what_is_urgent_comes_first_and_leaves_room_for_the_rest() -> None:
    queue = ReadyQueue()
    for number in range(3):
        queue.put(number)
    for letter in "abc":
        queue.put_first(letter)
    assert [queue.get(None) for _ in range(6)] == ["a", 0, "b", 1, "c", 2]


def test_a_wait_ends_with_its_deadline() -> None:
    queue = ReadyQueue()
    for span in (-MS, 0, 1, 10 * MS):
        deadline = time.monotonic_ns() + span
        with pytest.raises(TimeoutError):
            queue.get(deadline)
        assert time.monotonic_ns() >= deadline


def test_nothing_is_lost_and_nobody_sleeps_for_ever() -> None:
    """Many short waits while others fill the queue: what a timed wait of Python's own queue does not survive."""
    queue = ReadyQueue()
    count, writers = 5000, 4

    def fill() -> None:
        for number in range(count):
            queue.put(number)

    threads = [threading.Thread(target=fill) for _ in range(writers)]
    for thread in threads:
        thread.start()
    received, late = 0, time.monotonic() + 30
    while received < count * writers:
        assert time.monotonic() < late
        try:
            queue.get(time.monotonic_ns() + 20_000)
            received += 1
        except TimeoutError:
            continue
    for thread in threads:
        thread.join()


def test_timers_are_told_in_the_order_of_their_deadlines() -> None:
    queue, told = ReadyQueue(), []
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    timers = [TimerHandle(clock.handle, period * MS, lambda period=period: told.append(period)) for period in (3, 1, 2)]
    for timer in timers:
        timer.attach(queue.schedule)
    timers[2].cancel_timer()
    deadline = time.monotonic_ns() + 20 * MS
    with suppress(TimeoutError):
        while True:
            assert queue.get(deadline) is None, "only what wakes a waiting thread comes out"
    assert told == [1, 3]


def test_timers_that_were_cancelled_are_not_hoarded() -> None:
    queue = ReadyQueue()
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    for _ in range(10_000):
        timer = TimerHandle(clock.handle, 1000 * 1000 * MS, lambda: None)
        timer.attach(queue.schedule)
        timer.destroy_when_not_in_use()
    assert len(queue._timers) < 200


def test_timers_of_other_threads_wake_who_waits_while_cancelled_ones_are_removed() -> None:
    """The waiting thread reads the first timer without the lock: none may be overlooked while others are added."""
    queue, kept = ReadyQueue(), []
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    count, writers = 300, 4

    def schedule(writer: int) -> None:
        for number in range(count):
            name = (writer, number)
            timer = TimerHandle(clock.handle, number % 7 * MS, lambda name=name: queue.put(name))
            kept.append(timer)
            timer.attach(queue.schedule)
            for _ in range(3):
                cancelled = TimerHandle(clock.handle, 1000 * 1000 * MS, lambda: None)
                cancelled.attach(queue.schedule)
                cancelled.cancel_timer()

    threads = [threading.Thread(target=schedule, args=(writer,)) for writer in range(writers)]
    for thread in threads:
        thread.start()
    received, deadline = [], time.monotonic_ns() + 60_000 * MS
    while len(received) < count * writers:
        item = queue.get(deadline)
        if item is not None:
            received.append(item)
    for thread in threads:
        thread.join()
    assert sorted(received) == [(writer, number) for writer in range(writers) for number in range(count)]
