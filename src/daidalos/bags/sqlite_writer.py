"""Writer of sqlite3 files with rosbag2's tables (schema version 4).

The journal is written ahead and folded in at the end: a process that is killed loses at most the messages since the
last `flush`, and whoever opens the file next, real ROS 2 included, gets the rest.
"""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import VERSION
from daidalos.bags.qos import profiles_text
from daidalos.bags.storage import StorageOptions, StorageWriter, settings

_TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
    encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
    data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
_SCHEMA_VERSION = 4
_BATCH_BYTES = 1024 * 1024
_ROW_OVERHEAD = 24
_FAULTS = (sqlite3.Error, OverflowError)


def pragmas(options: StorageOptions) -> list[str]:
    """Return the statements that set up the database.

    Raises
    ------
    BagError
        When the file with settings is not understood.
    """
    found = ["PRAGMA journal_mode=WAL", f"PRAGMA synchronous={'NORMAL' if options.profile == 'resilient' else 'OFF'}"]
    if options.config is None:
        return found
    write = settings(options.config).get("write", {})
    extra = write.get("pragmas", []) if isinstance(write, dict) else None
    if not isinstance(extra, list) or not all(isinstance(one, str) for one in extra):
        raise BagError(options.config, 'expected "write" with a list "pragmas", such as ["cache_size = 2000"]')
    return [*found, *(f"PRAGMA {one.rstrip(';')}" for one in extra)]


def checkpoint_journal(path: Path) -> None:
    """Merge the journal of a killed writer into the file.

    Raises
    ------
    BagError
        When the file cannot be written.
    """
    if not path.with_name(f"{path.name}-wal").exists():
        return
    try:
        database = sqlite3.connect(path)
        try:
            database.execute("PRAGMA journal_mode=DELETE")
        finally:
            database.close()
    except sqlite3.Error as error:
        raise BagError(path, f"cannot be written: {error}") from None


class SqliteWriter(StorageWriter):
    """Writer of an sqlite3 file.

    Raises
    ------
    BagError
        When the file is there already or cannot be made.
    """

    smallest_split = 86016

    def __init__(self, path: Path, statements: list[str], ros_distro: str) -> None:
        self.path = path
        if path.exists():
            raise BagError(path, "cannot be made: File exists")
        self._topics: dict[str, int] = {}
        self._definitions: set[str] = set()
        self._rows: list[tuple[int, int, bytes]] = []
        self._pending = 0
        self._written = 0
        try:
            self._database = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
            for statement in statements:
                self._database.execute(statement)
            self._database.executescript(_TABLES)
            self._database.execute("INSERT INTO schema VALUES(?, ?)", (_SCHEMA_VERSION, ros_distro))
        except _FAULTS as error:
            raise BagError(path, f"cannot be made: {error}") from None
        self._base = path.stat().st_size

    def add_topic(self, topic: Topic) -> None:
        """Declare a topic."""
        try:
            if topic.definition and topic.type not in self._definitions:
                self._definitions.add(topic.type)
                self._database.execute(
                    "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, "
                    "type_description_hash) VALUES(?, ?, ?, ?)",
                    (topic.type, topic.definition.encoding, topic.definition.text, topic.type_hash),
                )
            row = self._database.execute(
                "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles, type_description_hash) "
                "VALUES(?, ?, ?, ?, ?)",
                (topic.name, topic.type, topic.serialization_format, profiles_text(topic.qos), topic.type_hash),
            )
        except _FAULTS as error:
            raise BagError(self.path, f"cannot be written: {error}") from None
        self._topics[topic.name] = int(row.lastrowid or 0)

    def write(self, message: BagMessage) -> None:
        """Append a message of a declared topic."""
        self._rows.append((self._topics[message.topic], message.received_ns, message.data))
        self._pending += len(message.data) + _ROW_OVERHEAD
        if self._pending >= _BATCH_BYTES:
            self.flush()

    def flush(self) -> None:
        """Commit; data written before survives the end of this process."""
        if not self._rows:
            return
        rows, self._rows = self._rows, []
        self._written += self._pending
        self._pending = 0
        try:
            self._database.execute("BEGIN")
            self._database.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", rows)
            self._database.execute("COMMIT")
        except _FAULTS as error:
            with contextlib.suppress(sqlite3.Error):
                self._database.execute("ROLLBACK")
            raise BagError(self.path, f"cannot be written: {error}") from None

    @property
    def size(self) -> int:
        """Expected size of the file [bytes]."""
        return self._base + self._written + self._pending

    def close(self, metadata: str = "") -> None:
        """Complete the file."""
        try:
            self.flush()
            if metadata:
                self._database.execute(
                    "INSERT INTO metadata(metadata_version, metadata) VALUES(?, ?)", (VERSION, metadata)
                )
            # One file is left then, which can also be read where nothing can be written.
            self._database.execute("PRAGMA journal_mode=DELETE")
        except sqlite3.ProgrammingError:
            return  # It is closed.
        except sqlite3.Error as error:
            raise BagError(self.path, f"cannot be written: {error}") from None
        finally:
            self._database.close()
