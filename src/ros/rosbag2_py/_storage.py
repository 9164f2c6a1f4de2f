"""Options of bags as programs give them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING

from rclpy.impl.lazy_reexport import lazy_reexport

from daidalos.bags.compression import Compression
from daidalos.bags.selection import Selection
from daidalos.bags.storage import DEFAULT
from daidalos.bags.storage import StorageOptions as FileOptions
from daidalos.bags.writer import WriterOptions
from rosbag2_py._qos import Duration, QoS, convert_rclcpp_qos_to_rclpy_qos, to_rclcpp_qos_vector

__all__ = [
    "ConverterOptions",
    "Duration",
    "MessageDefinition",
    "QoS",
    "ReadOrder",
    "ReadOrderSortBy",
    "StorageFilter",
    "StorageOptions",
    "convert_rclcpp_qos_to_rclpy_qos",
    "get_default_storage_id",
    "to_rclcpp_qos_vector",
]
_SECOND = 1_000_000_000


@dataclass
class StorageOptions:
    """Location and storage settings of a bag; sizes in bytes, durations in seconds, times in nanoseconds."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)

    def writer_options(self, compression: Compression | None = None) -> WriterOptions:
        """Return what the bag is written with."""
        config = Path(self.storage_config_uri) if self.storage_config_uri else None
        return WriterOptions(
            self.storage_id or DEFAULT,
            FileOptions(self.storage_preset_profile or "none", config),
            self.max_bagfile_size,
            int(self.max_bagfile_duration * _SECOND),
            compression or Compression(),
            dict(self.custom_data),
        )


@dataclass
class ConverterOptions:
    """Serialization formats: of what is there, and of what is wanted; empty means the same."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""

    def check(self) -> None:
        """Raise RuntimeError where a format is wanted that nobody can convert to."""
        for name in (self.input_serialization_format, self.output_serialization_format):
            if name not in ("", "cdr"):
                raise RuntimeError(f"No converter for the serialization format '{name}'; known is: cdr")


@dataclass
class StorageFilter:
    """Selection of topics; all if none is named."""

    topics: Sequence[str] = ()
    services_events: Sequence[str] = ()
    regex: str = ""
    exclude_topics: Sequence[str] = ()
    exclude_service_events: Sequence[str] = ()
    regex_to_exclude: str = ""

    def selection(self) -> Selection:
        """Return what is wanted."""
        everything = not (self.topics or self.services_events or self.regex)
        return Selection(
            topics=(*self.topics, *self.services_events),
            all_topics=everything,
            all_services=everything,
            regex=self.regex,
            exclude_topics=tuple(self.exclude_topics),
            exclude_services=tuple(name.removesuffix("/_service_event") for name in self.exclude_service_events),
            exclude_regex=self.regex_to_exclude,
            hidden=True,
        )


class ReadOrderSortBy(IntEnum):
    """By what messages are ordered."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass
class ReadOrder:
    """The order in which messages are read."""

    sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


@dataclass
class MessageDefinition:
    """The text that defines a type of messages."""

    topic_type: str = ""
    encoding: str = ""
    encoded_message_definition: str = ""
    type_hash: str = ""


def get_default_storage_id() -> str:
    """Return the storage that bags are written with where none is named."""
    return DEFAULT


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "rosbag2_py._metadata": (
                "BagMetadata",
                "FileInformation",
                "MetadataIo",
                "TopicInformation",
                "TopicMetadata",
            )
        },
    )
