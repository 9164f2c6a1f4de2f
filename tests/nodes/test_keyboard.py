"""Keys as a terminal sends them."""

from __future__ import annotations

import io
import os
import pty
import select
import signal
import sys
import termios
import threading
from collections.abc import Iterator

import pytest

from daidalos.nodes.keyboard import Keyboard
from daidalos.nodes.runner import UserError


@pytest.fixture
def screen(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The near side of a terminal whose far side is standard input."""
    near, far = pty.openpty()
    with open(far, closefd=False) as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        yield near
    os.close(near)
    os.close(far)


@pytest.mark.parametrize(
    ("sent", "keys"),
    [
        ("a", ["a"]),
        ("Ab", ["A", "b"]),
        ("\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        ("\x1bOA", ["up"]),  # as terminals send it in application mode
        ("\x1b[1;5Cq", ["right", "q"]),  # with Ctrl
        ("\x1b[3~x", ["", "x"]),  # Delete means nothing
        ("ü€", ["ü", "€"]),
        ("\x1b", ["\x1b"]),
        ("\x1bxy", ["\x1b", "y"]),  # Alt+X
    ],
)
def test_keys(screen: int, sent: str, keys: list[str]) -> None:
    with Keyboard() as keyboard:
        os.write(screen, sent.encode())
        assert [keyboard.read(5.0) for _ in keys] == keys
        assert keyboard.read(0.0) == ""


def test_the_terminal_is_as_before(screen: int) -> None:
    before = termios.tcgetattr(sys.stdin)
    keyboard = Keyboard()
    with keyboard:
        changed = termios.tcgetattr(sys.stdin)
        assert not changed[3] & (termios.ECHO | termios.ICANON)
        assert changed[3] & termios.ISIG  # Ctrl-C stays a signal
    assert termios.tcgetattr(sys.stdin) == before


def test_it_can_be_woken(screen: int) -> None:
    with Keyboard() as keyboard:
        threading.Timer(0.05, keyboard.wake).start()
        assert keyboard.read() is None
        assert keyboard.read() is None


def test_keys_that_ctrl_c_discards_are_not_waited_for(screen: int, monkeypatch: pytest.MonkeyPatch) -> None:
    wait = select.select
    flushed = threading.Event()

    def flush_once(*arguments: object) -> object:
        ready = wait(*arguments)
        if not flushed.is_set():
            termios.tcflush(sys.stdin, termios.TCIFLUSH)  # as the terminal does at Ctrl-C
            flushed.set()
        return ready

    with Keyboard() as keyboard:
        os.write(screen, b"x")
        monkeypatch.setattr(select, "select", flush_once)
        read: list[str | None] = []
        reader = threading.Thread(target=lambda: read.append(keyboard.read()), daemon=True)
        reader.start()
        assert flushed.wait(10.0)
        keyboard.wake()
        reader.join(10.0)
        assert read == [None]


def test_no_more_keys(screen: int) -> None:
    with Keyboard() as keyboard:
        keyboard.wake()
        os.write(screen, b"a")
        assert keyboard.read() is None


def test_what_is_no_terminal_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("abc"))
    with pytest.raises(UserError, match="not a terminal"):
        Keyboard()


def test_it_goes_on_after_a_stop(screen: int) -> None:
    with Keyboard() as keyboard:
        shell = termios.tcgetattr(sys.stdin)
        shell[3] |= termios.ECHO | termios.ICANON
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, shell)
        signal.raise_signal(signal.SIGCONT)
        os.write(screen, b"a")
        assert keyboard.read(5.0) == "a"
