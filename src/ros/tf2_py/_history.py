"""The transforms of one frame to its parent over time."""

from __future__ import annotations

from bisect import bisect_right

from ._rigid import Rigid, interpolate

Item = tuple[str, Rigid]
"""The parent frame, and the motion that takes coordinates to it."""


class History:
    """Transforms sorted by time, the oldest first, for as long as `age_ns` lasts.

    Attributes
    ----------
    stamps
        Nanoseconds.
    items
        What belongs to each stamp.
    """

    __slots__ = ("age_ns", "items", "stamps")

    def __init__(self, age_ns: int) -> None:
        self.age_ns = age_ns
        self.stamps: list[int] = []
        self.items: list[Item] = []

    def insert(self, stamp: int, item: Item) -> bool:
        """Insert a transform; return False when it is too old."""
        stamps = self.stamps
        if not stamps:
            stamps.append(stamp)
            self.items.append(item)
            return True
        latest = stamps[-1]
        oldest_allowed = latest - self.age_ns
        if stamps[0] < oldest_allowed:
            self._prune(oldest_allowed)
        if stamp > latest:
            stamps.append(stamp)
            self.items.append(item)
            return True
        if stamp < oldest_allowed:
            return False
        self._insert_between(stamp, item)
        return True

    def _prune(self, oldest_allowed: int) -> None:
        stamps = self.stamps
        count = 1
        while stamps[count] < oldest_allowed:
            count += 1
        del stamps[:count]
        del self.items[:count]

    def _insert_between(self, stamp: int, item: Item) -> None:
        """Insert behind those of the same time, unless it is one of them."""
        place = bisect_right(self.stamps, stamp)
        before = place - 1
        while before >= 0 and self.stamps[before] == stamp:
            if self.items[before] == item:
                return
            before -= 1
        self.stamps.insert(place, stamp)
        self.items.insert(place, item)

    def clear(self) -> None:
        """Remove all transforms."""
        self.stamps.clear()
        self.items.clear()

    def latest(self) -> tuple[int, str]:
        """Return the newest stamp and the parent at that time; zero and "" when there is nothing."""
        return (self.stamps[-1], self.items[-1][0]) if self.stamps else (0, "")

    def at(self, stamp: int) -> tuple[Item, Item, float] | Item | str:
        """Return the transform at a time (0: the newest), or what it lies between, or why there is none.

        Returns
        -------
        Item
            Where there is one of that very time, or the parent changed.
        (older, newer, ratio)
            For `between`.
        str
            Why there is nothing.
        """
        stamps = self.stamps
        if not stamps:
            return ""
        latest = stamps[-1]
        if stamp == latest or stamp == 0:
            return self.items[-1]
        if stamp > latest or stamp < stamps[0]:
            return self._extrapolation(stamp)
        newer = bisect_right(stamps, stamp)
        older = newer - 1
        one, start = self.items[older], stamps[older]
        if start == stamp:
            # Of several of the oldest time the first one counts, of any other time the last.
            return self.items[0] if start == stamps[0] else one
        two = self.items[newer]
        if one[0] != two[0]:
            return one
        return one, two, (stamp - start) / (stamps[newer] - start)

    def _extrapolation(self, stamp: int) -> str:
        asked, oldest, latest = display_time(stamp), self.stamps[0], self.stamps[-1]
        if len(self.stamps) == 1:
            return (
                f"Lookup would require extrapolation at time {asked}, "
                f"but only time {display_time(latest)} is in the buffer"
            )
        if stamp > latest:
            return (
                f"Lookup would require extrapolation into the future.  Requested time {asked} "
                f"but the latest data is at time {display_time(latest)}"
            )
        return (
            f"Lookup would require extrapolation into the past.  Requested time {asked} "
            f"but the earliest data is at time {display_time(oldest)}"
        )


class Fixed:
    """A transform that does not change."""

    __slots__ = ("_item",)
    stamps: tuple[int, ...] = ()

    def __init__(self) -> None:
        self._item: Item = ("", (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))

    def insert(self, stamp: int, item: Item) -> bool:
        """Replace the transform."""
        self._item = item
        return True

    def clear(self) -> None:
        """Ignore the request: a static transform outlives a jump in time."""

    def latest(self) -> tuple[int, str]:
        """Return zero, for any time, and the parent."""
        return 0, self._item[0]

    def at(self, stamp: int) -> Item:
        """Return the transform."""
        return self._item


def motion_of(found: tuple[Item, Item, float] | Item) -> Rigid:
    """Return the motion that `History.at` found."""
    if len(found) == 2:
        return found[1]
    one, two, ratio = found
    return interpolate(one[1], two[1], ratio)


def display_time(stamp: int) -> str:
    """Return nanoseconds as seconds with six decimals."""
    return f"{stamp // 1_000_000_000 + 1e-9 * (stamp % 1_000_000_000):.6f}"
