"""Game pads as files: events, and what they amount to."""

from __future__ import annotations

import os
import struct
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.nodes.joystick import Controls, Event, Joystick, device_name, devices

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux has such files")


def written(*events: Event) -> bytes:
    """The bytes of events, as `struct js_event` of the kernel's header joystick.h."""
    kinds = [(1 if event.is_button else 2) | (0x80 if event.is_initial else 0) for event in events]
    return b"".join(
        struct.pack("=IhBB", 7, event.value, kind, event.number) for event, kind in zip(events, kinds, strict=True)
    )


class Pad:
    """A pipe that is read as a game pad, with the end at which it is played."""

    def __init__(self, path: Path) -> None:
        self.path = path
        os.mkfifo(path)
        self._end = os.open(path, os.O_RDWR)

    def play(self, *events: Event) -> None:
        os.write(self._end, written(*events))

    def unplug(self) -> None:
        if self._end >= 0:
            self.path.unlink(missing_ok=True)
            os.close(self._end)
            self._end = -1


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[Pad]:
    pad = Pad(tmp_path / "js0")
    yield pad
    pad.unplug()


def test_what_was_played_is_read(pad: Pad) -> None:
    events = [Event(False, 1, -32767, True), Event(True, 3, 1), Event(False, 0, 12), Event(True, 3, 0)]
    with Joystick(pad.path) as joystick:
        pad.play(*events)
        assert joystick.read() == events


@pytest.mark.slow
def test_axes_are_waited_for_but_buttons_are_not(pad: Pad) -> None:
    with Joystick(pad.path) as joystick:
        pad.play(Event(False, 0, 1))
        later = threading.Timer(0.05, pad.play, [Event(False, 1, 2)])
        later.start()
        assert joystick.read(coalesce=0.5) == [Event(False, 0, 1), Event(False, 1, 2)]
        pad.play(Event(True, 0, 1))
        assert joystick.read(coalesce=1000.0) == [Event(True, 0, 1)]
        later.join()


def test_who_waits_can_be_woken(pad: Pad) -> None:
    with Joystick(pad.path) as joystick:
        later = threading.Timer(0.05, joystick.wake)
        later.start()
        assert joystick.read() == []
        later.join()


def test_a_pad_that_is_unplugged(pad: Pad) -> None:
    with Joystick(pad.path) as joystick:
        pad.unplug()
        with pytest.raises(OSError, match="gone"):
            joystick.read()


def test_the_pads_of_a_machine(tmp_path: Path) -> None:
    for name in ("js10", "js2", "jstick", "event0", "js"):
        (tmp_path / name).touch()
    assert [path.name for path in devices(tmp_path)] == ["js2", "js10"]
    assert device_name(tmp_path / "js2") == ""
    assert device_name(tmp_path / "js3") == ""
    assert devices(tmp_path / "nowhere") == []


@given(st.integers(-32768, 32767), st.sampled_from([0.0, 0.05, 0.3]))
def test_an_axis_goes_from_1_at_the_left_to_minus_1(value: int, deadzone: float) -> None:
    controls = Controls(deadzone)
    controls.apply(Event(False, 2, value))
    assert controls.axes[:2] == [0.0, 0.0]
    share = -max(value, -32767) / 32767
    expected = 0.0 if abs(share) <= deadzone else (share - deadzone * (1 if share > 0 else -1)) / (1 - deadzone)
    assert controls.axes[2] == pytest.approx(expected, abs=1e-12)
    assert -1.0 <= controls.axes[2] <= 1.0


@pytest.mark.parametrize(("sticky", "expected"), [(False, [1, 0, 1, 0]), (True, [1, 1, 0, 0])])
def test_buttons(sticky: bool, expected: list[int]) -> None:
    controls = Controls(sticky_buttons=sticky)
    controls.apply(Event(True, 4, 0, True))
    states = []
    for value in (1, 0, 1, 0):
        controls.apply(Event(True, 4, value))
        states.append(controls.buttons[4])
    assert states == expected
    assert controls.buttons[:4] == [0, 0, 0, 0]
