"""Heads and their DMX universes: what is sent, and when."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.industry.lighting.head import Head

FRAME_S = 1.0 / 44.0
"""Least time between two changes of a universe: a DMX line carries 44 full frames a second."""
REPEAT_S = 4.0 * FRAME_S
"""Time after which levels are repeated; long enough that a change after it still keeps to 44 frames a second."""
KEEP_ALIVE_S = 0.9
"""Time after which unchanged levels are sent again; Art-Net and sACN both ask for 0.8 s to 1 s."""
REPEATS = 3
"""Frames with the same levels that follow a change, before they are sent less often, as sACN asks."""


@dataclass
class _Universe:
    """Levels of a universe, when they were sent, and when they or a head last moved."""

    data: bytearray
    heads: list[Head] = field(default_factory=list)
    sent: float = float("-inf")
    moved: float = float("-inf")
    repeats: int = REPEATS
    is_changed: bool = True

    @property
    def due(self) -> float:
        """Time of the next frame [s]."""
        if self.is_changed or any(head.is_moving for head in self.heads):
            return self.moved + FRAME_S
        return self.sent + (REPEAT_S if self.repeats > 0 else KEEP_ALIVE_S)

    def frame(self, now: float) -> bytes:
        """Move the heads on and return the levels."""
        dt = now - self.sent
        dt = dt if dt < 2.0 * FRAME_S else FRAME_S  # a movement begins with one frame
        for head in self.heads:
            if head.is_moving:
                self.moved = now
                self.is_changed |= head.step(dt)
        if self.is_changed:
            self.moved, self.repeats = now, REPEATS
        else:
            self.repeats = max(self.repeats - 1, 0)
        self.is_changed = False
        self.sent = now
        return bytes(self.data)


class Show:
    """All heads of a configuration and the frames of their universes, without a clock or a network.

    Parameters
    ----------
    heads : iterable of Head

    Raises
    ------
    UserError
        When two heads have the same name, or share channels.
    """

    def __init__(self, heads: Iterable[Head]) -> None:
        self.heads: dict[str, Head] = {}
        self._universes: dict[int, _Universe] = {}
        for head in heads:
            if head.name in self.heads:
                raise UserError(f"two heads are named '{head.name}'")
            self._refuse_overlap(head)
            universe = self._universes.setdefault(head.universe, _Universe(bytearray(512)))
            universe.heads.append(head)
            head.attach(universe.data)
            self.heads[head.name] = head

    @property
    def universes(self) -> list[int]:
        """Numbers of the universes."""
        return sorted(self._universes)

    def head(self, name: str) -> Head:
        """Return a head.

        Raises
        ------
        UserError
            When there is none of that name.
        """
        if name not in self.heads:
            raise UserError(f"there is no head '{name}'{hint(name, self.heads)}")
        return self.heads[name]

    def mark(self, head: Head) -> None:
        """Mark the channels of a head as changed, so that they are sent as soon as the frame rate allows."""
        self._universes[head.universe].is_changed = True

    def blackout(self) -> None:
        """Switch all heads dark where they are."""
        for head in self.heads.values():
            head.blackout()
            self.mark(head)

    def frames(self, now: float) -> list[tuple[int, bytes]]:
        """Return the universes, with their levels, that are due at a time [s] of a monotonic clock."""
        due = [(number, one) for number, one in self._universes.items() if one.due <= now + 1e-6]
        return [(number, one.frame(now)) for number, one in due]

    def next_due(self) -> float:
        """Return the time [s] of the next frame."""
        return min((one.due for one in self._universes.values()), default=float("inf"))

    def _refuse_overlap(self, head: Head) -> None:
        for other in self.heads.values():
            if other.universe == head.universe and other.first <= head.last and head.first <= other.last:
                raise UserError(
                    f"the heads '{other.name}' (channels {other.first} to {other.last}) and '{head.name}' "
                    f"({head.first} to {head.last}) overlap in universe {head.universe}"
                )
