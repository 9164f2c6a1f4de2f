"""Clock of a bag that is played: follows the steady clock at a rate, pauses and jumps."""

from __future__ import annotations


class PlaybackClock:
    """Mapping of steady time to the bag's time; both in nanoseconds.

    Parameters
    ----------
    bag_ns
        The bag's time at the beginning.
    steady_ns
        Steady time then.
    rate
        How many nanoseconds of the bag pass in one.
    paused
        Whether it stands still.
    """

    def __init__(self, bag_ns: int, steady_ns: int, rate: float = 1.0, *, paused: bool = False) -> None:
        self._bag_ns = bag_ns
        self._steady_ns = steady_ns
        self._rate = rate
        self._paused = paused

    @property
    def rate(self) -> float:
        """Seconds of the bag per second of steady time."""
        return self._rate

    @property
    def paused(self) -> bool:
        """Whether the clock is paused."""
        return self._paused

    def now(self, steady_ns: int) -> int:
        """Return the bag's time."""
        if self._paused:
            return self._bag_ns
        return self._bag_ns + round((steady_ns - self._steady_ns) * self._rate)

    def due(self, bag_ns: int) -> int | None:
        """Return the steady time at which the bag's time reaches `bag_ns`; None while paused."""
        if self._paused:
            return None
        return self._steady_ns + round((bag_ns - self._bag_ns) / self._rate)

    def jump(self, bag_ns: int, steady_ns: int) -> None:
        """Continue from another time of the bag."""
        self._bag_ns, self._steady_ns = bag_ns, steady_ns

    def set_rate(self, rate: float, steady_ns: int) -> None:
        """Set the rate from now on.

        Raises
        ------
        ValueError
            When the rate is not above 0.
        """
        if not rate > 0 or rate == float("inf"):
            raise ValueError(f"rate: expected a number above 0, found {rate}")
        self.jump(self.now(steady_ns), steady_ns)
        self._rate = rate

    def pause(self, steady_ns: int) -> None:
        """Pause the clock."""
        self.jump(self.now(steady_ns), steady_ns)
        self._paused = True

    def resume(self, steady_ns: int) -> None:
        """Resume the clock."""
        self.jump(self.now(steady_ns), steady_ns)
        self._paused = False
