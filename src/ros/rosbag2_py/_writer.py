"""Writing bags one message after the other."""

from __future__ import annotations

from typing import Any
from weakref import finalize

from daidalos.bags.cache import SnapshotBuffer
from daidalos.bags.compression import FORMATS, Compression
from daidalos.bags.message import BagMessage
from daidalos.bags.storage import SUFFIXES
from daidalos.bags.writer import BagWriter
from rosbag2_py._compression_options import CompressionOptions
from rosbag2_py._message_definitions import definition_of
from rosbag2_py._metadata import TopicMetadata
from rosbag2_py._storage import ConverterOptions, StorageOptions


class SequentialWriter:
    """Writer of a bag; methods raise RuntimeError while none is open, and when it cannot be written."""

    _compression = Compression()

    def __init__(self) -> None:
        self._bag: BagWriter | None = None
        self._snapshot: SnapshotBuffer | None = None
        self._completion: finalize[[], SequentialWriter] | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions) -> None:
        """Open a bag; raise RuntimeError where the folder exists already."""
        converter_options.check()
        if self._bag is not None:
            raise RuntimeError("A bag is open already. Call close() before opening another.")
        if storage_options.snapshot_mode and storage_options.max_cache_size == 0:
            raise RuntimeError("Max cache size must be greater than 0 when snapshot mode is enabled")
        self._bag = BagWriter(storage_options.uri, storage_options.writer_options(self._compression))
        # Programs written for ROS 2 let the object go, or simply end, to complete the bag.
        self._completion = finalize(self, self._bag.close)
        if storage_options.snapshot_mode:
            self._snapshot = SnapshotBuffer(self._bag, storage_options.max_cache_size)

    def close(self) -> None:
        """Complete the bag."""
        self._bag = self._snapshot = None
        if self._completion is not None:
            self._completion()

    def _opened(self) -> BagWriter:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._bag

    def create_topic(self, topic: TopicMetadata) -> None:
        """Declare a topic; it gets the definition of its type where an installed package has it."""
        self._opened().add_topic(topic.topic(definition_of(topic.type)))

    def remove_topic(self, topic: TopicMetadata) -> None:
        """Remove a topic."""
        self._opened().remove_topic(topic.name)

    def write(self, topic_name: str, message: bytes, timestamp: int, send_timestamp: int | None = None) -> None:
        """Write a serialized message with the times [ns] when it was received and sent."""
        bag = self._opened()
        record = BagMessage(
            topic_name, bytes(message), timestamp, timestamp if send_timestamp is None else send_timestamp
        )
        if self._snapshot is not None:
            if topic_name not in bag.topics:
                raise RuntimeError(f"Topic '{topic_name}' has not been created yet. Call create_topic() first.")
            self._snapshot.write(record)
        else:
            bag.write(record)

    def take_snapshot(self) -> bool:
        """Write what was kept in snapshot mode; False where there is nothing."""
        self._opened()
        return self._snapshot.take() if self._snapshot is not None else False

    def split_bagfile(self) -> None:
        """Start the next file."""
        self._opened().split()


class SequentialCompressionWriter(SequentialWriter):
    """Writer of a compressed bag."""

    def __init__(self, compression_options: CompressionOptions | None = None, **options: Any) -> None:
        super().__init__()
        self._compression = (compression_options or CompressionOptions(**options)).compression()


def get_registered_writers() -> set[str]:
    """Return the storages that can be written."""
    return set(SUFFIXES)


def get_registered_compressors() -> set[str]:
    """Return the compressions."""
    return set(FORMATS)


def get_registered_serializers() -> set[str]:
    """Return the converters of serialization formats."""
    return {"cdr_converter"}
