"""Contract of the storage formats of messages."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.metadata import BagFile, TopicCount
from daidalos.common.documents import DocumentError, read_yaml

MCAP, SQLITE3 = "mcap", "sqlite3"
SUFFIXES = {MCAP: ".mcap", SQLITE3: ".db3"}
"""Names of the formats, and how files of them end."""
DEFAULT = MCAP
PROFILES = {MCAP: ("none", "fastwrite", "zstd_fast", "zstd_small"), SQLITE3: ("none", "resilient")}
"""Presets that each format's writer knows."""
FOREVER_NS = 2**63 - 1
"""Time after all others."""
ZSTD_SUFFIX = ".zstd"
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"


@dataclass(frozen=True)
class StorageOptions:
    """Options of a file to be written.

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
    """Writer of one file; not thread-safe."""

    smallest_split: int
    """Minimum size limit of files [bytes]."""

    @abstractmethod
    def add_topic(self, topic: Topic) -> None:
        """Declare a topic."""

    @abstractmethod
    def write(self, message: BagMessage) -> None:
        """Append a message of a declared topic."""

    @abstractmethod
    def flush(self) -> None:
        """Write all buffered data to the operating system; it survives the end of this process."""

    @property
    @abstractmethod
    def size(self) -> int:
        """Expected size of the file [bytes]."""

    @abstractmethod
    def close(self, metadata: str = "") -> None:
        """Complete the file; `metadata` is the text of the bag's description, stored in the file as well."""


class StorageReader(ABC):
    """Reader of one file.

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
        """Number of messages in the file."""
        return sum(one.count for one in self.topics.values())

    def as_file(self, path: str) -> BagFile:
        """Describe the file for the metadata of a bag."""
        return BagFile(path, self.start_ns, self.end_ns - self.start_ns, self.message_count)

    @abstractmethod
    def messages(
        self, topics: Collection[str], start_ns: int, stop_ns: int, *, reverse: bool = False, by_file: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages in the order of their times of reception.

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
        """Close the file."""


def settings(config: Path) -> dict[str, object]:
    """Read a YAML file with settings of a format.

    Raises
    ------
    BagError
        When it cannot be read or is no mapping.
    """
    try:
        values = read_yaml(config)
    except OSError as error:
        raise BagError(config, f"cannot be read: {' '.join(str(error).split())}") from None
    except DocumentError as error:
        raise BagError(config, f"cannot be read: {error.described}") from None
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise BagError(config, "expected a mapping of settings")
    return values
