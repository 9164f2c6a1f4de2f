"""Periodic work on a node's clock without a thread: coroutines that await the next tick.

An action that computes something twenty times a second awaits `Cycle.next` in between. Nothing sleeps, so
goals, cancellations and sensor data are handled meanwhile, and a stepped clock steps the work.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Self

from rclpy.node import Node
from rclpy.task import Future


class Cycle:
    """Ticks at a rate for as long as its ``with`` block lasts.

    Parameters
    ----------
    node
        Whose clock and executor it uses.
    frequency
        Ticks in a second of the node's clock.
    """

    def __init__(self, node: Node, frequency: float) -> None:
        self._node = node
        self._period = 1.0 / frequency
        self._waiting: Future | None = None
        self._missed = False

    def __enter__(self) -> Self:
        self._timer = self._node.create_timer(self._period, self._tick)
        return self

    def __exit__(self, *exception: object) -> None:
        self._node.destroy_timer(self._timer)

    async def next(self) -> None:
        """Wait for the next tick; returns at once when it is already due."""
        if self._missed:
            self._missed = False
            return
        self._waiting = Future()
        await self._waiting

    def _tick(self) -> None:
        waiting, self._waiting = self._waiting, None
        if waiting is None:
            self._missed = True
        else:
            waiting.set_result(None)


async def wait_until(condition: Callable[[], bool], node: Node, frequency: float, timeout_s: float) -> bool:
    """Wait until a condition holds; return whether it did before the timeout.

    Parameters
    ----------
    condition
        Evaluated at once, then once a cycle.
    node
        Whose clock and executor are used.
    frequency
        Cycles per second of the node's clock.
    timeout_s
        How long [s] of the node's clock to wait. It counts from the first cycle at which the clock has a time: a
        simulated one is at zero until the simulator's first message.
    """
    begun_ns = 0
    with Cycle(node, frequency) as cycle:
        while not condition():
            now_ns = node.get_clock().now().nanoseconds
            begun_ns = begun_ns or now_ns
            if now_ns - begun_ns > 1e9 * timeout_s:
                return False
            await cycle.next()
    return True
