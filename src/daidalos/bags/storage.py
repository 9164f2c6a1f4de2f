"""Files that hold messages: the contract of the formats, and which format a file is of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import BagFile, TopicCount

MCAP, SQLITE3 = "mcap", "sqlite3"
SUFFIXES = {MCAP: ".mcap", SQLITE3: ".db3"}
"""Names of the formats, and how files of them end."""
DEFAULT = MCAP
PROFILES = {MCAP: ("none", "fastwrite", "zstd_fast", "zstd_small"), SQLITE3: ("none", "resilient")}
"""Presets that each format's writer knows."""
FOREVER_NS = 2**63 - 1
"""A time after all others."""
ZSTD_SUFFIX = ".zstd"
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
_ROS1_MAGIC = b"#ROSBAG"
_MAGIC = {b"\x89MCAP": MCAP, b"SQLite format 3\0": SQLITE3}


@dataclass(frozen=True)
class StorageOptions:
    """How a file is written.

    Attributes
    ----------
    profile
        One of the format's `PROFILES`.
    config
        A YAML file with settings of the format, which outweigh those of the profile.
    """

    profile: str = "none"
    config: Path | None = None


class StorageWriter(ABC):
    """Writes one file; not safe to use from several threads at once."""

    smallest_split: int
    """The least size [bytes] that files may be limited to."""

    @abstractmethod
    def add_topic(self, topic: Topic) -> None:
        """Declare a topic."""

    @abstractmethod
    def write(self, message: BagMessage) -> None:
        """Append a message of a declared topic."""

    @abstractmethod
    def flush(self) -> None:
        """Hand all that was written to the operating system: it outlives the end of this process."""

    @property
    @abstractmethod
    def size(self) -> int:
        """How large the file is about to be [bytes]."""

    @abstractmethod
    def close(self, metadata: str = "") -> None:
        """Complete the file; `metadata` is the text of the bag's description, kept in the file as well."""


class StorageReader(ABC):
    """Reads one file.

    Attributes
    ----------
    path
        What errors call the file.
    topics
        Its topics, with their numbers of messages, by name.
    start_ns, end_ns
        Times of the first and the last message; 0 where there are none.
    ros_distro
        The distribution that wrote it; empty where it does not say.
    damage
        What is broken in it though the rest can be read; empty when all is well.
    metadata
        The text of the bag's description, as far as the file holds it.
    """

    path: Path
    topics: dict[str, TopicCount]
    start_ns: int = 0
    end_ns: int = 0
    ros_distro: str = ""
    damage: str = ""
    metadata: str = ""

    @property
    def message_count(self) -> int:
        """How many messages it holds."""
        return sum(one.count for one in self.topics.values())

    def as_file(self, path: str) -> BagFile:
        """Describe the file for the metadata of a bag."""
        return BagFile(path, self.start_ns, self.end_ns - self.start_ns, self.message_count)

    @abstractmethod
    def messages(
        self, topics: Collection[str], start_ns: int, stop_ns: int, *, reverse: bool = False, by_file: bool = False
    ) -> Iterator[BagMessage]:
        """Give messages in the order of their times of reception.

        Parameters
        ----------
        topics
            Names of the wanted topics.
        start_ns, stop_ns
            First and last time that is wanted.
        reverse
            Give the last ones first.
        by_file
            Give them as they stand in the file.

        Raises
        ------
        BagError
            When the file is damaged.
        """

    @abstractmethod
    def close(self) -> None:
        """Let the file go."""


def storage_of(path: Path) -> str:
    """Return the format of a file by what it begins with, or by its name.

    Raises
    ------
    BagError
        When it is neither.
    """
    try:
        with path.open("rb") as file:
            start = file.read(16)
    except OSError as error:
        raise BagError(path, f"can not be read: {error.strerror}") from None
    if not start:
        raise BagError(path, "the file is empty, expected a bag (MCAP or sqlite3)")
    for magic, storage in _MAGIC.items():
        if start.startswith(magic):
            return storage
    name = path.name.removesuffix(ZSTD_SUFFIX) if start.startswith(ZSTD_MAGIC) else ""
    for storage, suffix in SUFFIXES.items():
        if name.endswith(suffix):
            return storage
    if start.startswith(_ROS1_MAGIC):
        way = f"'rosbags-convert --src {path} --dst {path.with_suffix('')}'"
        raise BagError(path, f"this is a bag of ROS 1; {way} makes one of ROS 2 from it")
    raise BagError(path, f"no bag: it begins with {start[:8].hex(' ')}, expected an MCAP or sqlite3 file")


def open_reader(path: Path, storage_id: str) -> StorageReader:
    """Open a file to read.

    Raises
    ------
    BagError
        When it is missing, empty or of another format.
    """
    if storage_id == MCAP:
        from daidalos.bags.mcap_reader import McapReader

        return McapReader(path)
    if storage_id == SQLITE3:
        from daidalos.bags.sqlite_reader import SqliteReader

        return SqliteReader(path)
    raise BagError(path, f"unknown storage '{storage_id}'; there are: {', '.join(SUFFIXES)}")


def open_writer(path: Path, storage_id: str, options: StorageOptions, ros_distro: str) -> StorageWriter:
    """Begin a file.

    Raises
    ------
    BagError
        When it is there already or can not be made, or the options are not understood.
    """
    if storage_id not in SUFFIXES:
        raise BagError(path, f"unknown storage '{storage_id}'; there are: {', '.join(SUFFIXES)}")
    if options.profile and options.profile not in PROFILES[storage_id]:
        known = ", ".join(PROFILES[storage_id])
        raise BagError(path, f"{storage_id} has no profile '{options.profile}'; there are: {known}")
    if storage_id == MCAP:
        from daidalos.bags.mcap_options import writer_options
        from daidalos.bags.mcap_writer import McapWriter

        return McapWriter(path, writer_options(options), ros_distro)
    from daidalos.bags.sqlite_writer import SqliteWriter, pragmas

    return SqliteWriter(path, pragmas(options), ros_distro)


def settings(config: Path) -> dict[str, object]:
    """Read a YAML file with settings of a format.

    Raises
    ------
    BagError
        When it can not be read or is no mapping.
    """
    import yaml

    try:
        values = yaml.safe_load(config.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise BagError(config, f"can not be read: {' '.join(str(error).split())}") from None
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise BagError(config, "expected a mapping of settings")
    return values
