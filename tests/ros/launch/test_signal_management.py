"""Signals in event loops."""

import asyncio
import os
import signal
import threading
import time

import pytest
from launch.utilities import AsyncSafeSignalManager

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals between processes are POSIX's")

ONE, OTHER = signal.SIGUSR1, signal.SIGUSR2


@pytest.fixture
def loop():
    loop = asyncio.new_event_loop()
    yield loop
    loop.close()


@pytest.fixture
def nobody_told():
    """Remove handlers of signals that earlier tests of this process have left."""
    before = signal.set_wakeup_fd(-1)
    yield
    signal.set_wakeup_fd(before)


@pytest.fixture
def plain():
    """Count the signals that reach ordinary handlers."""
    received = []
    before = {number: signal.signal(number, lambda signum, frame: received.append(signum)) for number in (ONE, OTHER)}
    yield received
    for number, handler in before.items():
        signal.signal(number, handler)


def send_and_wait(loop, number, *futures):
    loop.call_soon(os.kill, os.getpid(), number)
    loop.run_until_complete(asyncio.wait(futures, timeout=10))


def test_handlers_are_active_inside_only(loop, plain):
    manager = AsyncSafeSignalManager(loop)
    got = loop.create_future()
    assert manager.handle(ONE, got.set_result) is None
    with manager:
        send_and_wait(loop, ONE, got)
        assert got.result() == ONE
    assert plain == []
    os.kill(os.getpid(), ONE)
    assert plain == [ONE]
    got = loop.create_future()
    manager.handle(ONE, got.set_result)
    with manager:
        send_and_wait(loop, ONE, got)
        assert got.done()


def test_handlers_can_be_changed_inside(loop, plain):
    first, second = loop.create_future(), loop.create_future()
    with AsyncSafeSignalManager(loop) as manager:
        manager.handle(ONE, first.set_result)
        assert manager.handle(ONE, second.set_result) == first.set_result
        send_and_wait(loop, ONE, second)
        assert second.done()
        assert not first.done()
        manager.handle(ONE, None)
        os.kill(os.getpid(), ONE)
        assert plain == [ONE]


@pytest.mark.usefixtures("nobody_told")
def test_a_signal_wakes_the_loop_although_another_thread_got_it(loop, plain):
    manager = AsyncSafeSignalManager(loop)
    got = loop.create_future()
    manager.handle(ONE, got.set_result)
    begun = time.monotonic()
    other = threading.Timer(0.2, lambda: signal.pthread_kill(threading.get_ident(), ONE))
    with manager:
        other.start()
        loop.run_until_complete(asyncio.wait([got], timeout=60))
    assert got.done()
    assert time.monotonic() - begun < 30
    other.join()
    assert signal.set_wakeup_fd(-1) == -1


def test_other_signals_are_left_alone(loop, plain):
    with AsyncSafeSignalManager(loop) as manager:
        manager.handle(ONE, lambda signum: None)
        os.kill(os.getpid(), OTHER)
        assert plain == [OTHER]


def test_nested_managers_hear_both(loop, plain):
    outer_got, inner_got = loop.create_future(), loop.create_future()
    outer, inner = AsyncSafeSignalManager(loop), AsyncSafeSignalManager(loop)
    outer.handle(ONE, lambda signum: outer_got.done() or outer_got.set_result(signum))
    inner.handle(ONE, inner_got.set_result)
    with outer:
        with inner:
            send_and_wait(loop, ONE, outer_got, inner_got)
            assert outer_got.result() == inner_got.result() == ONE
        outer_got = loop.create_future()
        send_and_wait(loop, ONE, outer_got)
        assert outer_got.done()


def test_only_the_main_thread_has_signals(loop):
    errors = []

    def enter():
        try:
            AsyncSafeSignalManager(loop).__enter__()
        except RuntimeError as error:
            errors.append(error)

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert "main thread" in str(errors[0])


def test_a_manager_is_entered_once_at_a_time(loop):
    with AsyncSafeSignalManager(loop) as manager, pytest.raises(RuntimeError, match="already active"):
        manager.__enter__()
