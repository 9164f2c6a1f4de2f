"""Futures and tasks."""

import asyncio
import threading
from typing import Any

import pytest
from rclpy.task import Future, Task


class Notes:
    """What stands in for an executor."""

    def __init__(self) -> None:
        self.tasks: list[tuple[Any, tuple[Any, ...]]] = []

    def create_task(self, callback: Any, *arguments: Any) -> None:
        self.tasks.append((callback, arguments))


def finish_with_result(future: Future) -> None:
    future.set_result(3)


def finish_with_exception(future: Future) -> None:
    future.set_exception(ZeroDivisionError())
    future.exception()


def cancel(future: Future) -> None:
    future.cancel()


@pytest.mark.parametrize("end", [finish_with_result, finish_with_exception, cancel])
@pytest.mark.parametrize("early", [True, False])
def test_every_end_is_told(end: Any, early: bool) -> None:
    told: list[Future] = []
    future = Future()
    if early:
        future.add_done_callback(told.append)
    end(future)
    if not early:
        future.add_done_callback(told.append)
    assert told == [future]
    assert (future.done(), future.cancelled()) == ((False, True) if end is cancel else (True, False))


@pytest.mark.parametrize("end", [finish_with_result, finish_with_exception, cancel])
def test_an_executor_tells_it(end: Any) -> None:
    notes = Notes()
    future = Future(executor=notes)
    future.add_done_callback(print)
    end(future)
    assert notes.tasks == [(print, (future,))]


def test_a_broken_callback_does_not_keep_others_from_being_told() -> None:
    told: list[Future] = []
    future = Future()
    future.add_done_callback(lambda _: 1 / 0)
    future.add_done_callback(told.append)
    with pytest.warns(RuntimeWarning, match="division"):
        future.set_result(1)
    assert told == [future]


def test_a_callback_can_be_taken_back() -> None:
    told: list[Future] = []
    future = Future()
    future.add_done_callback(told.append)
    assert future.remove_done_callback(told.append)
    assert not future.remove_done_callback(told.append)
    future.set_result(1)
    assert told == []


def test_what_ended_may_end_again() -> None:
    future = Future()
    future.cancel()
    future.set_result(1)
    assert future.done()
    assert not future.cancelled()
    future.set_exception(ZeroDivisionError())
    assert isinstance(future.exception(), ZeroDivisionError)
    with pytest.raises(ZeroDivisionError):
        future.result()


def test_an_exception_that_nobody_looks_at_is_shown(capfd: pytest.CaptureFixture[str]) -> None:
    Future().set_exception(ZeroDivisionError("forgotten"))
    assert "forgotten" in capfd.readouterr().err


@pytest.mark.parametrize("kind", ["function", "coroutine function", "coroutine"])
def test_a_task_is_the_future_of_what_it_does(kind: str) -> None:
    async def add(a: int, b: int = 0) -> int:
        return a + b

    handler: Any = {"function": lambda a, b=0: a + b, "coroutine function": add, "coroutine": None}[kind]
    task = Task(add(1, b=2)) if kind == "coroutine" else Task(handler, (1,), {"b": 2})
    assert not task.executing()
    task()
    assert task.result() == 3
    task()
    assert task.result() == 3


def test_a_coroutine_goes_on_at_the_next_call() -> None:
    steps: list[int] = []

    async def walk() -> str:
        steps.append(1)
        await asyncio.sleep(0)
        steps.append(2)
        return "there"

    task = Task(walk)
    task()
    assert (steps, task.done()) == ([1], False)
    task()
    assert (steps, task.result()) == ([1, 2], "there")


@pytest.mark.parametrize("is_coroutine", [True, False])
def test_exceptions_are_kept(is_coroutine: bool) -> None:
    def fail() -> None:
        raise ZeroDivisionError

    async def fail_later() -> None:
        fail()

    task = Task(fail_later if is_coroutine else fail)
    task()
    assert isinstance(task.exception(), ZeroDivisionError)


def test_a_cancelled_task_is_not_begun_or_ended() -> None:
    begun: list[int] = []
    ended: list[int] = []

    async def work() -> None:
        begun.append(1)
        try:
            await Future()
        finally:
            ended.append(1)

    task = Task(work)
    task()
    task.cancel()
    assert (task.cancelled(), begun, ended) == (True, [1], [1])
    done = Task(lambda: None)
    done()
    done.cancel()
    assert not done.cancelled()


def test_waking_takes_no_executor() -> None:
    future, woken = Future(executor=Notes()), threading.Event()
    future.on_wake(woken.set)
    threading.Thread(target=future.set_result, args=(1,)).start()
    assert woken.wait(10)


def test_futures_can_be_typed() -> None:
    assert Future[int].__origin__ is Future
    assert Future[int]().done() is False


@pytest.mark.parametrize("end", [finish_with_result, finish_with_exception, cancel])
def test_asyncio_can_await_what_another_thread_ends(end: Any) -> None:
    async def wait() -> Any:
        future = Future()
        threading.Timer(0.01, end, (future,)).start()
        return await asyncio.wait_for(_awaited(future), 10)

    if end is finish_with_exception:
        with pytest.raises(ZeroDivisionError):
            asyncio.run(wait())
    else:
        assert asyncio.run(wait()) == (3 if end is finish_with_result else None)


def test_asyncio_goes_on_while_a_coroutine_of_an_executor_runs_in_it() -> None:
    first, second = Future(), Future()

    async def callback() -> int:
        return int(await first)

    async def main() -> int:
        task = Task(callback)
        task()  # as an executor does, in the loop's thread
        waiting = asyncio.ensure_future(_awaited(second))
        await asyncio.sleep(0)
        first.set_result(4)
        task()
        second.set_result(task.result())
        return int(await waiting)

    assert asyncio.run(main()) == 4


async def _awaited(future: Future) -> Any:
    return await future


def test_a_task_that_is_woken_by_another_thread_while_it_begins_to_wait_goes_on():
    class Quick(Future):
        def on_wake(self, wake):
            self.set_result("now")
            thread = threading.Thread(target=wake)
            thread.start()
            thread.join()

    async def wait():
        return await Quick()

    task = Task(wait)
    task._requeue = lambda woken: woken()
    task()
    assert task.done()
    assert task.result() == "now"
