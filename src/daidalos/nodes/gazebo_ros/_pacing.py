"""Simulation thread that runs at a wanted speed and processes requests between steps."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

from daidalos.samples.sensors import Sample
from daidalos.simulation import Simulation

T = TypeVar("T")
_MAX_LAG_NS = 200_000_000
"""Delay after which lost time is not made up for."""


class PacedSimulation:
    """Advances a simulation in real time, or as fast as wanted.

    Parameters
    ----------
    simulation : Simulation
        Used by the thread alone from `start` on.
    publish : callable
        Called with the time [ns] and the samples of each advance, on the thread.
    period_ns : int
        How much is simulated at once.
    real_time_factor : float
        Simulated seconds in a second; 0 means as fast as possible.
    failed : callable
        Called with the error when the simulation cannot go on.
    """

    def __init__(
        self,
        simulation: Simulation,
        publish: Callable[[int, list[Sample]], None],
        period_ns: int,
        real_time_factor: float = 1.0,
        failed: Callable[[Exception], None] = lambda error: None,
    ) -> None:
        self.simulation = simulation
        self.real_time_factor = real_time_factor
        self._publish = publish
        self._period_ns = period_ns
        self._failed = failed
        self._requests: deque[Callable[[], None]] = deque()
        self._gate = threading.Lock()  # held while nobody has anything to tell the thread
        self._gate.acquire()
        self._paused = False
        self._running = False
        self._due = 0
        self._thread = threading.Thread(target=self._run, name="simulation", daemon=True)
        self.measured_factor = 0.0

    @property
    def paused(self) -> bool:
        """Whether the simulation is paused."""
        return self._paused

    @property
    def lag_ns(self) -> int:
        """How far the simulation is behind real time [ns]; 0 where it is paused or as fast as it can."""
        late = 0 if self._paused or self.real_time_factor <= 0.0 else time.monotonic_ns() - self._due
        return max(late, 0)

    def start(self, *, paused: bool = False) -> None:
        """Start the thread."""
        self._paused = paused
        self._running = True
        self._thread.start()

    def stop(self) -> None:
        """End; waits for the step that is being made."""
        self._running = False
        self._wake()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(timeout=5.0)

    def set_paused(self, paused: bool) -> None:
        """Pause or resume."""
        self._paused = paused
        self._wake()

    def step(self, count: int) -> None:
        """Make steps between two of its own and publish what was said; meant for a time that stands still."""

        def work(simulation: Simulation) -> None:
            samples = simulation.step(count)
            self._publish(simulation.time_ns, samples)

        self.call(work)

    def replace(self, simulation: Simulation) -> None:
        """Replace the simulation; to be called from a request."""
        self.simulation = simulation

    def post(self, request: Callable[[], Any]) -> None:
        """Call a function between two steps, without waiting for it."""
        self._requests.append(request)
        self._wake()

    def call(self, request: Callable[[Simulation], T]) -> T:
        """Call a function with the simulation between two steps, and return its result.

        Raises
        ------
        Exception
            What the function raised.
        """
        done = threading.Event()
        result: list[T] = []
        problem: list[Exception] = []

        def work() -> None:
            try:
                result.append(request(self.simulation))
            except Exception as error:  # handed to the caller, whose request it was
                problem.append(error)
            finally:
                done.set()

        self.post(work)
        done.wait()
        if problem:
            raise problem[0]
        return result[0]

    def _run(self) -> None:
        self._due = time.monotonic_ns()
        mark = (self._due, self.simulation.time_ns)
        while self._wait_until(self._due):
            now = time.monotonic_ns()
            if self._paused:
                self._due = now
                continue
            if now < self._due:
                continue  # woken by a request
            try:
                samples = self.simulation.advance(self._period_ns)
            except Exception as error:  # the simulation is over, the process is not
                self._paused = True
                self._failed(error)
                continue
            self._publish(self.simulation.time_ns, samples)
            mark = self._measure(mark)
            self._due = self._next_due(self._due)

    def _wait_until(self, due: int) -> bool:
        """Sleep until the next step is due or a request comes, and do what was requested; False at the end."""
        while self._running and not self._requests:
            if self._paused:
                self._gate.acquire()
                continue
            left = due - time.monotonic_ns()
            if left <= 0 or not self._gate.acquire(timeout=left * 1e-9):
                break
        while self._requests:
            self._requests.popleft()()
        return self._running

    def _wake(self) -> None:
        """Make the thread look at what it was told."""
        with suppress(RuntimeError):  # it is about to
            self._gate.release()

    def _next_due(self, due: int) -> int:
        """Return when the next step is due so that the wanted speed is kept."""
        now = time.monotonic_ns()
        if self.real_time_factor <= 0.0:
            return now
        due += int(self._period_ns / self.real_time_factor)
        return now if due < now - _MAX_LAG_NS else due

    def _measure(self, mark: tuple[int, int]) -> tuple[int, int]:
        """Update the measured speed once a second."""
        wall, simulated = mark
        now = time.monotonic_ns()
        if self.simulation.time_ns < simulated:
            return now, self.simulation.time_ns  # time was set back
        if now - wall < 1_000_000_000:
            return mark
        self.measured_factor = (self.simulation.time_ns - simulated) / (now - wall)
        return now, self.simulation.time_ns
