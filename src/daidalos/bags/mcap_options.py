"""Settings of MCAP files: presets, and files with the setting names of rosbag2's MCAP plugin."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from daidalos.bags.errors import BagError
from daidalos.bags.storage import StorageOptions, settings

ZSTD_LEVELS = {"Fastest": 1, "Fast": 2, "Default": 3, "Slow": 10, "Slowest": 19}
LZ4_LEVELS = {"Fastest": -9, "Fast": -3, "Default": 0, "Slow": 6, "Slowest": 12}
"""Meaning of the level names for each compressor."""


@dataclass(frozen=True)
class McapOptions:
    """Layout of an MCAP file; the setting names in files are those of rosbag2's MCAP plugin."""

    chunk_size: int = 768 * 1024
    compression: str = ""
    level: str = "Default"
    force_compression: bool = False
    chunking: bool = True
    chunk_crc: bool = True
    message_index: bool = True
    chunk_index: bool = True
    summary: bool = True
    summary_crc: bool = True
    data_crc: bool = False
    repeated_schemas: bool = True
    repeated_channels: bool = True
    statistics: bool = True
    summary_offsets: bool = True
    metadata_index: bool = True


_PROFILES = {
    "none": McapOptions(),
    "fastwrite": McapOptions(chunking=False, summary_crc=False),
    "zstd_fast": McapOptions(compression="zstd", level="Fastest", chunk_crc=False),
    "zstd_small": McapOptions(compression="zstd", level="Slowest", chunk_size=4 * 1024 * 1024),
}
_SWITCHES = {
    "noChunkCRC": "chunk_crc",
    "noSummaryCRC": "summary_crc",
    "noChunking": "chunking",
    "noMessageIndex": "message_index",
    "noSummary": "summary",
    "noRepeatedSchemas": "repeated_schemas",
    "noRepeatedChannels": "repeated_channels",
    "noMetadataIndex": "metadata_index",
    "noChunkIndex": "chunk_index",
    "noStatistics": "statistics",
    "noSummaryOffsets": "summary_offsets",
}
_IGNORED = {"noAttachmentCRC", "noAttachmentIndex"}
"""Settings about attachments, of which bags have none."""


def writer_options(options: StorageOptions) -> McapOptions:
    """Return the settings of a profile, overridden by those of a file.

    Raises
    ------
    BagError
        When the file has a setting that is not known, or one with a wrong value.
    """
    chosen = _PROFILES[options.profile or "none"]
    if options.config is None:
        return chosen
    for name, value in settings(options.config).items():
        change = _change(name, value)
        if change is None:
            known = ", ".join(sorted([*_SWITCHES, *_IGNORED, *_VALUES]))
            raise BagError(options.config, f"{name}: {value!r} is not a setting of MCAP files; there are: {known}")
        chosen = replace(chosen, **change)
    return chosen


def _change(name: str, value: object) -> dict[str, Any] | None:
    """Return the changes that a setting makes, None for an invalid value."""
    if name in _VALUES:
        field, convert = _VALUES[name]
        try:
            return {field: convert(value)}
        except (KeyError, TypeError, ValueError):
            return None
    if not isinstance(value, bool):
        return None
    if name in _SWITCHES:
        return {_SWITCHES[name]: not value}
    return {} if name in _IGNORED else None


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _positive(value: object) -> int:
    if not isinstance(value, int) or value <= 0:
        raise ValueError
    return value


def _level(value: object) -> object:
    if value not in ZSTD_LEVELS:
        raise ValueError
    return value


_VALUES: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "chunkSize": ("chunk_size", _positive),
    "compression": ("compression", lambda value: {"None": "", "Lz4": "lz4", "Zstd": "zstd"}[value]),
    "compressionLevel": ("level", _level),
    "forceCompression": ("force_compression", _flag),
    "enableDataCRC": ("data_crc", _flag),
}
