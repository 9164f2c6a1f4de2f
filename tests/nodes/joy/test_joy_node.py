"""The joystick nodes with a game pad that is a pipe."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Joy

from daidalos.common.parameters import ParameterError
from daidalos.nodes.joy import _node, joy_enumerate_devices
from daidalos.nodes.joy.joy_node import JoyNode
from daidalos.nodes.joy_linux.joy_linux_node import JoyLinuxNode
from daidalos.nodes.joystick import Event
from nodes.test_joystick import Pad

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux has such files")


class Listener:
    """Hears what game pads are at."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self.received: list[Joy] = []
        node.create_subscription(Joy, "joy", self.received.append, 10)

    def wait_for(self, condition: Callable[[Joy], bool]) -> Joy:
        for _ in range(100):
            if self.received and condition(self.received[-1]):
                return self.received[-1]
            rclpy.spin_once(self._node, timeout_sec=0.1)
        pytest.fail(f"received {self.received[-1:]}")


@pytest.fixture
def listener(node: Node) -> Listener:
    return Listener(node)


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[Pad]:
    pad = Pad(tmp_path / "js0")
    yield pad
    pad.unplug()


def started(kind: type[Any], folder: Path, **values: Any) -> Any:
    overrides = [Parameter(name, value=value) for name, value in {"autorepeat_rate": 0.0, **values}.items()]
    return kind(folder=folder, parameter_overrides=overrides)


def test_a_pad_is_published(listener: Listener, pad: Pad, tmp_path: Path) -> None:
    joy = started(JoyNode, tmp_path, deadzone=0.0)
    pad.play(Event(False, 0, 0, True), Event(False, 1, 0, True), Event(True, 0, 0, True), Event(True, 1, 0, True))
    listener.wait_for(lambda message: len(message.buttons) == 2)
    pad.play(Event(False, 1, -32767))
    message = listener.wait_for(lambda message: message.axes[1] == 1.0)
    assert (list(message.axes), list(message.buttons), message.header.frame_id) == ([0.0, 1.0], [0, 0], "joy")
    assert message.header.stamp.sec > 0
    pad.play(Event(True, 1, 1))
    listener.wait_for(lambda message: list(message.buttons) == [0, 1])
    joy.destroy_node()


def test_a_pad_may_come_later_and_go(listener: Listener, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_node, "_RETRY_S", 0.01)
    joy = started(JoyNode, tmp_path)
    for value in (1, 2):
        pad = Pad(tmp_path / "js0")
        pad.play(Event(True, value, 1))
        listener.wait_for(lambda message, count=value + 1: len(message.buttons) == count)
        pad.unplug()
    joy.destroy_node()


def test_what_does_not_change_is_said_again(listener: Listener, pad: Pad, tmp_path: Path) -> None:
    joy = started(JoyNode, tmp_path, autorepeat_rate=100.0)
    pad.play(Event(True, 0, 1))
    for _ in range(100):
        if len(listener.received) > 3:
            break
        rclpy.spin_once(joy, timeout_sec=0.1)
        rclpy.spin_once(listener._node, timeout_sec=0.0)
    assert {tuple(message.buttons) for message in listener.received} == {(1,)}
    assert len(listener.received) > 3
    joy.destroy_node()


def test_a_pad_that_is_given_as_a_file(listener: Listener, pad: Pad, tmp_path: Path) -> None:
    joy = started(JoyLinuxNode, tmp_path / "nowhere", dev=str(pad.path), dev_name="no such name", sticky_buttons=True)
    pad.play(Event(True, 0, 1), Event(True, 0, 0))
    listener.wait_for(lambda message: list(message.buttons) == [1])
    joy.destroy_node()


@pytest.mark.usefixtures("graph")
@pytest.mark.parametrize(("name", "value"), [("deadzone", 1.0), ("deadzone", -0.1), ("autorepeat_rate", 2000.0)])
def test_parameters_that_make_no_sense(tmp_path: Path, name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=f"parameter '{name}' of /joy_node must be .*, got {value:g}"):
        started(JoyNode, tmp_path, **{name: value})


@pytest.mark.usefixtures("graph")
def test_other_systems_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(RuntimeError, match="reads the files /dev/input/js"):
        started(JoyNode, tmp_path)


def test_the_pads_are_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(joy_enumerate_devices, "devices", list)
    assert joy_enumerate_devices.main() == 0
    monkeypatch.setattr(joy_enumerate_devices, "devices", lambda: [tmp_path / "js0"])
    os.mkfifo(tmp_path / "js0")
    assert joy_enumerate_devices.main() == 0
    none, head, line = capsys.readouterr().out.splitlines()
    assert none.startswith("No game pads")
    assert head == "ID : Device : Name"
    assert line.startswith(f" 0 : {tmp_path}/js0 :")
