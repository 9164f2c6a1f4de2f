"""Reader of bags: description, and messages by time across all files."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack
from operator import attrgetter
from pathlib import Path
from typing import Self

from daidalos.bags.compression import FORMATS, MESSAGE, message_decompressor
from daidalos.bags.describe import describe, opened
from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import FILE_NAME, BagFile, read_metadata
from daidalos.bags.storage import FOREVER_NS, StorageReader

_OPEN_FILES = 16
"""Maximum number of open files that are not being read."""


class BagReader:
    """Reader of a bag: a folder or a single file.

    A bag whose recording was cut off has no description; it is read from the files then.

    Parameters
    ----------
    path
        The bag.
    storage_id
        ``mcap`` or ``sqlite3``; by default it is found out.
    on_file
        Called when the messages of a file are through and those of the next begin, with the two paths.

    Attributes
    ----------
    metadata : BagMetadata
        What it holds.
    notes : list of str
        What is broken in it though the rest can be read; a line each.

    Raises
    ------
    BagError
        When there is no bag, or one that cannot be read.
    """

    def __init__(
        self, path: str | Path, storage_id: str = "", on_file: Callable[[Path, Path], None] | None = None
    ) -> None:
        self.path = Path(path)
        self.on_file = on_file
        self.notes: list[str] = []
        self._readers: dict[str, tuple[StorageReader, ExitStack]] = {}
        self._users: Counter[str] = Counter()
        if not self.path.exists():
            raise BagError(self.path, "no such file or folder")
        self._folder = self.path if self.path.is_dir() else self.path.parent
        if self.path.is_dir() and (self.path / FILE_NAME).exists():
            self.metadata = read_metadata(self.path)
            self._storage_id = storage_id or self.metadata.storage_id
            self._check_files()
        else:
            self.metadata, faults = describe(self.path, storage_id)
            self._storage_id = self.metadata.storage_id
            if self.path.is_dir():
                self.notes.append(f"{self.path}: there is no {FILE_NAME}; its files were read instead")
            self.notes += faults

    def _check_files(self) -> None:
        compression = self.metadata.compression_format
        if compression and compression not in FORMATS:
            raise BagError(self.path, f"it is compressed with '{compression}'; known is: {', '.join(FORMATS)}")
        for file in self.metadata.files:
            if not (self._folder / file.path).is_file():
                raise BagError(self.path, f"its file '{file.path}' is missing")

    @property
    def topics(self) -> dict[str, Topic]:
        """Topics by name."""
        return {one.topic.name: one.topic for one in self.metadata.topics}

    @property
    def size(self) -> int:
        """Size of all files [bytes]."""
        return sum((self._folder / file.path).stat().st_size for file in self.metadata.files)

    def topics_with_definitions(self) -> dict[str, Topic]:
        """Return the topics by name, with the definitions of their types as far as the files contain them."""
        found = self.topics
        for file in self.metadata.files:
            for name, one in self._reader(file).topics.items():
                if name not in found or (found[name].definition is None and one.topic.definition):
                    found[name] = one.topic
            if all(topic.definition for topic in found.values()):
                break
        return found

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int = 0,
        stop_ns: int = FOREVER_NS,
        reverse: bool = False,
        by_file: bool = False,
    ) -> Iterator[BagMessage]:
        """Yield messages by their times of reception.

        Parameters
        ----------
        topics
            The wanted topics; all where None.
        start_ns, stop_ns
            First and last time that is wanted.
        reverse
            Give the last ones first.
        by_file
            Give them as they stand in the files.

        Raises
        ------
        BagError
            When a file is damaged; what came before has been given then.
        """
        wanted = set(self.topics if topics is None else topics)
        files = [
            file
            for file in self.metadata.files
            if file.message_count and file.start_ns <= stop_ns and file.start_ns + file.duration_ns >= start_ns
        ]
        if not by_file:
            files.sort(key=lambda file: -file.start_ns - file.duration_ns if reverse else file.start_ns)
        streams = []
        for group in _groups(files, by_file):
            parts = [self._file_messages(file, wanted, start_ns, stop_ns, reverse, by_file) for file in group]
            key = (lambda message: -message.received_ns) if reverse else attrgetter("received_ns")
            streams.append((group[-1], parts[0] if len(parts) == 1 else heapq.merge(*parts, key=key)))
        return self._chain(streams)

    def _chain(self, streams: list[tuple[BagFile, Iterator[BagMessage]]]) -> Iterator[BagMessage]:
        before: BagFile | None = None
        for file, stream in streams:
            if before is not None and self.on_file:
                self.on_file(self._folder / before.path, self._folder / file.path)
            yield from stream
            before = file

    def _file_messages(
        self, file: BagFile, wanted: set[str], start_ns: int, stop_ns: int, reverse: bool, by_file: bool
    ) -> Iterator[BagMessage]:
        reader = self._reader(file)
        self._users[file.path] += 1
        try:
            messages = reader.messages(wanted, start_ns, stop_ns, reverse=reverse, by_file=by_file)
            if self.metadata.compression_mode != MESSAGE:
                yield from messages
                return
            restore = message_decompressor(self._folder / file.path)
            for message in messages:
                yield message._replace(data=restore(message.data))
        finally:
            self._users[file.path] -= 1

    def _reader(self, file: BagFile) -> StorageReader:
        """Return the reader of a file; some stay open because seeking may return to them."""
        if file.path not in self._readers:
            idle = [path for path in self._readers if not self._users[path]]
            for path in idle[: max(len(self._readers) - _OPEN_FILES + 1, 0)]:
                self._readers.pop(path)[1].close()
            stack = ExitStack()
            reader = stack.enter_context(opened(self._folder / file.path, self._storage_id))
            self._readers[file.path] = reader, stack
        return self._readers[file.path][0]

    def close(self) -> None:
        """Close the files."""
        for _, stack in self._readers.values():
            stack.close()
        self._readers.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


def _groups(files: list[BagFile], by_file: bool) -> list[list[BagFile]]:
    """Group files with overlapping times; usually each is alone."""
    groups: list[list[BagFile]] = []
    low = high = 0
    for file in files:
        start, end = file.start_ns, file.start_ns + file.duration_ns
        if groups and not by_file and start < high and end > low:
            groups[-1].append(file)
            low, high = min(low, start), max(high, end)
        else:
            groups.append([file])
            low, high = start, end
    return groups
