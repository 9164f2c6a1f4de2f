"""Reader of sqlite3 files with rosbag2's tables, of every version since Foxy."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Definition, Topic
from daidalos.bags.metadata import TopicCount
from daidalos.bags.qos import parse_profiles
from daidalos.bags.storage import StorageReader

_BATCH = 256
_LONGEST = 100
_FAULTS = (sqlite3.Error, UnicodeDecodeError)


class SqliteReader(StorageReader):
    """Reader of an sqlite3 file.

    Raises
    ------
    BagError
        When the file is missing, empty or no bag.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.is_file():
            raise BagError(path, "cannot be read: No such file or directory")
        if not path.stat().st_size:
            raise BagError(path, "the file is empty, expected an sqlite3 file")
        self._ids: dict[int, str] = {}
        self._database = self._connect()
        try:
            self._describe()
        except (AttributeError, LookupError, TypeError, ValueError) as error:
            self.close()
            raise BagError(path, f"damaged: {_line(error)}") from None
        except BaseException:
            self.close()
            raise

    def _connect(self) -> sqlite3.Connection:
        """Open the file without changing it; in read-only folders its journal is ignored."""
        for mode in ("mode=ro", "mode=ro&immutable=1"):
            uri = f"file:{quote(str(self.path.resolve()))}?{mode}"
            try:
                database = sqlite3.connect(uri, uri=True, check_same_thread=False)
                database.execute("SELECT count(*) FROM sqlite_master").fetchone()
                return database
            except sqlite3.OperationalError:
                continue
            except _FAULTS as error:
                raise BagError(self.path, f"not an sqlite3 file: {_line(error)}") from None
        raise BagError(self.path, "cannot be opened as an sqlite3 file")

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def _describe(self) -> None:
        missing = {"topics", "messages"} - {name for (name,) in self._rows("SELECT name FROM sqlite_master")}
        if missing:
            raise BagError(self.path, f"not a bag: the database has no table '{min(missing)}'")
        definitions = self._definitions()
        counts: dict[int, int] = dict(self._rows("SELECT topic_id, count(*) FROM messages GROUP BY topic_id"))
        columns = self._columns("topics")
        self.topics = {}
        for row in self._rows(f"SELECT {', '.join(columns)} FROM topics ORDER BY id"):
            values = dict(zip(columns, row, strict=True))
            topic = self._topic(values, definitions)
            self._ids[values["id"]] = topic.name
            self.topics[topic.name] = TopicCount(topic, counts.get(values["id"], 0))
        first, last = next(self._rows("SELECT min(timestamp), max(timestamp) FROM messages"))
        self.start_ns, self.end_ns = first or 0, last or 0
        if self._columns("schema"):
            self.ros_distro = next(self._rows("SELECT ros_distro FROM schema"), ("",))[0]
        if self._columns("metadata"):
            self.metadata = next(self._rows("SELECT metadata FROM metadata ORDER BY id DESC LIMIT 1"), ("",))[0]

    def _topic(self, values: dict[str, Any], definitions: dict[str, Definition]) -> Topic:
        try:
            qos = parse_profiles(values.get("offered_qos_profiles", ""))
        except ValueError as error:
            raise BagError(self.path, f"topic {values['name']}: offered_qos_profiles: {error}") from None
        return Topic(
            values["name"],
            values["type"],
            values["serialization_format"],
            qos,
            values.get("type_description_hash", ""),
            definitions.get(values["type"]),
        )

    def _definitions(self) -> dict[str, Definition]:
        if not self._columns("message_definitions"):
            return {}
        query = "SELECT topic_type, encoded_message_definition, encoding FROM message_definitions"
        return {name: Definition(text, encoding) for name, text, encoding in self._rows(query) if text}

    def _columns(self, table: str) -> list[str]:
        return [row[1] for row in self._rows(f"PRAGMA table_info({table})")]

    def _rows(self, query: str, *values: object) -> Iterator[Any]:
        try:
            cursor = self._database.execute(query, values)
            cursor.arraysize = _BATCH
            while rows := cursor.fetchmany():
                yield from rows
        except _FAULTS as error:
            raise BagError(self.path, f"damaged: {_line(error)}") from None

    def messages(
        self, topics: Collection[str], start_ns: int, stop_ns: int, *, reverse: bool = False, by_file: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages; see `StorageReader.messages`."""
        names = {number: name for number, name in self._ids.items() if name in topics}
        which = ", ".join(map(str, names))
        direction = " DESC" if reverse else ""
        order = "id" if by_file else f"timestamp{direction}, id{direction}"
        limits = (max(start_ns, -(2**63)), min(stop_ns, 2**63 - 1))
        query = f"SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({which}) "
        for number, time, data in self._rows(f"{query} AND timestamp BETWEEN ? AND ? ORDER BY {order}", *limits):
            if data.__class__ is not bytes:
                raise BagError(self.path, f"damaged: a message on {names[number]} is not bytes")
            yield BagMessage(names[number], data, time, time)


def _line(error: Exception) -> str:
    """Return an error's message as one line; some of sqlite's messages quote whole statements."""
    return " ".join(str(error).split())[:_LONGEST]
