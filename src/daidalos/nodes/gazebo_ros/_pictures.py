"""Distribution of the time that a simulation in real time has for the pictures of its cameras."""

from __future__ import annotations

from collections.abc import Callable

MAX_LAG_NS = 50_000_000
"""Delay of the simulation from which pictures are dropped, so that physics and all other sensors keep their time."""

_FORGET_NS = 1_000_000_000
"""Time after which a camera that no longer asks is forgotten."""


class PictureBudget:
    """Choice of the pictures that are drawn while a simulation is late: cameras take turns, the longest waiting first.

    Parameters
    ----------
    lag_ns : callable
        Returns how far the simulation is behind the time that it should have reached [ns].
    """

    def __init__(self, lag_ns: Callable[[], int]) -> None:
        self._lag_ns = lag_ns
        self._waiting: dict[str, tuple[int, int]] = {}

    def allows(self, camera: str, now_ns: int) -> bool:
        """Return whether a camera's picture is drawn at a simulated time [ns]."""
        self._waiting = {name: times for name, times in self._waiting.items() if 0 <= now_ns - times[1] <= _FORGET_NS}
        since = self._waiting.get(camera, (now_ns, now_ns))[0]
        first = min((begun for begun, _ in self._waiting.values()), default=since)
        if since <= first and self._lag_ns() <= MAX_LAG_NS:
            self._waiting.pop(camera, None)
            return True
        self._waiting[camera] = (since, now_ns)
        return False
