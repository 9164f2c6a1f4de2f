"""Threads, locks and time of a lock-step run, without its replacement of the standard library."""

import sys
from collections.abc import Callable

import pytest

from daidalos.lockstep import scheduler as scheduler_module
from daidalos.lockstep.primitives import Local, Lock, RLock
from daidalos.lockstep.scheduler import LockstepError, Owner, Scheduler, Wait


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Scheduler:
    scheduler = Scheduler()
    monkeypatch.setattr(Lock, "scheduler", scheduler, raising=False)
    return scheduler


def start(run: Scheduler, *functions: Callable[[], object]) -> None:
    owner = Owner()
    for function in functions:
        run.spawn(function, owner, getattr(function, "__name__", ""))


def test_threads_sleep_in_the_order_of_their_deadlines(run: Scheduler) -> None:
    log: list[tuple[str, int]] = []

    def sleeper(name: str, times: list[int]) -> Callable[[], None]:
        def body() -> None:
            for time_ns in times:
                run.sleep_until(time_ns)
                log.append((name, run.now_ns))

        return body

    start(run, sleeper("a", [30, 40]), sleeper("b", [10, 30, 50]))
    run.run()
    assert log == [("b", 10), ("a", 30), ("b", 30), ("a", 40), ("b", 50)]
    assert run.threads == {}


def test_threads_that_start_others_and_wait_do_not_use_up_the_depth_of_recursion(run: Scheduler) -> None:
    log: list[int] = []

    def deeper(levels: int, then: Callable[[], None]) -> None:
        if levels:
            deeper(levels - 1, then)
        else:
            then()

    def starter(number: int) -> Callable[[], None]:
        def wait() -> None:
            log.append(number)
            if number:
                start(run, starter(number - 1))
            run.sleep_until(run.now_ns + 1)

        return lambda: deeper(sys.getrecursionlimit() // 10, wait)

    start(run, starter(40))
    run.run()
    assert log == list(range(40, -1, -1))


def test_a_lock_is_handed_on_in_the_order_of_asking(run: Scheduler) -> None:
    lock = Lock()
    log: list[int] = []

    def holder() -> None:
        with lock:
            run.sleep_until(100)

    def asker(number: int) -> Callable[[], None]:
        def body() -> None:
            with lock:
                log.append(number)
                run.sleep_until(run.now_ns + 1)

        return body

    start(run, holder, *(asker(k) for k in range(5)))
    run.run()
    assert log == [0, 1, 2, 3, 4]
    assert not lock.locked()


def test_a_timed_wait_for_a_lock_ends_at_its_time_and_takes_nothing(run: Scheduler) -> None:
    lock = Lock()
    results: list[tuple[bool, int]] = []

    def holder() -> None:
        lock.acquire()
        run.sleep_until(2_000_000_000)
        lock.release()

    def impatient() -> None:
        results.append((lock.acquire(timeout=0.5), run.now_ns))
        results.append((lock.acquire(timeout=5.0), run.now_ns))

    start(run, holder, impatient)
    run.run()
    assert results == [(False, 500_000_000), (True, 2_000_000_000)]


def test_the_shortest_timeout_advances_the_time(run: Scheduler) -> None:
    lock = Lock()
    lock.acquire()
    start(run, lambda: lock.acquire(timeout=1e-12))
    run.run()
    assert run.now_ns == 1


def test_misuse_of_a_lock_is_an_error(run: Scheduler) -> None:
    lock = Lock()
    with pytest.raises(RuntimeError, match="release unlocked lock"):
        lock.release()
    lock.acquire()
    assert not lock.acquire(blocking=False)
    with pytest.raises(ValueError, match="non-blocking"):
        lock.acquire(False, 1.0)
    with pytest.raises(RuntimeError, match="only a thread of a lock-step run can wait"):
        lock.acquire()


def test_a_reentrant_lock_belongs_to_a_thread(run: Scheduler) -> None:
    lock = RLock()
    log: list[str] = []

    def first() -> None:
        with lock, lock:
            run.sleep_until(10)
            log.append("first")

    def second() -> None:
        with pytest.raises(RuntimeError, match="un-acquired"):
            lock.release()
        with lock:
            log.append("second")

    start(run, first, second)
    run.run()
    assert log == ["first", "second"]


def test_local_data_is_each_threads_own(run: Scheduler) -> None:
    class Data(Local):
        kind = "shared"

        def __init__(self, value: int) -> None:
            self.value = value

    data = Data(7)
    seen: list[tuple[int, str]] = []

    def thread(number: int) -> Callable[[], None]:
        def body() -> None:
            seen.append((data.value, data.kind))
            data.value = number
            run.sleep_until(run.now_ns + 5)
            seen.append((data.value, data.kind))

        return body

    start(run, thread(1), thread(2))
    run.run()
    assert seen == [(7, "shared"), (7, "shared"), (1, "shared"), (2, "shared")]
    assert data.value == 7


def test_a_deadlock_is_named_with_both_stacks(run: Scheduler) -> None:
    one, other = RLock(), Lock()

    def takes_one_first() -> None:
        with one:
            run.sleep_until(10)
            with other:
                pass

    def takes_other_first() -> None:
        with other:
            run.sleep_until(10)
            with one:
                pass

    start(run, takes_one_first, takes_other_first)
    with pytest.raises(LockstepError, match=r"2 thread.s. wait for each other for ever") as error:
        run.run()
    assert "in takes_one_first" in str(error.value)
    assert "in takes_other_first" in str(error.value)


def test_busy_waiting_advances_the_time(run: Scheduler) -> None:
    def busy() -> None:
        while run.read_clock() < 3_000_000:
            pass

    start(run, busy)
    run.run()
    assert 3_000_000 <= run.now_ns < 3_200_000


def test_threads_that_wake_each_other_without_end_are_named(run: Scheduler, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduler_module, "MAX_SWITCHES", 3000)
    waits: list[Wait] = []

    def player() -> None:
        while True:
            if waits:
                run.wake(waits.pop())
            wait = Wait(run.running(), "the other one")
            waits.append(wait)
            run.wait(wait)

    start(run, player, player)
    run.spawn(lambda: run.wake(waits[0]), Owner(), "umpire")
    with pytest.raises(LockstepError, match=r"wake each other without end: main .player."):
        run.run()


def test_a_run_goes_on_after_a_stop(run: Scheduler) -> None:
    log: list[int] = []

    def body() -> None:
        for k in range(4):
            run.sleep_until(10 * k)
            log.append(k)
            if k == 1:
                run.stop()

    start(run, body)
    run.run()
    assert log == [0, 1]
    run.run()
    assert log == [0, 1, 2, 3]


def test_an_abandoned_thread_does_not_go_on(run: Scheduler) -> None:
    log: list[str] = []

    def victim() -> None:
        try:
            run.sleep_until(100)
        finally:
            log.append("cleaned up")

    thread = run.spawn(victim, Owner())
    start(run, lambda: (run.sleep_until(50), run.abandon(thread)))
    run.run()
    assert log == []
    assert run.now_ns == 50
