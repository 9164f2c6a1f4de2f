"""Comparison of two bags, message by message."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Collection
from dataclasses import dataclass
from itertools import zip_longest

from daidalos.bags.message import BagMessage
from daidalos.bags.reader import BagReader


@dataclass(frozen=True)
class Difference:
    """First difference of two bags.

    Attributes
    ----------
    topic : str
        Where it is.
    number : int
        Index of the message on its topic, from 0.
    what : str
        ``missing`` or ``added`` (in the second bag), ``data``, ``time`` or ``type``.
    first, second : BagMessage or None
        The messages; None where there is none.
    """

    topic: str
    number: int
    what: str
    first: BagMessage | None = None
    second: BagMessage | None = None


def differences(
    first: BagReader, second: BagReader, topics: Collection[str] | None = None, *, times: bool = True
) -> list[Difference]:
    """Return the first difference of each topic, in the order of time.

    Parameters
    ----------
    first, second : BagReader
    topics : collection of str, optional
        Those that are compared; all of both where None.
    times : bool
        Whether messages also have to have come at the same time since the start of their bag.
    """
    names = set(first.topics) | set(second.topics) if topics is None else set(topics)
    comparison = _Comparison(first, second, names, times)
    streams = [bag.messages(names & bag.topics.keys()) for bag in (first, second)]
    for pair in zip_longest(*streams):
        for side, message in enumerate(pair):
            if message is not None:
                comparison.add(side, message)
        if not comparison.open:
            break
    return comparison.result()


class _Comparison:
    """Comparison of two streams of messages, topic by topic, as they come.

    Attributes
    ----------
    open : set of str
        The topics without a difference so far.
    """

    def __init__(self, first: BagReader, second: BagReader, names: set[str], times: bool) -> None:
        kinds = [{name: topic.type for name, topic in bag.topics.items()} for bag in (first, second)]
        self._found = [
            Difference(name, 0, "type") for name in names if len({kind[name] for kind in kinds if name in kind}) > 1
        ]
        self.open = names - {one.topic for one in self._found}
        self._starts = [bag.metadata.start_ns if bag.metadata.message_count else 0 for bag in (first, second)]
        self._times = times
        self._counts: Counter[str] = Counter()
        self._ahead: dict[str, tuple[int, deque[BagMessage]]] = {}

    def add(self, side: int, message: BagMessage) -> None:
        """Compare a message of one side, 0 or 1, with that of the other, which may have come or not."""
        name = message.topic
        if name not in self.open:
            return
        ahead, waiting = self._ahead.setdefault(name, (side, deque()))
        if not waiting or ahead == side:
            waiting.append(message)
            self._ahead[name] = side, waiting
            return
        pair = (waiting.popleft(), message) if side == 1 else (message, waiting.popleft())
        what = self._difference(*pair)
        if what:
            self._report(Difference(name, self._counts[name], what, *pair))
        self._counts[name] += 1

    def result(self) -> list[Difference]:
        """Return the differences after the last message, in the order of time."""
        for name, (side, waiting) in list(self._ahead.items()):
            if waiting and side == 0:
                self._report(Difference(name, self._counts[name], "missing", first=waiting[0]))
            elif waiting:
                self._report(Difference(name, self._counts[name], "added", second=waiting[0]))
        return sorted(self._found, key=lambda one: (self.time_ns(one), one.topic))

    def time_ns(self, difference: Difference) -> int:
        """Return when a difference is, since the start of its bag [ns]."""
        pair = zip((difference.first, difference.second), self._starts, strict=True)
        return min((one.received_ns - start for one, start in pair if one is not None), default=0)

    def _report(self, difference: Difference) -> None:
        self._found.append(difference)
        self.open.discard(difference.topic)
        self._ahead.pop(difference.topic, None)

    def _difference(self, one: BagMessage, other: BagMessage) -> str:
        if one.data != other.data:
            return "data"
        late = one.received_ns - self._starts[0] != other.received_ns - self._starts[1]
        return "time" if self._times and late else ""
