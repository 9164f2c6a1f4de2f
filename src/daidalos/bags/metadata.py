"""Description of a bag, `metadata.yaml`: its files, topics, counts and times."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from daidalos.bags.errors import BagError
from daidalos.bags.message import Topic
from daidalos.bags.qos import parse_profiles, profile_values
from daidalos.common.documents import DocumentError, parse_yaml

VERSION = 9
"""Version that is written, that of ROS 2 Jazzy; older ones can be read."""
FILE_NAME = "metadata.yaml"
_ROOT = "rosbag2_bagfile_information"


@dataclass(frozen=True)
class BagFile:
    """File of a bag; `path` is relative to the bag."""

    path: str
    start_ns: int
    duration_ns: int
    message_count: int


@dataclass(frozen=True)
class TopicCount:
    """Topic and the number of its messages."""

    topic: Topic
    count: int


@dataclass(frozen=True)
class BagMetadata:
    """Content of a bag; times are in nanoseconds.

    Attributes
    ----------
    storage_id
        ``mcap`` or ``sqlite3``.
    compression_format, compression_mode
        ``zstd`` and ``FILE`` or ``MESSAGE``; empty where nothing is compressed.
    custom_data
        What the user noted, by key.
    """

    storage_id: str
    start_ns: int = 0
    duration_ns: int = 0
    message_count: int = 0
    topics: tuple[TopicCount, ...] = ()
    files: tuple[BagFile, ...] = ()
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""
    version: int = VERSION

    @property
    def end_ns(self) -> int:
        """Time of the last message."""
        return self.start_ns + self.duration_ns


def total(storage_id: str, files: Iterable[BagFile], topics: Iterable[TopicCount], **others: Any) -> BagMetadata:
    """Return the description of a bag with these files."""
    files = tuple(files)
    filled = [file for file in files if file.message_count]
    start = min((file.start_ns for file in filled), default=0)
    end = max((file.start_ns + file.duration_ns for file in filled), default=0)
    count = sum(file.message_count for file in files)
    return BagMetadata(storage_id, start, end - start, count, tuple(topics), files, **others)


def read_metadata(folder: str | Path) -> BagMetadata:
    """Read the description of a bag.

    Raises
    ------
    BagError
        When the folder has none, or one that is not understood.
    """
    path = Path(folder) / FILE_NAME
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise BagError(folder, f"Could not find metadata for bag: there is no {FILE_NAME}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise BagError(path, f"cannot be read: {error}") from None
    return parse_metadata(text, path)


def write_metadata(folder: str | Path, metadata: BagMetadata) -> None:
    """Write the description of a bag atomically.

    Raises
    ------
    BagError
        When it cannot be written.
    """
    path = Path(folder) / FILE_NAME
    draft = path.with_suffix(".yaml.new")
    try:
        draft.write_text(format_metadata(metadata), encoding="utf-8")
        os.replace(draft, path)
    except OSError as error:
        raise BagError(path, f"cannot be written: {error.strerror}") from None


def format_metadata(metadata: BagMetadata) -> str:
    """Return the description as the text of a `metadata.yaml`."""
    import yaml

    values = {
        "version": metadata.version,
        "storage_identifier": metadata.storage_id,
        "duration": {"nanoseconds": metadata.duration_ns},
        "starting_time": {"nanoseconds_since_epoch": metadata.start_ns},
        "message_count": metadata.message_count,
        "topics_with_message_count": [_topic_values(one) for one in metadata.topics],
        "compression_format": metadata.compression_format,
        "compression_mode": metadata.compression_mode,
        "relative_file_paths": [file.path for file in metadata.files],
        "files": [_file_values(file) for file in metadata.files],
        "custom_data": metadata.custom_data or None,
        "ros_distro": metadata.ros_distro,
    }
    return yaml.safe_dump({_ROOT: values}, sort_keys=False, allow_unicode=True)


def _topic_values(one: TopicCount) -> dict[str, Any]:
    topic = one.topic
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type,
            "serialization_format": topic.serialization_format,
            "offered_qos_profiles": profile_values(topic.qos),
            "type_description_hash": topic.type_hash,
        },
        "message_count": one.count,
    }


def _file_values(file: BagFile) -> dict[str, Any]:
    return {
        "path": file.path,
        "starting_time": {"nanoseconds_since_epoch": file.start_ns},
        "duration": {"nanoseconds": file.duration_ns},
        "message_count": file.message_count,
    }


def parse_metadata(text: str, path: str | Path) -> BagMetadata:
    """Parse a description; `path` is named in errors.

    Raises
    ------
    BagError
        When it is no description of a bag, or one of a version that is not known.
    """
    try:
        document = parse_yaml(text)
    except DocumentError as error:
        raise BagError(path, f"not valid YAML: {error.described}") from None
    reader = _Values(path, document).part(_ROOT)
    version = reader.get("version", int)
    if not 1 <= version <= VERSION:
        raise BagError(path, f"its version is {version}; versions 1 to {VERSION} are known")
    paths = [str(one) for one in reader.get("relative_file_paths", list)]
    start = reader.part("starting_time").get("nanoseconds_since_epoch", int)
    duration = reader.part("duration").get("nanoseconds", int)
    count = reader.get("message_count", int)
    custom = reader.get("custom_data", dict, {}) or {}
    return BagMetadata(
        reader.get("storage_identifier", str),
        start,
        duration,
        count,
        tuple(_topic(one) for one in reader.parts("topics_with_message_count")),
        _files(reader, paths, start, duration, count),
        reader.get("compression_format", str, "") or "",
        (reader.get("compression_mode", str, "") or "").upper().replace("NONE", ""),
        {str(key): str(value) for key, value in custom.items()},
        reader.get("ros_distro", str, "") or "",
        version,
    )


def _topic(values: _Values) -> TopicCount:
    topic = values.part("topic_metadata")
    try:
        profiles = parse_profiles(topic.get("offered_qos_profiles", object, None))
    except ValueError as error:
        raise BagError(values.path, f"{topic.where}.offered_qos_profiles: {error}") from None
    return TopicCount(
        Topic(
            topic.get("name", str),
            topic.get("type", str),
            topic.get("serialization_format", str, "") or "",
            profiles,
            topic.get("type_description_hash", str, "") or "",
        ),
        values.get("message_count", int),
    )


def _files(reader: _Values, paths: list[str], start: int, duration: int, count: int) -> tuple[BagFile, ...]:
    """Return the files; old versions have no times per file, so each covers the whole duration."""
    described = {
        one.get("path", str): BagFile(
            one.get("path", str),
            one.part("starting_time").get("nanoseconds_since_epoch", int),
            one.part("duration").get("nanoseconds", int),
            one.get("message_count", int),
        )
        for one in reader.parts("files", optional=True)
    }
    folder = Path(reader.path).parent.name
    found = []
    for path in paths:
        # Before version 4 paths began with the name of the bag's folder.
        relative = path.removeprefix(f"{folder}/") if path not in described else path
        found.append(described.get(path) or BagFile(relative, start, duration, count))
    return tuple(found)


class _Values:
    """Mapping of a YAML document that reports missing and mistyped values with their location."""

    def __init__(self, path: str | Path, values: Any, where: str = "") -> None:
        self.path = path
        self.where = where
        if not isinstance(values, dict):
            found = "nothing" if values is None else type(values).__name__
            raise BagError(path, f"not a description of a bag: {where or 'the file'} holds {found}, expected a mapping")
        self._values = values

    def get(self, name: str, kind: type, *default: Any) -> Any:
        if name not in self._values:
            if default:
                return default[0]
            raise BagError(self.path, f"not a description of a bag: {self._at(name)} is missing")
        value = self._values[name]
        optional = default and value is None
        if not optional and (not isinstance(value, kind) or (kind is int and isinstance(value, bool))):
            raise BagError(self.path, f"{self._at(name)}: expected {_KINDS[kind]}, found {value!r}")
        return value

    def part(self, name: str) -> _Values:
        return _Values(self.path, self.get(name, dict), self._at(name))

    def parts(self, name: str, *, optional: bool = False) -> list[_Values]:
        values = self.get(name, list, []) if optional else self.get(name, list)
        return [_Values(self.path, value, f"{self._at(name)}[{k}]") for k, value in enumerate(values or [])]

    def _at(self, name: str) -> str:
        return f"{self.where}.{name}" if self.where else name


_KINDS = {int: "a whole number", str: "a text", list: "a list", dict: "a mapping", object: "anything"}
