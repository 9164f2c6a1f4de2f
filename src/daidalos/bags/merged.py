"""Reader of several bags as one, with messages ordered by time."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from operator import attrgetter
from pathlib import Path
from typing import Self

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.reader import BagReader
from daidalos.bags.storage import FOREVER_NS


class MergedBags:
    """Reader of several bags as one.

    Parameters
    ----------
    bags
        Their paths and storages (empty to find out).
    on_file
        Called when the messages of a file of one of them are through and those of its next begin, with the two paths.

    Attributes
    ----------
    topics : dict
        The topics by name; one that several bags have was published as each of them tells.
    start_ns, end_ns : int
        Times of the first and of the last message.
    message_count : int
        How many messages there are.
    notes : list of str
        What is broken in them though the rest can be read; a line each.

    Raises
    ------
    BagError
        When a bag cannot be read, or a topic is of another type in another one.
    """

    def __init__(
        self, bags: Sequence[tuple[str | Path, str]], on_file: Callable[[Path, Path], None] | None = None
    ) -> None:
        with ExitStack() as stack:
            self._readers = [stack.enter_context(BagReader(path, storage, on_file)) for path, storage in bags]
            self.topics = self._joined([reader.topics for reader in self._readers])
            self._open = stack.pop_all()
        described = [reader.metadata for reader in self._readers]
        filled = [one for one in described if one.message_count]
        self.start_ns = min((one.start_ns for one in filled), default=0)
        self.end_ns = max((one.end_ns for one in filled), default=0)
        self.message_count = sum(one.message_count for one in filled)
        self.notes = [note for reader in self._readers for note in reader.notes]

    def _joined(self, found: Sequence[dict[str, Topic]]) -> dict[str, Topic]:
        joined: dict[str, Topic] = {}
        for reader, topics in zip(self._readers, found, strict=True):
            for name, topic in topics.items():
                known = joined.get(name)
                if known is None:
                    joined[name] = topic
                elif known.type != topic.type:
                    raise BagError(
                        reader.path, f"topic {name} is of type {topic.type} here and {known.type} in another"
                    )
                else:
                    joined[name] = replace(known, qos=(*known.qos, *topic.qos))
        return joined

    def topics_with_definitions(self) -> dict[str, Topic]:
        """Return the topics by name, with the definitions of their types as far as the files contain them."""
        return self._joined([reader.topics_with_definitions() for reader in self._readers])

    def messages(
        self, topics: Collection[str] | None = None, *, start_ns: int = 0, stop_ns: int = FOREVER_NS
    ) -> Iterator[BagMessage]:
        """Yield messages by their times of reception; see `BagReader.messages`."""
        streams = []
        for reader in self._readers:
            wanted = None if topics is None else [name for name in topics if name in reader.topics]
            streams.append(reader.messages(wanted, start_ns=start_ns, stop_ns=stop_ns))
        return streams[0] if len(streams) == 1 else heapq.merge(*streams, key=attrgetter("received_ns"))

    def close(self) -> None:
        """Close the files."""
        self._open.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()
