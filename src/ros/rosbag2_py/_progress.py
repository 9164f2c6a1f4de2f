"""The line in the terminal that shows how far something is."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable

_CLEAR = "\r\033[K"


class StatusLine:
    """Text in the terminal's last line that is refreshed; without effect where there is no terminal.

    Parameters
    ----------
    text
        Returns what is shown.
    rate
        How often it is refreshed [Hz]; 0 for not at all.
    """

    def __init__(self, text: Callable[[], str], rate: float) -> None:
        self._text = text
        self._period_s = 1.0 / rate if rate > 0 else 0.0
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, *heading: str) -> None:
        """Start the display, below lines that stay."""
        if self._period_s == 0.0 or not sys.stdout.isatty():
            return
        for line in heading:
            self._write(f"{line}\n")
        self._thread = threading.Thread(target=self._refresh, name="status line", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Stop the display; the last text stays."""
        if self._thread is None:
            return
        self._ended.set()
        self._thread.join()
        self._thread = None
        self._write(f"{_CLEAR}{self._text()}\n")

    def _refresh(self) -> None:
        while True:
            self._write(f"{_CLEAR}{self._text()}")
            if self._ended.wait(self._period_s):
                return

    def _write(self, text: str) -> None:
        sys.stdout.write(text)
        sys.stdout.flush()
