"""Messages that wait for a broker, kept in a file so that they outlive the program."""

from __future__ import annotations

import base64
import binascii
import json
from collections import deque
from pathlib import Path
from typing import NamedTuple


class Outgoing(NamedTuple):
    """Message for the broker."""

    topic: str
    payload: bytes
    qos: int
    retained: bool


class Buffer:
    """Queue of messages with an upper bound, in memory and in a file with one of them per line.

    Parameters
    ----------
    size : int
        Most messages that are kept; 0 for none, which needs no file.
    file : Path
        Read at first, where it exists; lines that are no messages are left out.

    Raises
    ------
    OSError
        When the file cannot be read.
    """

    def __init__(self, size: int, file: Path) -> None:
        self._size, self._file = size, file
        self._waiting: deque[Outgoing] = deque()
        if size and file.exists():
            found = (_parse(line) for line in file.read_text("utf-8", errors="replace").splitlines())
            self._waiting.extend([one for one in found if one is not None][:size])

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, message: Outgoing) -> bool:
        """Keep a message; return whether there was room.

        Raises
        ------
        OSError
            When the file cannot be written.
        """
        if len(self._waiting) >= self._size:
            return False
        self._waiting.append(message)
        self._file.parent.mkdir(parents=True, exist_ok=True)
        with self._file.open("a", encoding="utf-8") as file:
            text = base64.b64encode(message.payload).decode()
            file.write(json.dumps([message.topic, text, message.qos, message.retained]) + "\n")
        return True

    def take(self) -> list[Outgoing]:
        """Return all messages, the oldest first, and forget them."""
        found = list(self._waiting)
        self._waiting.clear()
        if found:
            self._file.unlink(missing_ok=True)
        return found


def _parse(line: str) -> Outgoing | None:
    try:
        topic, text, qos, retained = json.loads(line)
        return Outgoing(str(topic), base64.b64decode(text, validate=True), int(qos), bool(retained))
    except (ValueError, TypeError, binascii.Error):
        return None
