"""Names of image encodings."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ._opencv import opencv

DEPTHS: dict[str, np.dtype[Any]] = {
    "8U": np.dtype(np.uint8),
    "8S": np.dtype(np.int8),
    "16U": np.dtype(np.uint16),
    "16S": np.dtype(np.int16),
    "32S": np.dtype(np.int32),
    "32F": np.dtype(np.float32),
    "64F": np.dtype(np.float64),
}
_DEPTH_OF = {dtype.name: name for name, dtype in DEPTHS.items()}
_CHANNELS = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}
_YUV422 = {
    "yuv422": "uyvy",
    "uyvy": "uyvy",
    "UYVY": "uyvy",
    "yuv422_yuy2": "yuyv",
    "yuyv": "yuyv",
    "YUYV": "yuyv",
}
_NAMED = re.compile(r"(mono|rgba?|bgra?|bayer_(?:rggb|bggr|gbrg|grbg))(8|16)")
_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([1-9][0-9]*))?")


class Encoding(NamedTuple):
    """An encoding: the type of a number, how many a pixel has, and what they mean.

    `order` is "mono", the order of the channels, such as "bgra", the cell of a Bayer pattern, such as
    "bayer_rggb", the order of bytes of YUV 4:2:2 ("uyvy", "yuyv"), or "" when the numbers are just numbers.
    """

    dtype: np.dtype[Any]
    channels: int
    order: str

    @property
    def type_name(self) -> str:
        """The type's generic name, such as ``8UC3``."""
        return f"{_DEPTH_OF[self.dtype.name]}C{self.channels}"


@lru_cache(maxsize=256)
def encoding(name: str) -> Encoding:
    """Return what the name of an encoding means.

    Raises
    ------
    RuntimeError
        When there is none of that name.
    """
    if found := _NAMED.fullmatch(name):
        order, bits = found.groups()
        return Encoding(DEPTHS[f"{bits}U"], _CHANNELS.get(order, 1), order)
    if name in _YUV422:
        return Encoding(DEPTHS["8U"], 2, _YUV422[name])
    if found := _GENERIC.fullmatch(name):
        depth, channels = found.groups()
        return Encoding(DEPTHS[depth], int(channels or 1), "")
    raise RuntimeError(f"Unrecognized image encoding [{name}]")


def type_name(dtype: np.dtype[Any], channels: int) -> str:
    """Return the generic name of an array's type, such as ``8UC3``.

    Raises
    ------
    KeyError
        When images cannot hold numbers of that type.
    """
    return f"{_DEPTH_OF[dtype.name]}C{channels}"


def getCvType(name: str) -> int:
    """Return OpenCV's number of an encoding's type.

    Raises
    ------
    RuntimeError
        When there is no encoding of that name.
    """
    found = encoding(name)
    return type_number(_DEPTH_OF[found.dtype.name], found.channels)


def type_number(depth: str, channels: int) -> int:
    """Return OpenCV's number of a type."""
    return list(DEPTHS).index(depth) + ((channels - 1) << _shift())


def CV_MAT_DEPTHWrap(number: int) -> int:
    """Return the number of the depth of a type."""
    return number & ((1 << _shift()) - 1)


def CV_MAT_CNWrap(number: int) -> int:
    """Return the number of channels of a type."""
    return (number >> _shift()) + 1


@lru_cache(maxsize=1)
def _shift() -> int:
    """Return by how many bits OpenCV shifts the number of channels: 3 up to version 4, more since."""
    cv2 = opencv()
    return 3 if cv2 is None else int(cv2.CV_8UC2).bit_length() - 1
