"""Description of a bag from its files, for bags without `metadata.yaml` or to rewrite it."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

from daidalos.bags.compression import FILE, FORMATS, MESSAGE, decompress_file
from daidalos.bags.errors import BagError
from daidalos.bags.formats import open_reader, open_writer, storage_of
from daidalos.bags.message import BagMessage
from daidalos.bags.metadata import BagFile, BagMetadata, TopicCount, parse_metadata, total, write_metadata
from daidalos.bags.storage import (
    FOREVER_NS,
    SQLITE3,
    SUFFIXES,
    ZSTD_MAGIC,
    ZSTD_SUFFIX,
    StorageOptions,
    StorageReader,
)


def describe(path: str | Path, storage_id: str = "") -> tuple[BagMetadata, list[str]]:
    """Read the description of a bag from its files, or of a single file.

    Parameters
    ----------
    path
        The folder or the file.
    storage_id
        The files' format; by default it is found out.

    Returns
    -------
    BagMetadata
        The description.
    list of str
        What is broken in some of the files though the rest can be read; a line each.

    Raises
    ------
    BagError
        When there are no files, or none that can be read.
    """
    place = Path(path)
    paths = [place] if place.is_file() else bag_files(place, storage_id)
    folder = place if place.is_dir() else place.parent
    if not paths:
        raise BagError(place, "not a bag: it holds no file that ends in " + " or ".join(SUFFIXES.values()))
    storages = {storage_id or storage_of(one) for one in paths if one.stat().st_size} or {""}
    if len(storages) > 1:
        raise BagError(place, f"it holds files of several storages: {', '.join(sorted(storages))}; choose one")
    storage_id = storages.pop()
    files: list[BagFile] = []
    topics: dict[str, TopicCount] = {}
    faults: list[str] = []
    known = BagMetadata("")
    packed = False
    for one in paths:
        try:
            with opened(one, storage_id) as reader:
                files.append(reader.as_file(one.relative_to(folder).as_posix()))
                known = _kept(reader, one) or replace(known, ros_distro=known.ros_distro or reader.ros_distro)
                packed = packed or _has_packed_messages(reader)
                if reader.damage:
                    faults.append(f"{one}: {reader.damage}")
                for name, more in reader.topics.items():
                    before = topics.get(name)
                    topics[name] = TopicCount(more.topic, more.count + (before.count if before else 0))
        except BagError as error:
            if len(paths) == 1:
                raise
            faults.append(str(error))
    if not files:
        raise BagError(place, f"none of its files can be read; the first: {faults[0]}")
    mode = MESSAGE if packed else FILE if paths[0].name.endswith(ZSTD_SUFFIX) else ""
    metadata = total(
        storage_id,
        files,
        (topics[name] for name in sorted(topics)),
        compression_format=FORMATS[0] if mode else "",
        compression_mode=mode,
        custom_data=known.custom_data,
        ros_distro=known.ros_distro,
    )
    return metadata, faults


def reindex(folder: str | Path, storage_id: str = "") -> tuple[BagMetadata, list[str]]:
    """Write a bag's `metadata.yaml` anew from its files, and complete files whose writer was killed.

    Returns what `describe` does; what is lost of a file that was cut off is told there.

    Raises
    ------
    BagError
        As `describe` does, or when it cannot be written.
    """
    metadata, faults = describe(folder, storage_id)
    for file in metadata.files:
        complete(Path(folder) / file.path, metadata.storage_id)
    write_metadata(folder, metadata)
    return metadata, faults


def complete(path: Path, storage_id: str) -> None:
    """Complete a file whose writer was killed so that every program can read it; leave other files unchanged.

    Raises
    ------
    BagError
        When it cannot be written; the file stays as it was then.
    """
    if path.name.endswith(ZSTD_SUFFIX):
        return
    if storage_id == SQLITE3:
        from daidalos.bags.sqlite_writer import checkpoint_journal

        checkpoint_journal(path)
        return
    with opened(path, storage_id) as reader:
        if not reader.damage:
            return
        draft = path.with_name(f"{path.name}.new")
        draft.unlink(missing_ok=True)
        writer = open_writer(draft, storage_id, StorageOptions(), reader.ros_distro)
        try:
            for one in reader.topics.values():
                writer.add_topic(one.topic)
            for message in reader.messages(reader.topics, 0, FOREVER_NS, by_file=True):
                writer.write(message)
            writer.close()
        except BaseException:
            writer.close()
            draft.unlink()
            raise
    draft.replace(path)


def bag_files(folder: Path, storage_id: str = "") -> list[Path]:
    """Return the files of a bag in the order in which they were written."""
    suffixes = tuple(SUFFIXES[one] for one in ([storage_id] if storage_id in SUFFIXES else SUFFIXES))
    found = [path for path in folder.iterdir() if path.name.removesuffix(ZSTD_SUFFIX).endswith(suffixes)]
    return sorted(found, key=lambda path: [int(t) if t.isdigit() else t for t in re.split(r"(\d+)", path.name)])


@contextmanager
def opened(path: Path, storage_id: str) -> Iterator[StorageReader]:
    """Yield a reader of a file, which may be compressed as a whole.

    Raises
    ------
    BagError
        When it is missing or cannot be read.
    """
    with ExitStack() as stack:
        source = path
        if path.name.endswith(ZSTD_SUFFIX):
            source = decompress_file(path, Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="bag_"))))
        try:
            reader = open_reader(source, storage_id or storage_of(path))
        except BagError as error:
            raise BagError(path, error.reason) from None
        reader.path = path
        try:
            yield reader
        finally:
            reader.close()


def _kept(reader: StorageReader, path: Path) -> BagMetadata | None:
    """Return the description that a file holds of its bag, None without a readable one."""
    if not reader.metadata:
        return None
    try:
        return parse_metadata(reader.metadata, path)
    except BagError:
        return None


def _has_packed_messages(reader: StorageReader) -> bool:
    """Return whether messages are compressed one by one, which zstd's magic number at their start shows."""
    first: BagMessage | None = None
    for name, one in reader.topics.items():
        if one.count:
            first = next(reader.messages({name}, 0, FOREVER_NS), None)
            break
    return first is not None and first.data.startswith(ZSTD_MAGIC)
