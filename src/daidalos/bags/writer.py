"""Writer of bags: files of one storage, split by size or duration, with their description."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Self

from daidalos.bags.compression import FILE, MESSAGE, Compression, compress_file, message_compressor
from daidalos.bags.errors import BagError
from daidalos.bags.formats import open_writer
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import BagFile, BagMetadata, TopicCount, format_metadata, total, write_metadata
from daidalos.bags.storage import DEFAULT, SUFFIXES, StorageOptions, StorageWriter
from daidalos.distribution import DISTRIBUTION


@dataclass(frozen=True)
class WriterOptions:
    """Options of a bag writer.

    Attributes
    ----------
    storage_id
        ``mcap`` or ``sqlite3``.
    storage
        Settings of the storage.
    max_size, max_duration_ns
        Size [bytes] and duration [ns] that a file may have before the next one is begun; 0 for no limit.
    compression
        What is compressed.
    custom_data
        What the user notes in the description, by key.
    """

    storage_id: str = DEFAULT
    storage: StorageOptions = field(default_factory=StorageOptions)
    max_size: int = 0
    max_duration_ns: int = 0
    compression: Compression = field(default_factory=Compression)
    custom_data: dict[str, str] = field(default_factory=dict)


class BagWriter:
    """Writer of a bag; not thread-safe.

    Parameters
    ----------
    folder
        The bag; it must not be there yet.
    options
        How to write it.
    on_split
        Called with the paths of the file that was ended and of the one that was begun.

    Raises
    ------
    BagError
        When the folder is there or cannot be made, or the options contradict each other.
    """

    def __init__(
        self,
        folder: str | Path,
        options: WriterOptions | None = None,
        on_split: Callable[[Path, Path], None] | None = None,
    ) -> None:
        self.folder = Path(folder)
        self.options = options or WriterOptions()
        self.on_split = on_split
        self.ros_distro = os.environ.get("ROS_DISTRO") or DISTRIBUTION
        self.options.compression.check(self.folder)
        self._topics: dict[str, Topic] = {}
        self._counts: dict[str, int] = {}
        self._files: list[BagFile] = []
        self._paths: list[Future[Path]] = []
        self._compress = message_compressor() if self.options.compression.mode == MESSAGE else None
        self._pool = (
            ThreadPoolExecutor(self.options.compression.threads or os.cpu_count() or 1, "compress")
            if self.options.compression.mode == FILE
            else None
        )
        self._closed = False
        self._make_folder()
        self._storage = self._begin_file()

    def _make_folder(self) -> None:
        try:
            self.folder.mkdir(parents=True)
        except FileExistsError:
            raise BagError(self.folder, "already exists; a bag is not written over another") from None
        except OSError as error:
            raise BagError(self.folder, f"cannot be made: {error.strerror}") from None

    def _begin_file(self) -> StorageWriter:
        options = self.options
        suffix = SUFFIXES.get(options.storage_id, "")
        self._path = self.folder / f"{self.folder.resolve().name}_{len(self._files)}{suffix}"
        try:
            storage = open_writer(self._path, options.storage_id, options.storage, self.ros_distro)
        except BagError:
            self._remove_empty_folder()
            raise
        if 0 < options.max_size < storage.smallest_split:
            storage.close()
            self._path.unlink()
            self._remove_empty_folder()
            raise BagError(self.folder, f"files cannot be limited to {options.max_size} bytes; "
                           f"with {options.storage_id} the limit must be {storage.smallest_split} or more")  # fmt: skip
        self._start, self._end, self._count = 2**63, 0, 0
        for topic in self._topics.values():
            storage.add_topic(topic)
        return storage

    def _remove_empty_folder(self) -> None:
        if not any(self.folder.iterdir()):
            self.folder.rmdir()

    @property
    def topics(self) -> dict[str, Topic]:
        """Declared topics by name."""
        return self._topics

    @property
    def message_count(self) -> int:
        """Number of messages written."""
        return sum(self._counts.values())

    @property
    def is_file_empty(self) -> bool:
        """Whether the current file has no messages yet."""
        return self._count == 0

    @property
    def size(self) -> int:
        """Expected size of the current file [bytes]."""
        return self._storage.size

    def add_topic(self, topic: Topic) -> None:
        """Declare a topic; a topic declared before is left unchanged."""
        if topic.name in self._topics:
            return
        self._topics[topic.name] = topic
        self._counts[topic.name] = 0
        self._storage.add_topic(topic)

    def remove_topic(self, name: str) -> None:
        """Remove a topic; files started later do not declare it."""
        self._topics.pop(name, None)

    def write(self, message: BagMessage) -> None:
        """Append a message.

        Raises
        ------
        BagError
            When its topic was not declared, or the disk is full.
        """
        if message.topic not in self._topics:
            raise BagError(self.folder, f"topic '{message.topic}' has not been created yet")
        if self._compress is not None:
            message = message._replace(data=self._compress(message.data))
        received = message.received_ns
        if self._count and self._is_full(len(message.data), received):
            self.split()
        self._storage.write(message)
        self._counts[message.topic] += 1
        self._count += 1
        if received < self._start:
            self._start = received
        if received > self._end:
            self._end = received

    def _is_full(self, more: int, time_ns: int) -> bool:
        options = self.options
        if options.max_size and self._storage.size + more > options.max_size:
            return True
        return bool(options.max_duration_ns and time_ns - self._start > options.max_duration_ns)

    def flush(self) -> None:
        """Write all buffered data to the operating system; it survives the end of this process."""
        self._storage.flush()

    def split(self) -> None:
        """End the current file and start the next."""
        closed = self._end_file()
        if self._pool:
            self._paths.append(self._pool.submit(compress_file, closed))
        self._storage = self._begin_file()
        if self.on_split:
            self.on_split(closed, self._path)

    def _end_file(self) -> Path:
        start = self._start if self._count else 0
        self._files.append(BagFile(self._path.name, start, self._end - start, self._count))
        self._storage.close(format_metadata(self._metadata()))
        return self._path

    def _metadata(self) -> BagMetadata:
        compression = self.options.compression
        return total(
            self.options.storage_id,
            self._files,
            (TopicCount(topic, self._counts[name]) for name, topic in sorted(self._topics.items())),
            compression_format=compression.format if compression.mode else "",
            compression_mode=compression.mode,
            custom_data=self.options.custom_data,
            ros_distro=self.ros_distro,
        )

    def close(self) -> BagMetadata:
        """Complete the bag and return its description."""
        if not self._closed:
            self._closed = True
            last = self._end_file()
            if self._pool:
                self._pool.shutdown()
                # At the end of the interpreter the pool would take no more.
                packed = [*(path.result().name for path in self._paths), compress_file(last).name]
                self._files = [replace(file, path=name) for file, name in zip(self._files, packed, strict=True)]
            write_metadata(self.folder, self._metadata())
        return self._metadata()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()
