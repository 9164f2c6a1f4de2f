"""Reader of MCAP files (mcap.dev/spec), including truncated ones whose writer was killed.

A file's summary tells where its chunks are. Where it is missing, the records are walked through from the start up to
the last whole one.
"""

from __future__ import annotations

import mmap
import struct
import zlib
from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from io import BytesIO
from operator import itemgetter
from pathlib import Path
from typing import Any

from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.stream_reader import StreamReader

from daidalos.bags.errors import BagError
from daidalos.bags.mcap_writer import DISTRO_KEY, MAGIC, MESSAGE_HEADER, METADATA_KEY, METADATA_NAME
from daidalos.bags.message import BagMessage, Definition, Topic
from daidalos.bags.metadata import TopicCount
from daidalos.bags.qos import parse_profiles
from daidalos.bags.storage import StorageReader

_FOOTER_LENGTH = 29
_RECORD = struct.Struct("<BQ")
_CHUNK = struct.Struct("<QQQII")
_TIMES = struct.Struct("<QQ")
_UNCHUNKED_SIZE = 1024 * 1024
"""Size of the pieces in which messages outside of chunks are read, in bytes."""
_FAULTS = (McapError, struct.error, ValueError, LookupError, EOFError, OverflowError, MemoryError)

Entry = tuple[int, int, int, int, bytes]
"""Time of reception, the chunk's place in the file, time of sending, channel, data."""

_in_order = itemgetter(0, 1)


@dataclass(frozen=True)
class _Chunk:
    """Location of messages in the file; `channels` are those with messages in it, None if unknown."""

    start_ns: int
    end_ns: int
    offset: int
    length: int
    compression: str = ""
    size: int = 0
    crc: int = 0
    channels: frozenset[int] | None = None


class McapReader(StorageReader):
    """Reader of an MCAP file.

    Raises
    ------
    BagError
        When the file is missing, empty or no MCAP file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                self._data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except ValueError:
            raise BagError(path, "the file is empty, expected an MCAP file") from None
        except OSError as error:
            raise BagError(path, f"cannot be read: {error.strerror}") from None
        self._schemas: dict[int, Any] = {}
        self._channels: dict[int, Any] = {}
        self._counts: dict[int, int] = {}
        self._chunks: list[_Chunk] = []
        if self._data[: len(MAGIC)] != MAGIC:
            start = self._data[:8].hex(" ")
            self._data.close()
            raise BagError(path, f"not an MCAP file: it begins with {start}, expected {MAGIC.hex(' ')}")
        if not self._read_summary():
            self._walk()
        self._describe()

    def close(self) -> None:
        """Close the file."""
        self._data.close()

    def _describe(self) -> None:
        """Fill the attributes that every reader provides."""
        filled = [chunk for chunk in self._chunks if chunk.end_ns]
        self.start_ns = min((chunk.start_ns for chunk in filled), default=0)
        self.end_ns = max((chunk.end_ns for chunk in filled), default=0)
        self.topics = {}
        for number, channel in self._channels.items():
            topic = self._topic(channel)
            known = self.topics.get(topic.name)
            count = self._counts.get(number, 0) + (known.count if known else 0)
            self.topics[topic.name] = TopicCount(topic, count)
        self.ros_distro = self.ros_distro or _distro(self.metadata)

    def _topic(self, channel: Any) -> Topic:
        schema = self._schemas.get(channel.schema_id)
        text = schema.data.decode(errors="replace") if schema else ""
        try:
            qos = parse_profiles(channel.metadata.get("offered_qos_profiles", ""))
        except ValueError as error:
            raise BagError(self.path, f"topic {channel.topic}: offered_qos_profiles: {error}") from None
        return Topic(
            channel.topic,
            _full_type(schema.name) if schema else "",
            channel.message_encoding,
            qos,
            channel.metadata.get("topic_type_hash", ""),
            Definition(text, schema.encoding) if schema and text else None,
        )

    # The summary at the end.

    def _read_summary(self) -> bool:
        """Read the file's content from its summary; return False without a complete summary."""
        data = self._data
        footer = len(data) - len(MAGIC) - _FOOTER_LENGTH
        if footer < len(MAGIC) or data[-len(MAGIC) :] != MAGIC or data[footer] != Opcode.FOOTER:
            return False
        (start,) = struct.unpack_from("<Q", data, footer + 9)
        if not len(MAGIC) <= start < footer:
            return False
        statistics = None
        indexes: list[Any] = []
        try:
            for record in StreamReader(BytesIO(data[start:]), skip_magic=True).records:
                if isinstance(record, records.Schema):
                    self._schemas[record.id] = record
                elif isinstance(record, records.Channel):
                    self._channels[record.id] = record
                elif isinstance(record, records.Statistics):
                    statistics = record
                elif isinstance(record, records.ChunkIndex):
                    indexes.append(record)
                elif isinstance(record, records.MetadataIndex) and record.name == METADATA_NAME:
                    self._take_metadata(record.offset)
            complete = statistics is not None and (
                len(indexes) == statistics.chunk_count
                and len(self._channels) == statistics.channel_count
                and (bool(indexes) or not statistics.message_count)
            )
            if complete:
                self._counts = dict(statistics.channel_message_counts)  # type: ignore[union-attr]
                self._chunks = [self._indexed(index) for index in indexes]
        except _FAULTS:
            complete = False
        if not complete:
            self._schemas.clear()
            self._channels.clear()
            self._counts.clear()
            self._chunks.clear()
        return complete

    def _indexed(self, index: Any) -> _Chunk:
        """Return the chunk that an index record describes."""
        start = index.chunk_start_offset + _RECORD.size
        channels = frozenset(index.message_index_offsets) or None
        return self._chunk_at(start, channels)

    def _chunk_at(self, position: int, channels: frozenset[int] | None = None) -> _Chunk:
        """Return the chunk whose record's content starts at an offset."""
        start, end, size, crc, name = _CHUNK.unpack_from(self._data, position)
        position += _CHUNK.size
        compression = self._data[position : position + name].decode()
        (length,) = struct.unpack_from("<Q", self._data, position + name)
        return _Chunk(start, end, position + name + 8, length, compression, size, crc, channels)

    def _take_metadata(self, offset: int) -> None:
        _, length = _RECORD.unpack_from(self._data, offset)
        begin = offset + _RECORD.size
        record = records.Metadata.read(ReadDataStream(BytesIO(self._data[begin : begin + length])))
        self.metadata = record.metadata.get(METADATA_KEY, self.metadata)
        self.ros_distro = record.metadata.get(DISTRO_KEY, self.ros_distro)

    # Walking through the records.

    def _walk(self) -> None:
        """Read the file's content from the records themselves, up to the first incomplete one."""
        data, position, size = self._data, len(MAGIC), len(self._data)
        loose: _UnchunkedMessages | None = None
        ended = False
        try:
            while position + _RECORD.size <= size:
                opcode, length = _RECORD.unpack_from(data, position)
                begin = position + _RECORD.size
                if opcode == Opcode.DATA_END:
                    ended = True
                    break
                if not 0 < opcode <= Opcode.DATA_END or begin + length > size:
                    break
                if opcode == Opcode.MESSAGE:
                    loose = self._add_unchunked(loose, begin, length, position)
                elif opcode == Opcode.CHUNK:
                    self._take_chunk(self._chunk_at(begin))
                elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                    self._take_declaration(opcode, data[begin : begin + length])
                elif opcode == Opcode.METADATA:
                    self._take_metadata(position)
                position = begin + length
        except _FAULTS as error:
            self.damage = f"a record at byte {position} is damaged: {error}"
        if loose:
            self._chunks.append(loose.chunk())
        if not ended and not self.damage:
            rest = f"; {size - position} bytes behind the last whole record are lost" if position < size else ""
            self.damage = f"it was not ended{rest}"

    def _take_chunk(self, chunk: _Chunk) -> None:
        channels: set[int] = set()
        content = self._content(chunk)
        for opcode, begin, end in _records(content):
            if opcode == Opcode.MESSAGE:
                (channel,) = struct.unpack_from("<H", content, begin)
                channels.add(channel)
                self._counts[channel] = self._counts.get(channel, 0) + 1
            elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                self._take_declaration(opcode, content[begin:end])
        if channels:
            position = (chunk.start_ns, chunk.end_ns, chunk.offset, chunk.length)
            self._chunks.append(_Chunk(*position, chunk.compression, chunk.size, chunk.crc, frozenset(channels)))

    def _take_declaration(self, opcode: int, data: bytes) -> None:
        stream = ReadDataStream(BytesIO(data))
        if opcode == Opcode.SCHEMA:
            schema = records.Schema.read(stream)
            self._schemas[schema.id] = schema
        else:
            channel = records.Channel.read(stream)
            self._channels[channel.id] = channel

    def _add_unchunked(
        self, loose: _UnchunkedMessages | None, begin: int, length: int, position: int
    ) -> _UnchunkedMessages:
        """Record a message outside of chunks."""
        channel, _, log, _ = struct.unpack_from("<HIQQ", self._data, begin)
        self._counts[channel] = self._counts.get(channel, 0) + 1
        if loose and (loose.end - loose.offset > _UNCHUNKED_SIZE):
            self._chunks.append(loose.chunk())
            loose = None
        if loose is None:
            loose = _UnchunkedMessages(position, log, log)
        loose.add(log, begin + length)
        return loose

    # Messages.

    def messages(
        self, topics: Collection[str], start_ns: int, stop_ns: int, *, reverse: bool = False, by_file: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages; see `StorageReader.messages`."""
        names = {number: channel.topic for number, channel in self._channels.items() if channel.topic in topics}
        chunks = [
            chunk
            for chunk in self._chunks
            if chunk.end_ns >= start_ns
            and chunk.start_ns <= stop_ns
            and (chunk.channels is None or not chunk.channels.isdisjoint(names))
        ]
        if by_file:
            batches: Iterator[list[Entry]] = (self._entries(one, names, start_ns, stop_ns) for one in chunks)
        elif reverse:
            batches = self._backward(chunks, names, start_ns, stop_ns)
        else:
            batches = self._forward(chunks, names, start_ns, stop_ns)
        for batch in batches:
            for received, _, sent, channel, data in batch:
                yield BagMessage(names[channel], data, received, sent)

    def _forward(self, chunks: list[_Chunk], names: Collection[int], start: int, stop: int) -> Iterator[list[Entry]]:
        """Yield messages by time; messages of a chunk wait for overlapping chunks."""
        chunks.sort(key=lambda chunk: chunk.start_ns)
        waiting: list[Entry] = []
        for k, chunk in enumerate(chunks):
            waiting += self._entries(chunk, names, start, stop)
            waiting.sort(key=_in_order)
            if k + 1 < len(chunks):
                split = bisect_left(waiting, chunks[k + 1].start_ns, key=itemgetter(0))
                yield waiting[:split]
                waiting = waiting[split:]
        yield waiting

    def _backward(self, chunks: list[_Chunk], names: Collection[int], start: int, stop: int) -> Iterator[list[Entry]]:
        """Yield messages by time, newest first."""
        chunks.sort(key=lambda chunk: -chunk.end_ns)
        waiting: list[Entry] = []
        for k, chunk in enumerate(chunks):
            waiting = sorted(self._entries(chunk, names, start, stop) + waiting, key=_in_order)
            if k + 1 < len(chunks):
                split = bisect_right(waiting, chunks[k + 1].end_ns, key=itemgetter(0))
                yield waiting[split:][::-1]
                waiting = waiting[:split]
        yield waiting[::-1]

    def _entries(self, chunk: _Chunk, names: Collection[int], start: int, stop: int) -> list[Entry]:
        """Return the selected messages of a chunk in file order."""
        try:
            content = self._content(chunk)
            return _entries(content, chunk.offset, names, start, stop)
        except _FAULTS as error:
            raise BagError(self.path, f"the chunk at byte {chunk.offset} is damaged: {error}") from None

    def _content(self, chunk: _Chunk) -> bytes:
        data = self._data[chunk.offset : chunk.offset + chunk.length]
        if len(data) < chunk.length:
            raise ValueError("it is cut off")
        if chunk.compression == "zstd":
            import zstandard

            try:
                data = zstandard.ZstdDecompressor().decompress(data, max_output_size=chunk.size)
            except zstandard.ZstdError as error:
                raise ValueError(str(error)) from None
        elif chunk.compression == "lz4":
            import lz4.frame

            try:
                data = lz4.frame.decompress(data)
            except RuntimeError as error:
                raise ValueError(str(error)) from None
        elif chunk.compression:
            raise ValueError(f"its compression {chunk.compression!r} is not known")
        if chunk.crc and zlib.crc32(data) != chunk.crc:
            raise ValueError("its checksum is wrong")
        return data


@dataclass
class _UnchunkedMessages:
    """Consecutive messages outside of chunks."""

    offset: int
    start_ns: int
    end_ns: int
    end: int = 0

    def add(self, time_ns: int, end: int) -> None:
        self.start_ns, self.end_ns = min(self.start_ns, time_ns), max(self.end_ns, time_ns)
        self.end = end

    def chunk(self) -> _Chunk:
        return _Chunk(self.start_ns, self.end_ns, self.offset, self.end - self.offset)


def _entries(content: bytes, chunk: int, names: Collection[int], start: int, stop: int) -> list[Entry]:
    """Return the selected messages among the records of the chunk at an offset in the file."""
    found: list[Entry] = []
    append, unpack, header = found.append, MESSAGE_HEADER.unpack_from, MESSAGE_HEADER.size
    position, size = 0, len(content)
    while position < size:
        if content[position] == 5:  # Opcode.MESSAGE; looking the name up costs as much as the rest
            _, length, channel, _, received, sent = unpack(content, position)
            end = position + 9 + length
            if end > size:
                raise ValueError("a message is cut off")
            if channel in names and start <= received <= stop:
                append((received, chunk, sent, channel, content[position + header : end]))
            position = end
        else:
            position += 9 + _RECORD.unpack_from(content, position)[1]
    return found


def _records(content: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield opcode, start and end of every record in a chunk."""
    position = 0
    while position < len(content):
        opcode, length = _RECORD.unpack_from(content, position)
        begin = position + _RECORD.size
        position = begin + length
        if position > len(content):
            raise ValueError("a record is cut off")
        yield opcode, begin, position


def _full_type(name: str) -> str:
    """Return a type's name with the ``msg`` of ``std_msgs/msg/String``, which some writers omit."""
    parts = name.split("/")
    return "/".join((parts[0], "msg", parts[1])) if len(parts) == 2 else name


def _distro(metadata: str) -> str:
    for line in metadata.splitlines():
        key, _, value = line.strip().partition(":")
        if key == "ros_distro":
            return value.strip().strip("'\"")
    return ""
