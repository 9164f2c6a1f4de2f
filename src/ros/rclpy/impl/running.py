"""Callback of the current thread, so that blocking calls in it do not block its executor."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import ROSInterruptException

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context
    from rclpy.impl.callback_runner import CallbackRunner
    from rclpy.task import Future


class _Thread(threading.local):
    """The executor and the entity whose callback the present thread runs, both None outside of callbacks."""

    running: tuple[CallbackRunner | None, Any] = (None, None)  # one attribute, as each access is looked up by thread


THREAD = _Thread()


class BlockedCalls:
    """The services that callbacks of an executor wait for, with the callback groups that these callbacks hold."""

    def __init__(self) -> None:
        self._calls: list[tuple[frozenset[str], CallbackGroup | None]] = []

    @contextmanager
    def waiting(self, services: Iterable[str], group: CallbackGroup | None) -> Iterator[None]:
        """Register a call that waits, and the group that cannot be free meanwhile."""
        call = (frozenset(services), group)
        self._calls.append(call)
        try:
            yield
        finally:
            self._calls.remove(call)

    def may_enter(self, entity: Any) -> bool:
        """Return whether an entity serves a call whose caller holds the entity's group and only waits for it."""
        serves = getattr(entity, "_rcl_serves", ())
        return any(
            group is entity.callback_group and not services.isdisjoint(serves) for services, group in self._calls
        )


def wait_for(future: Future, context: Context, services: Iterable[str], timeout_s: float | None) -> bool:
    """Wait for a future that a response of one of `services` finishes; False when time runs out.

    In a callback, the executor goes on with other callbacks meanwhile.

    Raises
    ------
    ROSInterruptException
        When the context is shut down.
    """
    executor, entity = THREAD.running
    if executor is not None and executor._helps:
        executor._help_until_done(future, entity, services, timeout_s)
    else:
        gate = _Gate()
        future.on_wake(gate.open)
        context.on_shutdown(gate.open)
        with nullcontext() if executor is None else executor._blocked(entity, services):
            gate.pass_through(timeout_s)
    if not future._pending_over() and not context.ok():
        raise ROSInterruptException()
    return future._pending_over()


class _Gate:
    """Closed until somebody opens it; a lock wakes who waits several times faster than ``threading.Event``."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lock.acquire()

    def open(self) -> None:
        """Open the gate, for a thread that waits or is about to."""
        with suppress(RuntimeError):  # it is open
            self._lock.release()

    def pass_through(self, timeout_s: float | None) -> None:
        """Wait until the gate is open, for at most `timeout_s` seconds."""
        self._lock.acquire(timeout=-1 if timeout_s is None or timeout_s < 0 else timeout_s)
