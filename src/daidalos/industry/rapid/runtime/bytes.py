"""Predefined routines on data by name, on raw bytes, and about the controller."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import Handle

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MAX_RAW_BYTES = 1024
_INTEGERS = {1.0: "B", 2.0: "H", 4.0: "I", 8.0: "Q", -1.0: "b", -2.0: "h", -4.0: "i", -8.0: "q"}


def _buffer(handle: Handle) -> bytearray:
    if handle.state is None:
        handle.state = bytearray()
    buffer: bytearray = handle.state
    return buffer


@routine("ClearRawBytes")
def clear(task: Task, rawdata_: Handle, fromindex_: float | None = None) -> None:
    """Remove all bytes, or those from an index on."""
    del _buffer(rawdata_)[int(fromindex_ or 1) - 1 :]


@routine("RawBytesLen")
def length(task: Task, rawdata_: Handle) -> float:
    """Return the number of bytes."""
    return float(len(_buffer(rawdata_)))


@routine("CopyRawBytes")
def copy(
    task: Task, fromrawdata_: Handle, fromindex_: float, torawdata_: Handle, toindex_: float, noofbytes_: Any = None
) -> None:
    """Copy bytes into others."""
    source = bytes(_buffer(fromrawdata_))[int(fromindex_) - 1 :]
    _write(torawdata_, toindex_, source if noofbytes_ is None else source[: int(noofbytes_)])


def _write(handle: Handle, index: float, data: bytes) -> None:
    buffer, start = _buffer(handle), int(index) - 1
    if start < 0 or start + len(data) > MAX_RAW_BYTES:
        raise RapidError("ERR_OUTOFBND", f"rawbytes have {MAX_RAW_BYTES} bytes at most")
    buffer.extend(b"\0" * (start - len(buffer)))
    buffer[start : start + len(data)] = data


@routine("PackRawBytes")
def pack(
    task: Task,
    value_: Any,
    rawdata_: Handle,
    startindex_: float,
    network_: Any = None,
    hex1_: Any = None,
    intx_: float | None = None,
    float4_: Any = None,
    ascii_: Any = None,
) -> None:
    """Write a value as bytes."""
    order = ">" if network_ else "<"
    try:
        if ascii_:
            data = value_.encode("latin-1") if isinstance(value_, str) else bytes([int(value_)])
        elif float4_:
            data = struct.pack(f"{order}f", value_)
        else:
            data = struct.pack(f"{order}{_INTEGERS[1.0 if hex1_ else intx_ or 1.0]}", int(value_))
    except (struct.error, ValueError, UnicodeEncodeError) as error:
        raise RapidError("ERR_ARGVALERR", f"the value does not fit: {error}") from None
    _write(rawdata_, startindex_, data)


@routine("UnpackRawBytes")
def unpack(
    task: Task,
    rawdata_: Handle,
    startindex_: float,
    value_: Any,
    network_: Any = None,
    hex1_: Any = None,
    intx_: float | None = None,
    float4_: Any = None,
    ascii_: float | None = None,
) -> None:
    """Read a value from bytes."""
    data, order = bytes(_buffer(rawdata_))[int(startindex_) - 1 :], ">" if network_ else "<"
    try:
        if ascii_ is not None:
            result: Any = data[: int(ascii_)].decode("latin-1")
        else:
            form = f"{order}{'f' if float4_ else _INTEGERS[1.0 if hex1_ else intx_ or 1.0]}"
            result = float(struct.unpack_from(form, data)[0])
    except struct.error:
        raise RapidError("ERR_OUTOFBND", "there are not so many bytes") from None
    value_[0][value_[1]] = result


# Data by name


@routine("GetDataVal")
def get_data(task: Task, object_: str, value_: Any, **rest: Any) -> None:
    """Read data by its name."""
    found = task.value(object_)
    if isinstance(value_, tuple):
        value_[0][value_[1]] = found
    else:
        value_[:] = found


@routine("SetDataVal")
def set_data(task: Task, object_: str, value_: Any, **rest: Any) -> None:
    """Assign to data by its name."""
    task.set_value(object_, value_)


@routine("BookErrNo")
def book_error(task: Task, errorname_: Any) -> None:
    """Return a number for an error of the program's own."""
    task.settings["booked"] = number = task.settings.get("booked", 0.0) + 1.0
    errorname_[0][errorname_[1]] = number
