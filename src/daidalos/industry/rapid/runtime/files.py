"""Predefined routines on files and folders, all of them below one folder, which is the controller's ``HOME:``."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import MAX_STRING, Handle, text_of

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

EOF = "EOF"
EOF_NUM = 9.998e36
EOF_BIN = -1.0


def resolve(task: Task, name: str, file: str | None = None) -> Path:
    """Return the path that a name stands for.

    Raises
    ------
    RapidError
        ERR_FILEACC, where it is not below the folder of the task.
    """
    text = f"{name}/{file}" if file else name
    parts = [part for part in text.replace("\\", "/").split("/") if part and not part.endswith(":")]
    if parts and ":" in parts[0]:
        parts[0] = parts[0].split(":", 1)[1]
    path = task.home.joinpath(*parts).resolve()
    if not path.is_relative_to(task.home.resolve()):
        raise RapidError("ERR_FILEACC", f"'{text}' is not below HOME:")
    return path


@contextlib.contextmanager
def _named(name: str) -> Iterator[None]:
    """Raise errors of the system as those of a controller."""
    try:
        yield
    except FileNotFoundError:
        raise RapidError("ERR_FILNOTFND", f"there is no '{name}'") from None
    except FileExistsError:
        raise RapidError("ERR_FILEEXIST", f"there is a '{name}' already") from None
    except OSError as error:
        raise RapidError("ERR_FILEACC", f"'{name}': {error.strerror or error}") from None


def _file(device: Handle) -> BinaryIO:
    if device.state is None or device.state.closed:
        raise RapidError("ERR_FILEACC", "the file is not open")
    file: BinaryIO = device.state
    return file


@routine("Open")
def open_file(
    task: Task,
    object_: str,
    iodevice_: Handle,
    file_: str | None = None,
    read_: Any = None,
    write_: Any = None,
    append_: Any = None,
    bin_: Any = None,
) -> None:
    """Open a file; without a word for what, to read and to write at its end."""
    path = resolve(task, object_, file_)
    mode = "rb" if read_ else "wb" if write_ else "ab" if append_ else "ab+"
    if iodevice_.state is not None and not iodevice_.state.closed:
        raise RapidError("ERR_FILEOPEN", "the device is open already")
    with _named(path.name):
        iodevice_.state = path.open(mode)
    if not (read_ or write_ or append_):
        iodevice_.state.seek(0)
    task.resources.append(iodevice_.state)


@routine("Close")
def close_file(task: Task, iodevice_: Handle) -> None:
    """Close a file."""
    _file(iodevice_).close()


@routine("Rewind")
def rewind(task: Task, iodevice_: Handle) -> None:
    """Go to the beginning of a file."""
    _file(iodevice_).seek(0)


@routine("Write")
def write(
    task: Task,
    iodevice_: Handle,
    string_: str,
    num_: float | None = None,
    bool_: bool | None = None,
    pos_: Any = None,
    orient_: Any = None,
    dnum_: float | None = None,
    nonewline_: Any = None,
) -> None:
    """Write a line, with a value behind it."""
    value = next((one for one in (num_, bool_, pos_, orient_, dnum_) if one is not None), None)
    text = string_ + (text_of(value) if value is not None else "") + ("" if nonewline_ else "\n")
    _write(iodevice_, text.encode())


@routine("WriteStrBin")
def write_string(task: Task, iodevice_: Handle, str_: str) -> None:
    """Write the bytes of a string."""
    _write(iodevice_, str_.encode("latin-1", "replace"))


@routine("WriteBin")
def write_bytes(task: Task, iodevice_: Handle, buffer_: list[float], nchar_: float) -> None:
    """Write so many numbers of an array as bytes."""
    _write(iodevice_, bytes(int(one) & 0xFF for one in buffer_[: int(nchar_)]))


def _write(device: Handle, data: bytes) -> None:
    try:
        _file(device).write(data)
        _file(device).flush()
    except (OSError, ValueError) as error:
        raise RapidError("ERR_FILEACC", f"the file cannot be written: {error}") from None


@routine("ReadStr")
def read_string(
    task: Task,
    iodevice_: Handle,
    delim_: str | None = None,
    removecr_: Any = None,
    discardheaders_: Any = None,
    time_: float | None = None,
) -> str:
    """Return the next line, or what comes before one of some characters; at the end of the file, EOF."""
    ends = (delim_ or "\n").encode("latin-1")
    found = bytearray()
    while len(found) <= MAX_STRING:
        one = _read(iodevice_, 1)
        if not one and not found:
            return EOF
        if not one or one in ends:
            break
        if discardheaders_ and not found and one in b" \t\r\n":
            continue
        found += one
    text = found.decode("utf-8", "replace")
    return text.removesuffix("\r") if removecr_ or delim_ is None else text


@routine("ReadNum")
def read_number(task: Task, iodevice_: Handle, delim_: str | None = None, time_: float | None = None) -> float:
    """Return the number of the next line; at the end of the file, EOF_NUM."""
    text = read_string(task, iodevice_, delim_)
    if text == EOF:
        return EOF_NUM
    try:
        return float(text)
    except ValueError:
        raise RapidError("ERR_RCVDATA", f"'{text}' is no number") from None


@routine("ReadBin")
def read_byte(task: Task, iodevice_: Handle, time_: float | None = None) -> float:
    """Return the next byte; at the end of the file, EOF_BIN."""
    one = _read(iodevice_, 1)
    return float(one[0]) if one else EOF_BIN


@routine("ReadStrBin")
def read_characters(task: Task, iodevice_: Handle, noofchars_: float, time_: float | None = None) -> str:
    """Return so many characters; at the end of the file, EOF."""
    return _read(iodevice_, int(noofchars_)).decode("latin-1") or EOF


def _read(device: Handle, count: int) -> bytes:
    try:
        return _file(device).read(count)
    except (OSError, ValueError) as error:
        raise RapidError("ERR_FILEACC", f"the file cannot be read: {error}") from None


# Folders


@routine("IsFile")
def is_file(
    task: Task,
    path_: str,
    directory_: Any = None,
    fifo_: Any = None,
    regfile_: Any = None,
    blockspec_: Any = None,
    charspec_: Any = None,
) -> bool:
    """Return whether there is a file, or a folder."""
    path = resolve(task, path_)
    if directory_:
        return path.is_dir()
    return path.is_file() if regfile_ else path.exists() and not (fifo_ or blockspec_ or charspec_)


@routine("FileSize", "FileSizeDnum")
def file_size(task: Task, path_: str) -> float:
    """Return the size of a file in bytes."""
    with _named(path_):
        return float(resolve(task, path_).stat().st_size)


@routine("RemoveFile")
def remove_file(task: Task, path_: str) -> None:
    """Remove a file."""
    with _named(path_):
        resolve(task, path_).unlink()


@routine("RenameFile")
def rename_file(task: Task, oldpath_: str, newpath_: str) -> None:
    """Rename a file."""
    new = resolve(task, newpath_)
    if new.exists():
        raise RapidError("ERR_FILEEXIST", f"there is a '{newpath_}' already")
    with _named(oldpath_):
        resolve(task, oldpath_).rename(new)


@routine("CopyFile")
def copy_file(task: Task, oldpath_: str, newpath_: str) -> None:
    """Copy a file."""
    new = resolve(task, newpath_)
    if new.exists():
        raise RapidError("ERR_FILEEXIST", f"there is a '{newpath_}' already")
    with _named(oldpath_):
        shutil.copyfile(resolve(task, oldpath_), new)


@routine("MakeDir")
def make_folder(task: Task, path_: str) -> None:
    """Make a folder."""
    with _named(path_):
        resolve(task, path_).mkdir()


@routine("RemoveDir")
def remove_folder(task: Task, path_: str) -> None:
    """Remove an empty folder."""
    with _named(path_):
        resolve(task, path_).rmdir()


@routine("OpenDir")
def open_folder(task: Task, dev_: Handle, path_: str) -> None:
    """Open a folder, to read the names in it."""
    with _named(path_):
        names = sorted(one.name for one in resolve(task, path_).iterdir())
    dev_.state = iter([".", "..", *names])


@routine("ReadDir")
def read_folder(task: Task, dev_: Handle, filename_: Any) -> bool:
    """Read the next name of a folder, and return whether there was one."""
    if dev_.state is None:
        raise RapidError("ERR_FILEACC", "the folder is not open")
    name = next(dev_.state, None)
    filename_[0][filename_[1]] = name or ""
    return name is not None


@routine("CloseDir")
def close_folder(task: Task, dev_: Handle) -> None:
    """Close a folder."""
    dev_.state = None
