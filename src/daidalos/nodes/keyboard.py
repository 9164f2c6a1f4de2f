"""Key presses of the terminal, without waiting for Enter."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from typing import Any, Self

from daidalos.nodes.runner import UserError

_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
_WINDOWS_ARROWS = {"H": "up", "P": "down", "M": "right", "K": "left"}
_INTERRUPT = "\x03"
_SEQUENCE_S = 0.05  # within which the rest of an escape sequence comes
_POLL_S = 0.02  # on Windows, where a console cannot be waited for together with anything else


class Keyboard:
    """Keyboard of this process's terminal within a ``with`` block.

    The terminal is as it was before at the end, however the program ends.

    Raises
    ------
    UserError
        When standard input is not a terminal.
    """

    def __init__(self) -> None:
        if not sys.stdin.isatty():
            raise UserError("the keys are read from standard input, which is not a terminal: run this in a terminal")
        self._before: Any = None
        self._continued: Any = None
        self._woken = threading.Event()
        self._pipe: tuple[int, int] | None = None

    def __enter__(self) -> Self:
        if sys.platform != "win32":
            import termios

            self._pipe = os.pipe()
            self._before = termios.tcgetattr(sys.stdin)
            self._take_keys()
            if threading.current_thread() is threading.main_thread():
                # Who comes back after Ctrl-Z finds the terminal as the shell had it.
                self._continued = signal.signal(signal.SIGCONT, lambda *_: self._take_keys())
        return self

    def __exit__(self, *exception: object) -> None:
        if sys.platform != "win32" and self._pipe is not None:
            import termios

            if self._continued is not None:
                signal.signal(signal.SIGCONT, self._continued)
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, self._before)
            for end in self._pipe:
                os.close(end)
            self._pipe = None

    def _take_keys(self) -> None:
        """Configure the terminal to pass each key at once, without echo."""
        if sys.platform != "win32":
            import termios

            wanted = termios.tcgetattr(sys.stdin)
            wanted[3] &= ~(termios.ICANON | termios.ECHO)  # Ctrl-C stays a signal
            # Ctrl-C discards keys that `select` may have told of already: reading must not wait for others.
            wanted[6][termios.VMIN] = wanted[6][termios.VTIME] = 0
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, wanted)

    def wake(self) -> None:
        """Make `read` return None from now on; may be called from any thread."""
        self._woken.set()
        if self._pipe is not None:
            os.write(self._pipe[1], b"\0")

    def read(self, timeout_s: float | None = None) -> str | None:
        """Wait for a key.

        Returns
        -------
        str, optional
            The character, or ``up``, ``down``, ``left``, ``right``; empty when no key came in time; None when
            there are no more.
        """
        return self._read_console(timeout_s) if sys.platform == "win32" else self._read_terminal(timeout_s)

    def _read_terminal(self, timeout_s: float | None) -> str | None:
        import select

        assert self._pipe is not None, "read within the with block"
        character: str | None = ""
        while character == "":
            if self._woken.is_set():
                return None
            ready = select.select([sys.stdin, self._pipe[0]], [], [], timeout_s)[0]
            if self._woken.is_set():
                return None
            character = self._next_character() if ready else ""
            if character == "" and timeout_s is not None:
                return ""
        if character != "\x1b":
            return character
        sequence = ""
        while select.select([sys.stdin], [], [], _SEQUENCE_S)[0]:
            last = self._character()
            sequence += last
            if sequence[:1] not in ("[", "O") or (len(sequence) > 1 and (last.isalpha() or last == "~")) or not last:
                break
        return _ARROWS.get(sequence[-1:], "") if sequence[:1] in ("[", "O") else character

    def _next_character(self) -> str | None:
        """Return one character, an empty text where there is none after all, None where the terminal is gone."""
        import select

        character = self._character()
        if character or not select.select([sys.stdin], [], [], 0.0)[0]:
            return character
        return self._character() or None

    def _character(self) -> str:
        """Return one character; not through the buffer of `sys.stdin`, which `select` does not see."""
        import select

        content = os.read(sys.stdin.fileno(), 1)
        while content and content[0] >= 0xC0 and not _is_whole(content):
            if not select.select([sys.stdin], [], [], _SEQUENCE_S)[0]:
                break
            content += os.read(sys.stdin.fileno(), 1)
        return content.decode(errors="replace")

    def _read_console(self, timeout_s: float | None) -> str | None:
        import msvcrt

        console: Any = msvcrt  # whose functions exist on Windows alone
        until = None if timeout_s is None else time.monotonic() + timeout_s
        while not console.kbhit():
            if self._woken.wait(_POLL_S):
                return None
            if until is not None and time.monotonic() > until:
                return ""
        character = str(console.getwch())
        if character == _INTERRUPT:
            raise KeyboardInterrupt
        return _WINDOWS_ARROWS.get(console.getwch(), "") if character in ("\0", "\xe0") else character


def _is_whole(content: bytes) -> bool:
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True
