"""Messages of the Debug Adapter Protocol: JSON behind a header with its length, in both directions."""

from __future__ import annotations

import json
import threading
from typing import Any, BinaryIO

MAX_BYTES = 2**24
Message = dict[str, Any]


class ProtocolError(ValueError):
    """Bytes that are no message."""


class Channel:
    """Reads requests, and writes responses and events, from any thread.

    Parameters
    ----------
    read, write
        Streams of bytes.
    """

    def __init__(self, read: BinaryIO, write: BinaryIO) -> None:
        self._read, self._write = read, write
        self._lock = threading.Lock()
        self._count = 0

    def receive(self) -> Message | None:
        """Return the next message; None at the end.

        Raises
        ------
        ProtocolError
            Where the bytes are no message.
        """
        length = None
        while (line := self._read.readline()) not in (b"\r\n", b"\n"):
            if not line:
                return None
            name, _, value = line.partition(b":")
            if name.strip().lower() == b"content-length":
                try:
                    length = int(value)
                except ValueError:
                    raise ProtocolError(f"Content-Length is a number, not {value.strip()!r}") from None
        if length is None or not 0 <= length <= MAX_BYTES:
            raise ProtocolError(f"Content-Length is 0 to {MAX_BYTES}, not {length}")
        content = self._read.read(length)
        try:
            message = json.loads(content)
        except ValueError:
            raise ProtocolError("the content is no JSON") from None
        if not isinstance(message, dict):
            raise ProtocolError("the content is no JSON object")
        return message

    def event(self, name: str, **body: Any) -> None:
        """Write an event."""
        self._send({"type": "event", "event": name, "body": body})

    def respond(self, request: Message, body: Message | None = None, error: str = "") -> None:
        """Write the response to a request, or that it has failed."""
        response = {"type": "response", "request_seq": request.get("seq", 0), "command": request.get("command", "")}
        response["success"] = not error
        if error:
            response["message"] = error
            response["body"] = {"error": {"id": 1, "format": error.replace("{", "(").replace("}", ")")}}
        elif body is not None:
            response["body"] = body
        self._send(response)

    def _send(self, message: Message) -> None:
        with self._lock:
            self._count += 1
            content = json.dumps({"seq": self._count, **message}).encode()
            self._write.write(b"Content-Length: %d\r\n\r\n%s" % (len(content), content))
            self._write.flush()
