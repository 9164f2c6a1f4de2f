"""Signals: what is asked twice at once is one wish, what is asked again is another."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from types import FrameType

import pytest
import rclpy
from rclpy import signals
from rclpy.context import Context
from rclpy.impl import signal_watch
from rclpy.impl.interrupts import uninterrupted
from rclpy.signals import SignalHandlerGuardCondition, SignalHandlerOptions

from ros.rclpy.waiting import run_ready


@pytest.fixture
def raised(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """The signals that reach the handler that was there before."""
    reached: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        reached.append(number)

    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    monkeypatch.setattr(signals, "_last_signal_s", -1e9)
    monkeypatch.setattr(signals, "_REPEAT_INTERVAL_S", 60.0)  # a busy machine must not make two of one
    signals.uninstall_signal_handlers()  # those of tests before
    before = signal.signal(signal.SIGINT, note)
    yield reached
    rclpy.try_shutdown()
    signals.uninstall_signal_handlers()
    signal.signal(signal.SIGINT, before)


def test_a_signal_ends_the_contexts_and_is_passed_on(raised: list[int]) -> None:
    with Context() as other:
        rclpy.init(args=[])
        signals.watch_context(other)
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        assert not rclpy.ok()
        assert not other.ok()
        assert raised == [signal.SIGINT]
        rclpy.shutdown()  # as programs do at their end
        with pytest.raises(RuntimeError):
            rclpy.shutdown()


def test_what_is_asked_again_later_is_passed_on_again(raised: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    rclpy.init(args=[])
    for _ in range(2):
        signal.raise_signal(signal.SIGINT)
        monkeypatch.setattr(signals, "_last_signal_s", -1e9)
    assert raised == [signal.SIGINT, signal.SIGINT]


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals are not sent to threads here")
def test_the_import_system_is_not_broken_off(raised: list[int]) -> None:
    source = (
        "def step(raised):\n"
        "    signal.raise_signal(signal.SIGINT)\n"
        "    return list(raised)  # it would hold a lock here\n"
    )
    names = {"signal": signal}
    exec(compile(source, "<frozen importlib._bootstrap>", "exec"), names)
    rclpy.init(args=[])
    assert names["step"](raised) == []
    assert not rclpy.ok()
    deadline = time.monotonic() + 60.0
    while not raised and time.monotonic() < deadline:
        signal.sigtimedwait([], 0.01)
    assert raised == [signal.SIGINT]


def test_leaving_the_graph_is_not_broken_off(raised: list[int]) -> None:
    rclpy.init(args=[])
    with uninterrupted():
        signal.raise_signal(signal.SIGINT)
    assert rclpy.ok()
    assert raised == []


def test_handlers_are_there_as_long_as_the_default_context(raised: list[int]) -> None:
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
    rclpy.init(args=[])
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.ALL
    rclpy.shutdown()
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
    with Context() as other:
        rclpy.init(args=[], context=Context())
        assert other.ok()
        assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO


def test_a_guard_condition_may_wait_for_a_signal(raised: list[int]) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("tested")
    guard = SignalHandlerGuardCondition()
    triggered = threading.Event()
    guard.handle.listen(triggered.set)
    signal.raise_signal(signal.SIGINT)
    assert triggered.is_set()
    guard.destroy()
    node.destroy_node()


def test_only_the_main_thread_takes_signals(raised: list[int]) -> None:
    thread = threading.Thread(target=lambda: rclpy.init(args=[]))
    thread.start()
    thread.join()
    assert rclpy.ok()
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
    node = rclpy.create_node("tested")
    run_ready(_executor(node))


def _executor(node: rclpy.node.Node) -> rclpy.executors.Executor:
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    return executor


UNHEARD = """
import os, signal, sys, threading, time
import rclpy
rclpy.init()
node = rclpy.create_node("waiting")
executor = rclpy.executors.SingleThreadedExecutor()
executor.add_node(node)

def raise_here():
    while not executor._ready._waiting_thread:
        time.sleep(0.01)
    time.sleep(0.3)  # the main thread waits now, and nothing else wakes it
    signal.pthread_kill(threading.get_ident(), signal.SIGINT)

threading.Thread(target=raise_here).start()
try:
    executor.spin()
except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
    print("heard", flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals between threads are POSIX's")
def test_a_signal_is_heard_although_another_thread_got_it() -> None:
    environment = os.environ | {"RMW_IMPLEMENTATION": "rmw_daidalos_inprocess"}
    done = subprocess.run(
        [sys.executable, "-c", UNHEARD], env=environment, capture_output=True, text=True, timeout=40, check=False
    )
    assert (done.stdout, done.stderr) == ("heard\n", "")


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals between threads are POSIX's")
def test_handlers_of_others_are_seen_to_run_for_a_while(raised: list[int]) -> None:
    gate = threading.Lock()
    gate.acquire()

    def open_gate(number: int, frame: FrameType | None) -> None:
        gate.release()

    signal.signal(signal.SIGINT, open_gate)
    with signal_watch.watching(signal.SIGINT):
        here = threading.Timer(0.2, lambda: signal.pthread_kill(threading.get_ident(), signal.SIGINT))
        here.start()
        assert gate.acquire(timeout=20.0)
        here.join()
    assert signal.getsignal(signal.SIGINT) is open_gate
    assert signal.set_wakeup_fd(-1) == -1


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals between threads are POSIX's")
def test_a_signal_that_was_handled_is_not_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signal_watch, "_TIMEOUT_S", 0.2)
    handled: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: handled.append(number))
    try:
        with signal_watch.watching(signal.SIGINT):
            for pause in (0.0, 0.04, 0.12, 0.2, 0.28, 0.6):
                signal.raise_signal(signal.SIGINT)
                time.sleep(pause)  # in different phases of the watching thread
        assert len(handled) == 6
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals between threads are POSIX's")
def test_a_signal_that_comes_while_the_pipe_is_read_is_not_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    take = signal_watch._take
    handled: list[int] = []
    raised_by_main = threading.Event()
    taking = threading.Event()

    def take_late(reader: int) -> bytes | None:
        if threading.current_thread() is threading.main_thread():
            return b""  # the watching thread reads the number before the handler can
        if handled and not taking.is_set():
            taking.set()
            raised_by_main.wait(5.0)
        return take(reader)

    monkeypatch.setattr(signal_watch, "_TIMEOUT_S", 0.2)
    monkeypatch.setattr(signal_watch, "_take", take_late)
    before = signal.signal(signal.SIGINT, lambda number, frame: handled.append(number))
    try:
        with signal_watch.watching(signal.SIGINT):
            signal.raise_signal(signal.SIGINT)
            assert taking.wait(5.0)
            signal.raise_signal(signal.SIGINT)
            raised_by_main.set()
            time.sleep(0.1)
        assert handled == [signal.SIGINT] * 2
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals between threads are POSIX's")
def test_a_signal_that_is_left_over_is_not_sent_to_the_next_handler(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signal_watch, "_TIMEOUT_S", 0.2)
    handled: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: handled.append(number))
    try:
        with signal_watch.watching(signal.SIGINT):
            assert signal_watch._writer is not None
            os.write(signal_watch._writer, bytes([signal.SIGINT]))
        with signal_watch.watching(signal.SIGINT):
            time.sleep(0.6)
        assert handled == []
    finally:
        signal.signal(signal.SIGINT, before)


def test_others_may_be_told_of_signals(raised: list[int]) -> None:
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal_watch.stop()
    signal.set_wakeup_fd(writer)
    try:
        signal_watch.start()
        assert signal.set_wakeup_fd(writer) == writer
    finally:
        signal.set_wakeup_fd(-1)
        os.close(reader)
        os.close(writer)
