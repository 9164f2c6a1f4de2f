"""Game pads through Linux's joystick interface.

See `Documentation/input/joydev/joystick-api.rst` of the Linux kernel.
"""

from __future__ import annotations

import os
import re
import select
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self, TypeVar

FOLDER = Path("/dev/input")

N = TypeVar("N", int, float)

_EVENT = struct.Struct("=IhBB")  # time [ms], value, kind, number
_BUTTON, _AXIS, _INITIAL = 0x01, 0x02, 0x80
_READ_NAME = (2 << 30) | (128 << 16) | (ord("j") << 8) | 0x13
_FULL = 32767.0


@dataclass(frozen=True)
class Event:
    """Change of a button or an axis; `value` is 1 or 0, or from -32767 to 32767."""

    is_button: bool
    number: int
    value: int
    is_initial: bool = False


@dataclass
class Controls:
    """State of the axes and buttons of a game pad.

    Attributes
    ----------
    axes : list of float
        From -1 to 1; left and up are positive.
    buttons : list of int
        1 where pressed.

    Parameters
    ----------
    deadzone : float
        The share of an axis around its centre that counts as its centre.
    sticky_buttons : bool
        Whether a button changes when it is pressed only, as a switch does.
    """

    deadzone: float = 0.05
    sticky_buttons: bool = False
    axes: list[float] = field(default_factory=list)
    buttons: list[int] = field(default_factory=list)

    def apply(self, event: Event) -> None:
        """Apply a change."""
        if not event.is_button:
            _put(self.axes, event.number, self._scaled(event.value), 0.0)
        elif not self.sticky_buttons or event.is_initial:
            _put(self.buttons, event.number, int(event.value != 0), 0)
        elif event.value:
            before = self.buttons[event.number] if event.number < len(self.buttons) else 0
            _put(self.buttons, event.number, 1 - before, 0)

    def _scaled(self, value: int) -> float:
        share = max(-1.0, value / _FULL)
        if abs(share) <= self.deadzone:
            return 0.0
        beyond = (abs(share) - self.deadzone) / (1.0 - self.deadzone)
        return -beyond if share > 0 else beyond


class Joystick:
    """Game pad that is read within a ``with`` block.

    Parameters
    ----------
    path
        Its file.

    Raises
    ------
    OSError
        If it cannot be read, also later when it was unplugged.
    """

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        self._wake, self._waker = os.pipe()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        for descriptor in (self._file, self._wake, self._waker):
            os.close(descriptor)

    def wake(self) -> None:
        """Wake `read` in its thread."""
        os.write(self._waker, b"\0")

    def read(self, coalesce: float = 0.0) -> list[Event]:
        """Wait for events and return them; none when it was woken.

        Parameters
        ----------
        coalesce
            For how long [s] to wait for further events where axes alone have moved.
        """
        ready, _, _ = select.select([self._file, self._wake], [], [])
        if self._wake in ready:
            return []
        events = list(self._events())
        if coalesce > 0 and not any(event.is_button for event in events):
            select.select([self._wake], [], [], coalesce)
            events += self._events()
        return events

    def _events(self) -> Iterator[Event]:
        try:
            content = os.read(self._file, 64 * _EVENT.size)
        except BlockingIOError:
            return
        if not content:
            raise OSError("the joystick is gone")
        for _, value, kind, number in _EVENT.iter_unpack(content[: len(content) // _EVENT.size * _EVENT.size]):
            if kind & (_BUTTON | _AXIS):
                yield Event(bool(kind & _BUTTON), number, value, bool(kind & _INITIAL))


def devices(folder: Path = FOLDER) -> list[Path]:
    """Return the files of the game pads, by number."""
    found = [path for path in folder.glob("js*") if re.fullmatch(r"js\d+", path.name)]
    return sorted(found, key=lambda path: int(path.name[2:]))


def device_name(path: Path) -> str:
    """Return what a game pad calls itself; empty where it does not tell."""
    import fcntl

    content = bytearray(128)
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    except OSError:
        return ""
    try:
        fcntl.ioctl(descriptor, _READ_NAME, content)
    except OSError:
        return ""
    finally:
        os.close(descriptor)
    return content.partition(b"\0")[0].decode(errors="replace")


def _put(values: list[N], place: int, value: N, filler: N) -> None:
    values.extend([filler] * (place + 1 - len(values)))
    values[place] = value
