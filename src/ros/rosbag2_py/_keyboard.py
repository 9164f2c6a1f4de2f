"""Keys pressed in the terminal, while something else goes on."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable

SPACE, UP, DOWN, RIGHT = "space", "up", "down", "right"
PAGE_UP, PAGE_DOWN = "page up", "page down"
_KEYS = {
    b" ": SPACE,
    b"\x1b[A": UP,
    b"\x1b[B": DOWN,
    b"\x1b[C": RIGHT,
    b"\x1bOA": UP,
    b"\x1bOB": DOWN,
    b"\x1bOC": RIGHT,
    b"\x1b[5~": PAGE_UP,
    b"\x1b[6~": PAGE_DOWN,
}
_WINDOWS_KEYS = {
    " ": SPACE,
    **{f"{first}H": UP for first in "\0\xe0"},
    **{f"{first}P": DOWN for first in "\0\xe0"},
    **{f"{first}M": RIGHT for first in "\0\xe0"},
    **{f"{first}I": PAGE_UP for first in "\0\xe0"},
    **{f"{first}Q": PAGE_DOWN for first in "\0\xe0"},
}
_WINDOWS_PAUSE_S = 0.05


class Keyboard:
    """Keyboard of the terminal, whose keys call functions; without effect where there is no terminal.

    Parameters
    ----------
    on_key
        Called with `SPACE`, `UP`, `DOWN`, `RIGHT`, `PAGE_UP` or `PAGE_DOWN`, on a thread of its own.
    """

    def __init__(self, on_key: Callable[[str], None]) -> None:
        self._on_key = on_key
        self._thread: threading.Thread | None = None
        self._ended = threading.Event()

    def start(self) -> None:
        """Start listening to the keyboard."""
        if not sys.stdin or not sys.stdin.isatty():
            return
        self._wake, self._waker = os.pipe()
        listen = self._listen_windows if sys.platform == "win32" else self._listen
        self._thread = threading.Thread(target=listen, name="keyboard", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Listen no more; the terminal is as it was before."""
        if self._thread is None:
            return
        self._ended.set()
        os.write(self._waker, b"x")
        self._thread.join()
        self._thread = None
        os.close(self._wake)
        os.close(self._waker)

    def _listen(self) -> None:
        if sys.platform == "win32":
            return
        import select
        import termios
        import tty

        terminal = sys.stdin.fileno()
        before = termios.tcgetattr(terminal)
        try:
            tty.setcbreak(terminal)
            wanted = termios.tcgetattr(terminal)
            # Ctrl-C discards keys that `select` may have reported already: reading must not wait for others.
            wanted[6][termios.VMIN] = 0
            termios.tcsetattr(terminal, termios.TCSANOW, wanted)
            while not self._ended.is_set():
                ready, _, _ = select.select([terminal, self._wake], [], [])
                if self._wake in ready:
                    return
                pressed = os.read(terminal, 64)
                if not pressed and select.select([terminal], [], [], 0.0)[0]:
                    pressed = os.read(terminal, 64)
                    if not pressed:
                        return  # the terminal is gone
                for key in split_keys(pressed):
                    self._on_key(key)
        finally:
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)

    def _listen_windows(self) -> None:
        if sys.platform != "win32":
            return
        import msvcrt

        while not self._ended.wait(_WINDOWS_PAUSE_S):
            while msvcrt.kbhit():
                pressed = msvcrt.getwch()
                if pressed in ("\0", "\xe0"):
                    pressed += msvcrt.getwch()
                if pressed in _WINDOWS_KEYS:
                    self._on_key(_WINDOWS_KEYS[pressed])


def split_keys(data: bytes) -> list[str]:
    """Return the keys that a terminal sent; what means nothing here is left out."""
    found = []
    while data:
        length = next((len(code) for code in _KEYS if data.startswith(code)), 0)
        if length:
            found.append(_KEYS[data[:length]])
        data = data[length or 1 :]
    return found
