"""Compression options of bags."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from daidalos.bags.compression import Compression


class CompressionMode(IntEnum):
    """Units of compression."""

    NONE = 0
    FILE = 1
    MESSAGE = 2


@dataclass
class CompressionOptions:
    """Compression mode, format and number of threads (0: one for each processor)."""

    compression_format: str = ""
    compression_mode: CompressionMode = CompressionMode.NONE
    compression_queue_size: int = 1
    compression_threads: int = 0
    compression_threads_priority: int = 0

    def compression(self) -> Compression:
        """Return what bags are written with."""
        if self.compression_mode == CompressionMode.NONE:
            return Compression()
        return Compression(
            CompressionMode(self.compression_mode).name, self.compression_format, self.compression_threads
        )


def compression_mode_from_string(compression_mode: str) -> CompressionMode:
    """Return the mode of a name; NONE where there is none of that name."""
    return CompressionMode.__members__.get(compression_mode.upper(), CompressionMode.NONE)


def compression_mode_to_string(compression_mode: CompressionMode) -> str:
    """Return the name of a mode."""
    return CompressionMode(compression_mode).name
