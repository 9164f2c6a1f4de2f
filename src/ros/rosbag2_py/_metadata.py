"""Descriptions of bags as programs see them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rclpy.duration import Duration
from rclpy.time import Time

from daidalos.bags import metadata as bags
from daidalos.bags.message import Definition, Topic
from rosbag2_py._qos import QoS, resolved


class TopicMetadata:
    """A topic; it may also be made without the number `id`, as in ROS 2 Humble."""

    def __init__(
        self,
        id: int | str = 0,
        name: str = "",
        type: str = "",
        serialization_format: str = "",
        offered_qos_profiles: str | Sequence[Any] = (),
        type_description_hash: str = "",
    ) -> None:
        if isinstance(id, str):
            if type and serialization_format and not offered_qos_profiles:
                offered_qos_profiles = serialization_format
            name, type, serialization_format = id, name, type
        self.id = id if isinstance(id, int) else 0
        self.name = name
        self.type = type
        self.serialization_format = serialization_format
        self.offered_qos_profiles = offered_qos_profiles
        self.type_description_hash = type_description_hash

    @classmethod
    def of(cls, topic: Topic, number: int = 0) -> TopicMetadata:
        """Return the description of a bag's topic."""
        profiles = [QoS.of(one) for one in topic.qos]
        return cls(number, topic.name, topic.type, topic.serialization_format, profiles, topic.type_hash)

    def topic(self, definition: Definition | None = None) -> Topic:
        """Return the topic for a bag."""
        return Topic(
            self.name,
            self.type,
            self.serialization_format or "cdr",
            resolved(self.offered_qos_profiles),
            self.type_description_hash,
            definition,
        )

    def equals(self, other: TopicMetadata) -> bool:
        """Return whether both are the same."""
        return self.topic() == other.topic()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TopicMetadata) and self.equals(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"TopicMetadata(id={self.id}, name={self.name!r}, type={self.type!r})"


@dataclass
class TopicInformation:
    """A topic and its number of messages."""

    topic_metadata: TopicMetadata
    message_count: int = 0


@dataclass
class FileInformation:
    """A file of a bag."""

    path: str
    starting_time: Time
    duration: Duration
    message_count: int


@dataclass(repr=False)
class BagMetadata:
    """Description of a bag."""

    version: int = bags.VERSION
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: Duration = field(default_factory=Duration)
    starting_time: Time = field(default_factory=Time)
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""

    def __repr__(self) -> str:
        from rosbag2_py._format import format_metadata

        return format_metadata(to_bag(self), self.bag_size)


def of_bag(metadata: bags.BagMetadata, size: int = 0) -> BagMetadata:
    """Return the description of a bag for programs; `size` in bytes."""
    return BagMetadata(
        metadata.version,
        size,
        metadata.storage_id,
        [file.path for file in metadata.files],
        [
            FileInformation(
                file.path, Time(nanoseconds=file.start_ns), Duration(nanoseconds=file.duration_ns), file.message_count
            )
            for file in metadata.files
        ],
        Duration(nanoseconds=metadata.duration_ns),
        Time(nanoseconds=metadata.start_ns),
        metadata.message_count,
        [TopicInformation(TopicMetadata.of(one.topic, k), one.count) for k, one in enumerate(metadata.topics, 1)],
        metadata.compression_format,
        metadata.compression_mode,
        dict(metadata.custom_data),
        metadata.ros_distro,
    )


def to_bag(metadata: BagMetadata) -> bags.BagMetadata:
    """Return the description that a program made."""
    start, duration = metadata.starting_time.nanoseconds, metadata.duration.nanoseconds
    described = {
        file.path: bags.BagFile(
            file.path, file.starting_time.nanoseconds, file.duration.nanoseconds, file.message_count
        )
        for file in metadata.files
    }
    paths = metadata.relative_file_paths or list(described)
    whole = bags.BagFile("", start, duration, metadata.message_count)
    return bags.BagMetadata(
        metadata.storage_identifier,
        start,
        duration,
        metadata.message_count,
        tuple(
            bags.TopicCount(one.topic_metadata.topic(), one.message_count) for one in metadata.topics_with_message_count
        ),
        tuple(described.get(path) or replace(whole, path=path) for path in paths),
        metadata.compression_format,
        metadata.compression_mode,
        dict(metadata.custom_data),
        metadata.ros_distro,
        metadata.version,
    )


class MetadataIo:
    """Reader and writer of `metadata.yaml`."""

    def read_metadata(self, uri: str) -> BagMetadata:
        """Return the description in a folder; RuntimeError where there is none."""
        metadata = bags.read_metadata(uri)
        sizes = (Path(uri) / file.path for file in metadata.files)
        return of_bag(metadata, sum(path.stat().st_size for path in sizes if path.is_file()))

    def write_metadata(self, uri: str, metadata: BagMetadata) -> None:
        """Write the description into a folder."""
        bags.write_metadata(uri, to_bag(metadata))

    def metadata_file_exists(self, uri: str) -> bool:
        """Return whether a folder has a description."""
        return (Path(uri) / bags.FILE_NAME).is_file()

    def serialize_metadata(self, metadata: BagMetadata) -> str:
        """Return the description as text."""
        return bags.format_metadata(to_bag(metadata))

    def deserialize_metadata(self, serialized_metadata: str) -> BagMetadata:
        """Return the description that a text holds; RuntimeError where it holds none."""
        return of_bag(bags.parse_metadata(serialized_metadata, bags.FILE_NAME))
