"""Storage formats: detection of a file's format, and its reader and writer."""

from __future__ import annotations

from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.storage import (
    MCAP,
    PROFILES,
    SQLITE3,
    SUFFIXES,
    ZSTD_MAGIC,
    ZSTD_SUFFIX,
    StorageOptions,
    StorageReader,
    StorageWriter,
)

_ROS1_MAGIC = b"#ROSBAG"
_MAGIC = {b"\x89MCAP": MCAP, b"SQLite format 3\0": SQLITE3}


def storage_of(path: Path) -> str:
    """Return the format of a file by its first bytes, else by its name.

    Raises
    ------
    BagError
        When it is neither.
    """
    try:
        with path.open("rb") as file:
            start = file.read(16)
    except OSError as error:
        raise BagError(path, f"cannot be read: {error.strerror}") from None
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
        command = f"'rosbags-convert --src {path} --dst {path.with_suffix('')}'"
        raise BagError(path, f"is a bag of ROS 1; convert it with {command} (pip install 'daidalos[ros1]')")
    raise BagError(path, f"not a bag: it begins with {start[:8].hex(' ')}, expected an MCAP or sqlite3 file")


def open_reader(path: Path, storage_id: str) -> StorageReader:
    """Open a file for reading.

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
    """Create a file for writing.

    Raises
    ------
    BagError
        When it is there already or cannot be made, or the options are not understood.
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
