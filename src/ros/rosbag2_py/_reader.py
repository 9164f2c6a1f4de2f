"""Reading bags one message after the other."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from daidalos.bags.message import BagMessage
from daidalos.bags.reader import BagReader
from daidalos.bags.storage import FOREVER_NS, SUFFIXES
from rosbag2_py._metadata import BagMetadata, TopicMetadata, of_bag
from rosbag2_py._storage import (
    ConverterOptions,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
)


class SequentialReader:
    """Reader of a bag's messages by time, one after the other; methods raise RuntimeError while no bag is open."""

    def __init__(self) -> None:
        self._bag: BagReader | None = None
        self._filter = StorageFilter()
        self._order = ReadOrder()
        self._position: int | None = None
        self._read_at_position: list[BagMessage] = []
        self._limits = (0, FOREVER_NS)
        self._messages: Iterator[BagMessage] = iter(())
        self._next: BagMessage | None = None
        self._is_ahead = False

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions) -> None:
        """Open a bag; RuntimeError when it cannot be read."""
        converter_options.check()
        self.close()
        self._bag = BagReader(storage_options.uri, storage_options.storage_id)
        start, end = storage_options.start_time_ns, storage_options.end_time_ns
        self._limits = (max(start, 0), end if end >= 0 else FOREVER_NS)
        self._position = None
        self._read_at_position = []
        self._begin()

    def open_uri(self, uri: str) -> None:
        """Open a bag of whatever storage."""
        self.open(StorageOptions(uri), ConverterOptions())

    def close(self) -> None:
        """Close the bag."""
        if self._bag is not None:
            self._messages = iter(())
            self._is_ahead, self._next = False, None
            self._bag.close()
            self._bag = None

    def _opened(self) -> BagReader:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._bag

    def _begin(self) -> None:
        """Read on from the present position."""
        bag = self._opened()
        wanted = self._wanted()
        start, stop = self._limits
        reverse = self._order.reverse
        if self._position is not None:
            start, stop = (start, min(stop, self._position)) if reverse else (max(start, self._position), stop)
        by_file = self._order.sort_by == ReadOrderSortBy.File
        self._messages = bag.messages(wanted, start_ns=start, stop_ns=stop, reverse=reverse, by_file=by_file)
        self._is_ahead, self._next = False, None

    def _wanted(self) -> list[str]:
        selection = self._filter.selection()
        selection.check()
        return [name for name, topic in self._opened().topics.items() if selection.wants(name, topic.type)]

    def _ahead(self) -> BagMessage | None:
        """Return the next message without going on; None at the end."""
        if not self._is_ahead:
            self._opened()
            self._next = next(self._messages, None)
            self._is_ahead = True
        return self._next

    def has_next(self) -> bool:
        """Return whether there is another message."""
        self._opened()
        return self._ahead() is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return the next message: its topic, its serialized data and when it was received [ns]."""
        message = self._ahead()
        if message is None:
            raise RuntimeError("Bag is at end. No next message.")
        self._is_ahead = False
        if message.received_ns != self._position:
            self._read_at_position = []
        self._position = message.received_ns
        self._read_at_position.append(message)
        return message.topic, message.data, message.received_ns

    def get_metadata(self) -> BagMetadata:
        """Return what the bag holds."""
        bag = self._opened()
        return of_bag(bag.metadata, bag.size)

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """Return the bag's topics."""
        return [TopicMetadata.of(topic, k) for k, topic in enumerate(self._opened().topics.values(), 1)]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the definitions of the bag's types, as far as it has them."""
        topics = self._opened().topics_with_definitions().values()
        found = {
            topic.type: MessageDefinition(topic.type, topic.definition.encoding, topic.definition.text, topic.type_hash)
            for topic in topics
            if topic.definition
        }
        return list(found.values())

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Read only some topics from now on."""
        self._filter = storage_filter
        self._go_on()

    def reset_filter(self) -> None:
        """Read all topics from now on."""
        self.set_filter(StorageFilter())

    def _go_on(self) -> None:
        """Read on behind what was read last, with what has the same time and comes after it in the whole bag."""
        rest: list[BagMessage] = []
        if self._position is not None:
            rest = self._rest_at_position()
            self._position += -1 if self._order.reverse else 1
        self._begin()
        self._messages = itertools.chain(rest, self._messages)

    def _rest_at_position(self) -> list[BagMessage]:
        if not self._read_at_position or self._order.sort_by == ReadOrderSortBy.File:
            return []
        time, last = self._position or 0, self._read_at_position[-1]
        # Bounded on one side only: files are left out by the times in the metadata, which may be wrong.
        start, stop = (0, time) if self._order.reverse else (time, FOREVER_NS)
        following = self._opened().messages(start_ns=start, stop_ns=stop, reverse=self._order.reverse)
        messages = itertools.takewhile(lambda message: message.received_ns == time, following)
        repetitions = self._read_at_position.count(last)
        for message in messages:
            repetitions -= message == last
            if repetitions == 0:
                break
        wanted = self._wanted()
        return [message for message in messages if message.topic in wanted]

    def seek(self, timestamp: int) -> None:
        """Continue at the first message at or after a time [ns]; in reverse order, at the last at or before it."""
        self._opened()
        self._position = timestamp
        self._read_at_position = []
        self._begin()

    def set_read_order(self, read_order: ReadOrder) -> bool:
        """Choose the order from now on; False where there is no such order."""
        if read_order.sort_by == ReadOrderSortBy.PublishedTimestamp:
            return False
        self._order = read_order
        if self._bag is not None:
            self._begin()
        return True


class SequentialCompressionReader(SequentialReader):
    """Reader of a bag, compressed or not."""


def get_registered_readers() -> set[str]:
    """Return the storages that can be read."""
    return set(SUFFIXES)
