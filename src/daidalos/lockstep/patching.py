"""Replacement of the standard library's threads, locks and clocks by those of a lock-step run.

It is done once, at the start of a process that does nothing else, before other modules take the originals. What stays
real is what waits for other processes: files, sockets, ``subprocess``.
"""

from __future__ import annotations

import _thread
import asyncio
import asyncio.selector_events
import datetime
import os
import queue
import random
import selectors
import signal
import subprocess
import sys
import threading
import time
import types
import uuid
from collections.abc import Callable
from typing import Any

from daidalos.lockstep.outside import Outside
from daidalos.lockstep.primitives import Local, Lock, RLock
from daidalos.lockstep.scheduler import EPOCH_NS, FIRST_IDENT, Owner, Scheduler, Wait

start_real_thread = _thread.start_new_thread
real_thread_ident = _thread.get_ident
real_monotonic = time.monotonic
real_sleep = time.sleep

_MACHINE_ADDRESS = 0x020000000001
"""What `uuid.getnode` returns on every machine: a locally administered address."""

_OTHER_RECEIVER = 1 << 20
"""File descriptor that stands for a receiver of signals beside the caller."""


class Randomness:
    """Seeded random numbers of one program: those of `os.urandom`, ``random`` and numpy's global generator."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.python = random.Random(seed)
        self.system = random.Random(seed ^ 0x5DEECE66D)
        self.numpy: Any = None

    def install_numpy(self) -> None:
        """Make numpy's global functions draw from this program's stream, once numpy's are loaded."""
        module = sys.modules.get("numpy.random")
        if module is None or not hasattr(module, "set_bit_generator"):
            return
        if self.numpy is None:
            self.numpy = module.MT19937(self.seed & 0xFFFFFFFF)
        module.set_bit_generator(self.numpy)


class Hooks:
    """What the replacements ask about the program whose thread runs.

    Attributes
    ----------
    owner : callable
        Returns the program that new threads belong to.
    randomness : callable
        Returns its random numbers.
    main_thread : callable
        Returns its main thread, as `threading` has it.
    handlers : callable
        Returns the handlers of its signals, by number.
    send_signal : callable
        Sends it a signal.
    """

    def __init__(
        self,
        owner: Callable[[], Owner],
        randomness: Callable[[], Randomness],
        main_thread: Callable[[], threading.Thread],
        handlers: Callable[[], dict[int, Any]],
        send_signal: Callable[[int], None],
    ) -> None:
        self.owner = owner
        self.randomness = randomness
        self.main_thread = main_thread
        self.handlers = handlers
        self.send_signal = send_signal


def install(scheduler: Scheduler, hooks: Hooks) -> None:
    """Replace them all in this process, for good."""
    Lock.scheduler = scheduler
    _patch_clocks(scheduler)
    _patch_threads(scheduler, hooks)
    _patch_random_numbers(hooks)
    _patch_signals(hooks)
    _patch_event_loops(scheduler)
    Outside(scheduler).install()


def _patch_threads(scheduler: Scheduler, hooks: Hooks) -> None:
    def get_ident() -> int:
        thread = scheduler.current
        return FIRST_IDENT if thread is None else thread.ident

    def start_new_thread(function: Callable[..., Any], args: tuple[Any, ...], kwargs: Any = None) -> int:
        thread = scheduler.spawn(lambda: _run(function, args, kwargs or {}), hooks.owner(), _name_of(function))
        return thread.ident

    replacements = {
        "get_ident": get_ident,
        "get_native_id": get_ident,
        "allocate_lock": Lock,
        "RLock": RLock,
        "start_new_thread": start_new_thread,
        "start_new": start_new_thread,
        "_local": Local,
    }
    for name, value in replacements.items():
        if hasattr(_thread, name):
            setattr(_thread, name, value)
    original: Any = threading.main_thread()
    module: Any = threading
    for name, value in {
        "_start_new_thread": start_new_thread,
        "_allocate_lock": Lock,
        "Lock": Lock,
        "RLock": RLock,
        "_CRLock": RLock,
        "_PyRLock": RLock,
        "get_ident": get_ident,
        "get_native_id": get_ident,
        "local": Local,
        "main_thread": hooks.main_thread,
        "_active_limbo_lock": RLock(),
    }.items():
        setattr(module, name, value)
    module._time = time.monotonic
    module._active = {get_ident(): original}
    original._ident = get_ident()
    _patch_thread_class(scheduler, hooks)
    queues: Any = queue
    queues.SimpleQueue = queues._PySimpleQueue
    queues.time = time.monotonic


def _patch_thread_class(scheduler: Scheduler, hooks: Hooks) -> None:
    module: Any = threading
    kind = module.Thread

    def start(self: Any) -> None:
        if not self._initialized:
            raise RuntimeError("thread.__init__() not called")
        if self._started.is_set():
            raise RuntimeError("threads can only be started once")
        thread = scheduler.spawn(lambda: _bootstrap(self), hooks.owner(), self._name)
        self._lockstep = thread
        self._lockstep_done = threading.Event()
        thread.on_end.append(self._lockstep_done.set)
        self._ident = thread.ident
        self._native_id = self._ident
        module._active[self._ident] = self
        thread.on_end.append(lambda: module._active.pop(self._ident, None))
        self._started.set()

    def join(self: Any, timeout: float | None = None) -> None:
        if not self._initialized:
            raise RuntimeError("Thread.__init__() not called")
        if not self._started.is_set():
            raise RuntimeError("cannot join thread before it is started")
        if self is threading.current_thread():
            raise RuntimeError("cannot join current thread")
        if hasattr(self, "_lockstep_done"):
            self._lockstep_done.wait(timeout if timeout is None or timeout >= 0 else 0)

    def is_alive(self: Any) -> bool:
        thread = getattr(self, "_lockstep", None)
        return self._started.is_set() and (thread is None or not thread.ended)

    kind.start, kind.join, kind.is_alive = start, join, is_alive


def _bootstrap(thread: Any) -> None:
    """Run a thread of `threading`, and report what it raises as `threading` does."""
    try:
        thread.run()
    except SystemExit:
        pass
    except (Exception, KeyboardInterrupt):
        threading.excepthook(threading.ExceptHookArgs((*sys.exc_info(), thread)))


def _run(function: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> None:
    try:
        function(*args, **kwargs)
    except SystemExit:
        pass
    except Exception:
        sys.excepthook(*sys.exc_info())


def _name_of(function: Callable[..., Any]) -> str:
    return getattr(function, "__qualname__", repr(function))


def _patch_clocks(scheduler: Scheduler) -> None:
    read = scheduler.read_clock
    real = types.ModuleType("time")
    real.__dict__.update(time.__dict__)

    def sleep(seconds: float) -> None:
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        # Who sleeps for no time waits for something: the time has to advance.
        scheduler.sleep_until(scheduler.now_ns + max(round(1e9 * seconds), 1000))

    def time_ns() -> int:
        return EPOCH_NS + read()

    replacements: dict[str, Any] = {
        "sleep": sleep,
        "time": lambda: 1e-9 * (EPOCH_NS + read()),
        "time_ns": time_ns,
        "localtime": lambda seconds=None: real.localtime(1e-9 * time_ns() if seconds is None else seconds),
        "gmtime": lambda seconds=None: real.gmtime(1e-9 * time_ns() if seconds is None else seconds),
        "strftime": lambda text, *when: real.strftime(text, *(when or (real.localtime(1e-9 * time_ns()),))),
        "ctime": lambda seconds=None: real.ctime(1e-9 * time_ns() if seconds is None else seconds),
    }
    for name in ("monotonic", "perf_counter", "process_time", "thread_time"):
        replacements[name] = lambda: 1e-9 * read()
        replacements[f"{name}_ns"] = read
    for name, value in replacements.items():
        setattr(time, name, value)
    os.times = lambda: os.times_result((0.0, 0.0, 0.0, 0.0, 1e-9 * read()))
    for module in (subprocess, selectors):  # they wait for other processes
        for name in ("time", "_time"):
            if hasattr(module, name):
                setattr(module, name, real if isinstance(getattr(module, name), types.ModuleType) else real.monotonic)
    _patch_datetime(time_ns)


def _patch_datetime(time_ns: Callable[[], int]) -> None:
    module: Any = datetime
    original: Any = module.datetime

    class Meta(type):
        def __instancecheck__(cls, instance: object) -> bool:
            return isinstance(instance, original)

        def __subclasscheck__(cls, kind: type) -> bool:
            return issubclass(kind, original)

    class Datetime(original, metaclass=Meta):  # type: ignore[misc]
        """`datetime.datetime` whose present is the run's."""

        @classmethod
        def now(cls, tz: Any = None) -> Any:
            return original.fromtimestamp(1e-9 * time_ns(), tz)

        @classmethod
        def utcnow(cls) -> Any:
            return original.fromtimestamp(1e-9 * time_ns(), datetime.UTC).replace(tzinfo=None)

        @classmethod
        def today(cls) -> Any:
            return cls.now()

    Datetime.__name__ = Datetime.__qualname__ = "datetime"
    module.datetime = Datetime


def _patch_random_numbers(hooks: Hooks) -> None:
    def urandom(size: int) -> bytes:
        return hooks.randomness().system.randbytes(size)

    os.urandom = urandom
    if hasattr(os, "getrandom"):
        os.getrandom = lambda size, flags=0: urandom(size)
    identifiers: Any = uuid
    identifiers._generate_time_safe = identifiers._UuidCreate = None  # the system's: its clock, the machine's address
    identifiers.getnode = lambda: _MACHINE_ADDRESS
    module: Any = random
    module._urandom = urandom
    seed = random.Random.seed

    def seed_by_program(self: random.Random, a: Any = None, version: int = 2) -> None:
        seed(self, int.from_bytes(urandom(32)) if a is None else a, version)

    module.Random.seed = seed_by_program

    def dispatch(name: str) -> Callable[..., Any]:
        def call(*args: Any, **kwargs: Any) -> Any:
            return getattr(hooks.randomness().python, name)(*args, **kwargs)

        call.__name__ = name
        return call

    for name, function in vars(random).copy().items():
        if getattr(function, "__self__", None) is module._inst:
            setattr(module, name, dispatch(name))


def _patch_signals(hooks: Hooks) -> None:
    module: Any = signal
    real_kill = os.kill

    def set_handler(number: int, handler: Any) -> Any:
        handlers = hooks.handlers()
        before = handlers.get(number, signal.SIG_DFL)
        handlers[number] = handler
        return before

    def kill(pid: int, number: int) -> None:
        if pid == os.getpid():
            hooks.send_signal(number)
        else:
            real_kill(pid, number)

    for number in (signal.SIGINT, signal.SIGTERM):
        module.signal(number, lambda number, frame: hooks.send_signal(-number))
    module.signal = set_handler
    module.getsignal = lambda number: hooks.handlers().get(number, signal.SIG_DFL)
    module.set_wakeup_fd = lambda fd, **options: _OTHER_RECEIVER
    module.raise_signal = hooks.send_signal
    os.kill = kill
    if hasattr(signal, "pthread_sigmask"):
        module.pthread_sigmask = lambda how, mask: set()
        module.pthread_kill = lambda thread, number: hooks.send_signal(number)


def _patch_event_loops(scheduler: Scheduler) -> None:
    """Make event loops of asyncio wait for the run's time instead of for the system."""

    class Selector(selectors.DefaultSelector):
        """A selector whose waiting thread hands on."""

        _wait: Wait | None = None

        def select(self, timeout: float | None = None) -> Any:
            events = super().select(0)
            if events or (timeout is not None and timeout <= 0) or scheduler.current is None:
                return events
            wait = self._wait = Wait(scheduler.running(), "events of asyncio")
            deadline = None if timeout is None else scheduler.now_ns + max(round(1e9 * timeout), 1)
            scheduler.wait(wait, deadline)
            self._wait = None
            return super().select(0)

        def wake(self) -> None:
            """Make the thread that waits look again."""
            if self._wait is not None:
                scheduler.wake(self._wait)

    loop: Any = asyncio.selector_events.BaseSelectorEventLoop
    write = loop._write_to_self

    def write_to_self(self: Any) -> None:
        write(self)
        wake = getattr(self._selector, "wake", None)
        if wake is not None:
            wake()

    loop._write_to_self = write_to_self
    selectors.DefaultSelector = Selector  # type: ignore[misc]
