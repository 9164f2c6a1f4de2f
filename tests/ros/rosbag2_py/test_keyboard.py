import os
import pty
import select
import sys
import threading

import pytest
from rosbag2_py._keyboard import DOWN, PAGE_DOWN, PAGE_UP, RIGHT, SPACE, UP, Keyboard, split_keys


def test_keys_that_a_terminal_sends():
    assert split_keys(b" x\x1b[A\x1b[B\x1b[C\x1bOA") == [SPACE, UP, DOWN, RIGHT, UP]
    assert split_keys(b"\x1b[5~\x1b[6~\x1b[7~") == [PAGE_UP, PAGE_DOWN]
    assert split_keys(b"\x1b") == []
    assert split_keys(b"") == []


def test_keys_are_heard_and_the_terminal_is_as_before(monkeypatch):
    import termios

    ours, theirs = pty.openpty()
    received, told = [], threading.Event()

    def on_key(key):
        received.append(key)
        if len(received) == 3:
            told.set()

    before = termios.tcgetattr(theirs)
    with os.fdopen(theirs, "r") as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        keyboard = Keyboard(on_key)
        keyboard.start()
        while termios.tcgetattr(theirs)[3] & termios.ICANON:
            told.wait(0.01)
        os.write(ours, b" q\x1b[C ")
        assert told.wait(20)
        keyboard.stop()
        keyboard.stop()
        assert termios.tcgetattr(theirs) == before
    os.close(ours)
    assert received == [SPACE, RIGHT, SPACE]


def test_keys_that_ctrl_c_discards_are_not_waited_for(monkeypatch):
    import termios

    ours, theirs = pty.openpty()
    wait, flushed = select.select, threading.Event()

    def flush_once(*arguments):
        ready = wait(*arguments)
        if theirs in ready[0] and not flushed.is_set():
            termios.tcflush(theirs, termios.TCIFLUSH)  # as the terminal does at Ctrl-C
            flushed.set()
        return ready

    with os.fdopen(theirs, "r") as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        monkeypatch.setattr(select, "select", flush_once)
        keyboard = Keyboard(lambda key: None)
        keyboard.start()
        while termios.tcgetattr(theirs)[6][termios.VMIN] != 0:  # the last of its settings
            flushed.wait(0.01)
        os.write(ours, b" ")
        assert flushed.wait(20)
        stopper = threading.Thread(target=keyboard.stop, daemon=True)
        stopper.start()
        stopper.join(20)
        assert not stopper.is_alive()
    os.close(ours)


@pytest.mark.parametrize("stdin", [None, "file"])
def test_nothing_is_done_without_a_terminal(monkeypatch, tmp_path, stdin):
    (tmp_path / "file").touch()
    with (tmp_path / "file").open() as file:
        monkeypatch.setattr(sys, "stdin", file if stdin else None)
        keyboard = Keyboard(lambda key: None)
        keyboard.start()
        keyboard.stop()
