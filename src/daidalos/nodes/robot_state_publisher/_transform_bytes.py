"""Serialized message of many transforms, with constant names and changing numbers in a few arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daidalos.common.arrays import Array

_ENCAPSULATION = b"\x00\x01\x00\x00"
"""Encapsulation header of little-endian CDR; offsets in the body start after it."""


class TransformBytes:
    """Serializer of ``tf2_msgs/msg/TFMessage`` for n pairs of frames.

    Parameters
    ----------
    parents, children : sequence of n strings
        Frames.
    """

    def __init__(self, parents: Sequence[str], children: Sequence[str]) -> None:
        body = bytearray(len(parents).to_bytes(4, "little"))
        stamps, numbers = [], []
        for parent, child in zip(parents, children, strict=True):
            _align(body, 4)
            stamps.append(len(body) // 4)
            body += bytes(8)
            for name in (parent, child):
                _align(body, 4)
                text = name.encode() + b"\0"
                body += len(text).to_bytes(4, "little") + text
            _align(body, 8)
            numbers.append(len(body) // 8)
            body += bytes(56)
        self._size = len(body)
        _align(body, 8)
        self._body = np.frombuffer(body, dtype=np.uint8).copy()
        self._words = self._body.view("<u4")
        self._doubles = self._body.view("<f8")
        self._stamps = np.array(stamps, dtype=np.intp)
        self._numbers = np.array(numbers, dtype=np.intp)[:, None] + np.arange(7)

    def write(self, seconds: int, nanoseconds: int, translations: Array, rotations: Array) -> bytes:
        """Return the message.

        Parameters
        ----------
        seconds, nanoseconds : int
            The stamp of all transforms.
        translations : array (n, 3)
            [m].
        rotations : array (n, 4)
            Quaternions x, y, z, w.
        """
        self._words[self._stamps] = seconds & 0xFFFFFFFF
        self._words[self._stamps + 1] = nanoseconds
        self._doubles[self._numbers] = np.concatenate((translations, rotations), axis=1)
        return _ENCAPSULATION + self._body[: self._size].tobytes()


def _align(body: bytearray, size: int) -> None:
    body += bytes(-len(body) % size)
