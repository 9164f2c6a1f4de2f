"""rosbag2's compression of whole files or of single messages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.storage import ZSTD_SUFFIX

FILE, MESSAGE = "FILE", "MESSAGE"
FORMATS = ("zstd",)
_LEVEL = 1
"""Compression level, which must keep up with the incoming messages."""


@dataclass(frozen=True)
class Compression:
    """Compression mode and format.

    Attributes
    ----------
    mode
        ``FILE``, ``MESSAGE`` or empty for neither.
    format
        One of `FORMATS`; empty where nothing is compressed.
    threads
        How many files may be compressed at the same time.
    """

    mode: str = ""
    format: str = ""
    threads: int = 1

    def check(self, path: Path) -> None:
        """Raise BagError when the mode or format is not supported."""
        if self.mode not in ("", FILE, MESSAGE):
            raise BagError(path, f"unknown compression mode '{self.mode}'; there are: none, file, message")
        if self.mode and self.format not in FORMATS:
            raise BagError(path, f"unknown compression format '{self.format}'; there is: {', '.join(FORMATS)}")


def message_compressor() -> Callable[[bytes], bytes]:
    """Return a function that compresses a message; not safe to share between threads."""
    import zstandard

    return zstandard.ZstdCompressor(level=_LEVEL).compress


def message_decompressor(path: Path) -> Callable[[bytes], bytes]:
    """Return a function that decompresses a message of the file at `path`; not safe to share between threads."""
    import zstandard

    decompress = zstandard.ZstdDecompressor().decompress

    def restore(data: bytes) -> bytes:
        try:
            return decompress(data)
        except zstandard.ZstdError as error:
            raise BagError(path, f"a compressed message is damaged: {error}") from None

    return restore


def compress_file(path: Path) -> Path:
    """Compress a file, delete the original and return the new path.

    Raises
    ------
    BagError
        When that cannot be written; the file stays as it was.
    """
    import zstandard

    packed = path.with_name(path.name + ZSTD_SUFFIX)
    try:
        with path.open("rb") as source, packed.open("xb") as target:
            zstandard.ZstdCompressor(level=_LEVEL).copy_stream(source, target, size=path.stat().st_size)
        path.unlink()
    except OSError as error:
        packed.unlink(missing_ok=True)
        raise BagError(packed, f"cannot be written: {error.strerror}") from None
    return packed


def decompress_file(path: Path, folder: Path) -> Path:
    """Decompress a file into a folder and return the path of the result.

    Raises
    ------
    BagError
        When the file is damaged.
    """
    import zstandard

    restored = folder / path.name.removesuffix(ZSTD_SUFFIX)
    try:
        with path.open("rb") as source, restored.open("wb") as target:
            zstandard.ZstdDecompressor().copy_stream(source, target)
    except OSError as error:
        raise BagError(path, f"cannot be decompressed: {error.strerror}") from None
    except zstandard.ZstdError as error:
        raise BagError(path, f"cannot be decompressed: {error}") from None
    return restored
