"""How old a transform is: by its stamp, and by how long it has not been renewed."""

from __future__ import annotations

from dataclasses import dataclass, replace

WATCHED_S = 0.5
"""Longest time [s] between two looks from which the period of the transform is learned."""
FADING = 0.9
"""Share of a period that counts once another stamp was seen."""


@dataclass(frozen=True)
class _Sight:
    stamp_s: float
    """Stamp of the transform [s]."""
    since_s: float
    """When this stamp was seen first [s]."""
    looked_s: float
    """When it was looked at last [s]."""
    period_s: float = WATCHED_S
    """Longest recent time [s] between two stamps; a long one before any was seen."""


class TransformAges:
    """Ages of transforms that are looked at again and again.

    Localization stamps its transform in the future, AMCL a second by default, so that it is not taken for old between
    two scans. When it ends, the stamp alone would show that a second too late.
    """

    def __init__(self) -> None:
        self._seen: dict[str, _Sight] = {}

    def age(self, frame: str, stamp_s: float, now_s: float) -> float:
        """Return the age [s] of a transform.

        Parameters
        ----------
        frame : str
            The frame whose transform it is.
        stamp_s : float
            Stamp of the latest transform [s].
        now_s : float
            Present time [s].

        Returns
        -------
        float
            The larger one of the age of the stamp and of the time that the transform has been overdue.
        """
        last = self._seen.get(frame)
        if last is None or now_s < last.looked_s or stamp_s < last.stamp_s:
            last = _Sight(stamp_s, now_s, now_s)
        elif stamp_s == last.stamp_s:
            last = replace(last, looked_s=now_s)
        else:
            is_watched = now_s - last.looked_s <= WATCHED_S
            period_s = max(FADING * last.period_s, now_s - last.since_s) if is_watched else last.period_s
            last = _Sight(stamp_s, now_s, now_s, period_s)
        self._seen[frame] = last
        return max(now_s - stamp_s, now_s - last.since_s - last.period_s)
