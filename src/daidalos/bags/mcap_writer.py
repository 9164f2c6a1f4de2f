"""Writer of MCAP files (mcap.dev/spec) with the profile ``ros2``.

Messages are gathered in chunks; a chunk goes to the file in one piece, so that a process that is killed leaves a
file that is whole up to its last chunk. The records come from the library `mcap`; its writer gives no say over when
a chunk ends nor how hard it is compressed, which is why chunks are put together here.
"""

from __future__ import annotations

import struct
import sys
import zlib
from array import array
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcap import records
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode

from daidalos.bags.errors import BagError
from daidalos.bags.mcap_options import LZ4_LEVELS, ZSTD_LEVELS, McapOptions
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.qos import profiles_text
from daidalos.bags.storage import StorageWriter

MAGIC = b"\x89MCAP0\r\n"
METADATA_NAME = "rosbag2"
METADATA_KEY = "serialized_metadata"
DISTRO_KEY = "ROS_DISTRO"
MESSAGE_HEADER = struct.Struct("<BQHIQQ")
"""Opcode, length, channel, sequence number, log time, publish time."""
_RECORD_HEADER = struct.Struct("<BQ")
_CHUNK_HEADER = struct.Struct("<QQQII")
"""First and last time, size and checksum before compression, length of the compression's name."""
_LENGTH_BEFORE_DATA = 22


class McapWriter(StorageWriter):
    """Writer of an MCAP file.

    Raises
    ------
    BagError
        When the file is there already or cannot be made.
    """

    smallest_split = 1024

    def __init__(self, path: Path, options: McapOptions, ros_distro: str) -> None:
        self.path = path
        self._options = options
        try:
            self._file = path.open("xb", buffering=0)
        except OSError as error:
            raise BagError(path, f"cannot be made: {error.strerror}") from None
        self._position = 0
        self._data_crc = 0
        self._channels: dict[str, int] = {}
        self._counts: list[int] = []
        self._channel_records: list[records.Channel] = []
        self._schema_records: dict[tuple[str, bytes], records.Schema] = {}
        self._chunk_indexes: list[records.ChunkIndex] = []
        self._metadata_indexes: list[records.MetadataIndex] = []
        self._start, self._end = 2**64 - 1, 0
        self._compress = _compressor(options)
        self._parts: list[bytes] = []
        self._length = 0
        self._index: dict[int, array[int]] = {}
        self._chunk_start, self._chunk_end = 2**64 - 1, 0
        from daidalos import __version__

        self._put(MAGIC)
        self._put(_bytes(records.Header(profile="ros2", library=f"daidalos {__version__}")))
        self._put_metadata({DISTRO_KEY: ros_distro})

    def add_topic(self, topic: Topic) -> None:
        """Declare a topic."""
        text = topic.definition.text.encode() if topic.definition else b""
        encoding = topic.definition.encoding if topic.definition else ""
        schema = self._schema_records.get((topic.type, text))
        if schema is None:
            schema = records.Schema(id=len(self._schema_records) + 1, data=text, encoding=encoding, name=topic.type)
            self._schema_records[topic.type, text] = schema
            self._append_record(_bytes(schema))
        channel = records.Channel(
            id=len(self._channel_records) + 1,
            topic=topic.name,
            message_encoding=topic.serialization_format,
            metadata={"offered_qos_profiles": profiles_text(topic.qos), "topic_type_hash": topic.type_hash},
            schema_id=schema.id,
        )
        self._channel_records.append(channel)
        self._channels[topic.name] = channel.id
        self._counts.append(0)
        self._append_record(_bytes(channel))

    def write(self, message: BagMessage) -> None:
        """Append a message of a declared topic."""
        topic, data, received, sent = message
        channel = self._channels[topic]
        self._counts[channel - 1] += 1
        index = self._index.get(channel)
        if index is None:
            index = self._index[channel] = array("Q")
        index.append(received)
        index.append(self._length)
        if received < self._chunk_start:
            self._chunk_start = received
        if received > self._chunk_end:
            self._chunk_end = received
        size = len(data)
        self._parts.append(MESSAGE_HEADER.pack(Opcode.MESSAGE, size + _LENGTH_BEFORE_DATA, channel, 0, received, sent))
        self._parts.append(data)
        self._length += size + MESSAGE_HEADER.size
        if self._length >= self._options.chunk_size:
            self.flush()

    @property
    def size(self) -> int:
        """Expected size of the file [bytes]."""
        return self._position + self._length

    def flush(self) -> None:
        """End the chunk; data written before survives the end of this process."""
        if not self._parts:
            return
        parts, length, index = self._parts, self._length, self._index
        start, end = self._chunk_start, self._chunk_end
        self._begin_chunk()
        data = b"".join(parts)
        if index:
            self._start, self._end = min(self._start, start), max(self._end, end)
        if not self._options.chunking:
            self._put(data)
            return
        # A chunk without messages, such as one that only declares topics, has no times.
        start, end = (start, end) if index else (0, 0)
        self._put_chunk(data, length, index, start, end)

    def _begin_chunk(self) -> None:
        self._parts = []
        self._length = 0
        self._index = {}
        self._chunk_start, self._chunk_end = 2**64 - 1, 0

    def _append_record(self, record: bytes) -> None:
        self._parts.append(record)
        self._length += len(record)

    def _put_chunk(self, data: bytes, length: int, index: dict[int, array[int]], start: int, end: int) -> None:
        offset = self._position
        crc = zlib.crc32(data) if self._options.chunk_crc else 0
        compression, packed = self._options.compression, data
        if compression:
            packed = self._compress(data)
            if len(packed) >= length and not self._options.force_compression:
                compression, packed = "", data
        # Put together here: the library's record would copy the data four times.
        name = compression.encode()
        length_of_record = _CHUNK_HEADER.size + len(name) + 8 + len(packed)
        record = _RECORD_HEADER.pack(Opcode.CHUNK, length_of_record)
        record += _CHUNK_HEADER.pack(start, end, length, crc, len(name)) + name + struct.pack("<Q", len(packed))
        indexes_at = offset + len(record) + len(packed)
        offsets: dict[int, int] = {}
        indexes = bytearray()
        if self._options.message_index:
            for channel, entries in index.items():
                offsets[channel] = indexes_at + len(indexes)
                indexes += _message_index(channel, entries)
        for part in (record, packed, indexes):
            self._put(part)
        self._chunk_indexes.append(
            records.ChunkIndex(
                chunk_length=len(record) + len(packed),
                chunk_start_offset=offset,
                compression=compression,
                compressed_size=len(packed),
                message_end_time=end,
                message_index_length=len(indexes),
                message_index_offsets=offsets,
                message_start_time=start,
                uncompressed_size=length,
            )
        )

    def _put(self, data: bytes | bytearray, *, in_data: bool = True) -> None:
        """Write bytes to the operating system."""
        if in_data and self._options.data_crc:
            self._data_crc = zlib.crc32(data, self._data_crc)
        try:
            view = memoryview(data)
            while len(view):
                view = view[self._file.write(view) :]
        except OSError as error:
            raise BagError(self.path, f"cannot be written: {error.strerror}") from None
        self._position += len(data)

    def close(self, metadata: str = "") -> None:
        """Complete the file with its summary."""
        if self._file.closed:
            return
        try:
            self.flush()
            if metadata:
                self._put_metadata({METADATA_KEY: metadata})
            self._put(_bytes(records.DataEnd(self._data_crc)), in_data=False)
            self._put(self._summary(), in_data=False)
            self._put(MAGIC, in_data=False)
        finally:
            self._file.close()

    def _put_metadata(self, values: dict[str, str]) -> None:
        record = _bytes(records.Metadata(name=METADATA_NAME, metadata=values))
        if self._options.metadata_index:
            self._metadata_indexes.append(
                records.MetadataIndex(offset=self._position, length=len(record), name=METADATA_NAME)
            )
        self._put(record)

    def _summary(self) -> bytes:
        """Return the summary section and the footer."""
        options, begin = self._options, self._position
        groups: list[tuple[int, list[Any]]] = []
        if options.summary:
            groups = [
                (Opcode.SCHEMA, list(self._schema_records.values()) if options.repeated_schemas else []),
                (Opcode.CHANNEL, self._channel_records if options.repeated_channels else []),
                (Opcode.STATISTICS, [self._statistics()] if options.statistics else []),
                (Opcode.CHUNK_INDEX, self._chunk_indexes if options.chunk_index else []),
                (Opcode.METADATA_INDEX, self._metadata_indexes),
            ]
        builder = RecordBuilder()
        offsets = []
        for opcode, members in groups:
            start = builder.count
            for member in members:
                member.write(builder)
            if members:
                length = builder.count - start
                offsets.append(
                    records.SummaryOffset(group_opcode=opcode, group_start=begin + start, group_length=length)
                )
        offset_start = begin + builder.count if offsets and options.summary_offsets else 0
        for offset in offsets if offset_start else ():
            offset.write(builder)
        summary: bytes = builder.end()
        footer_start = struct.pack("<BQQQ", Opcode.FOOTER, 20, begin if summary else 0, offset_start)
        crc = zlib.crc32(summary + footer_start) if options.summary_crc else 0
        return summary + footer_start + struct.pack("<I", crc)

    def _statistics(self) -> records.Statistics:
        total = sum(self._counts)
        return records.Statistics(
            attachment_count=0,
            channel_count=len(self._channel_records),
            channel_message_counts={k + 1: count for k, count in enumerate(self._counts) if count},
            chunk_count=len(self._chunk_indexes),
            message_count=total,
            message_end_time=self._end,
            message_start_time=self._start if total else 0,
            metadata_count=len(self._metadata_indexes),
            schema_count=len(self._schema_records),
        )


def _bytes(record: Any) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    data: bytes = builder.end()
    return data


def _message_index(channel: int, entries: array[int]) -> bytes:
    if sys.byteorder == "big":
        entries.byteswap()
    data = entries.tobytes()
    return struct.pack("<BQHI", Opcode.MESSAGE_INDEX, len(data) + 6, channel, len(data)) + data


def _compressor(options: McapOptions) -> Callable[[bytes], bytes]:
    if options.compression == "zstd":
        import zstandard

        return zstandard.ZstdCompressor(level=ZSTD_LEVELS[options.level]).compress
    if options.compression == "lz4":
        import lz4.frame

        level = LZ4_LEVELS[options.level]
        return lambda data: bytes(lz4.frame.compress(data, compression_level=level))
    return bytes
