"""When something is due that happens at a rate of its own, in a loop that runs at another."""

from __future__ import annotations


class Pulse:
    """Tells when something is due that happens at a rate, however the cycles fall.

    Parameters
    ----------
    rate : float
        [Hz]; every time where 0 or less.
    """

    def __init__(self, rate: float) -> None:
        self._period = 1e9 / rate if rate > 0 else 0.0
        self.restart()

    def restart(self) -> None:
        """Be due when next asked, and count from then on."""
        self._start_ns: int | None = None
        self._count = 0

    def due(self, now_ns: int) -> bool:
        """Tell whether it is due now."""
        if self._period == 0.0:
            return True
        if self._start_ns is None or now_ns < self._start_ns:
            self._start_ns, self._count = now_ns, 1
            return True
        if now_ns < self._start_ns + round(self._count * self._period):
            return False
        self._count = int((now_ns - self._start_ns) / self._period) + 1
        return True
