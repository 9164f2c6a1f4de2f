"""Rate gates: events at a rate of their own in a loop that runs at another."""

from __future__ import annotations


class RateGate:
    """Gate that opens at a rate in a loop of arbitrary cycles; missed times are not made up for.

    Parameters
    ----------
    rate : float
        [Hz]; open in every cycle where 0 or less.
    """

    def __init__(self, rate: float) -> None:
        self._period = 1e9 / rate if rate > 0 else 0.0
        self.restart()

    def restart(self) -> None:
        """Open the gate at the next cycle, and count periods from then on."""
        self._start_ns = self._last_ns = -1
        self._count = 0

    def is_due(self, now_ns: int) -> bool:
        """Return whether the gate is open; asked once per cycle.

        Parameters
        ----------
        now_ns : int
            Time of the cycle [ns]; one before that of the last cycle restarts the gate.
        """
        if self._period == 0.0:
            return True
        if self._start_ns < 0 or now_ns < self._last_ns:
            self._start_ns, self._count = now_ns, 0
        self._last_ns = now_ns
        if now_ns < self._start_ns + round(self._count * self._period):
            return False
        self._count = int((now_ns - self._start_ns) / self._period) + 1
        return True
