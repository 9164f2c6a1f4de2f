"""A moving head as hardware of ros2_control: what is commanded leaves as Art-Net, and comes back as states."""

from __future__ import annotations

import math
import socket
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest

from daidalos.control.errors import HardwareError
from daidalos.control.extensions import hardware_class
from daidalos.description import urdf
from daidalos.description.ros2_control import HardwareInfo, read_hardware
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.interfaces.library import BUILT_IN


@pytest.fixture
def receiver() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(20.0)
        yield one


def described(**parameters: str) -> HardwareInfo:
    """Return the element of the built-in head, with parameters."""
    (info,) = read_hardware(urdf.load(BUILT_IN / "daidalos_lighting" / "urdf" / "moving_head.urdf"))
    return replace(info, parameters=parameters)


def test_commands_become_levels_and_states(receiver: socket.socket) -> None:
    info = described(artnet_port=str(receiver.getsockname()[1]))
    hardware = hardware_class(info)(info)
    hardware.configure()
    hardware.activate()
    hardware.commands["pan_joint/position"] = math.radians(90.0)
    hardware.write(0, 0.02)
    hardware.commands["tilt_joint/position"] = math.radians(-45.0)
    hardware.write(0, 0.02)
    speeds, end = [], time.monotonic() + 20.0
    while abs(hardware.states["pan_joint/position"] - math.radians(90.0)) > 1e-3:
        assert time.monotonic() < end
        receiver.recv(2048)
        hardware.read(0, 0.02)
        speeds.append(hardware.states["pan_joint/velocity"])
    assert max(speeds) > 0.0
    head = read_configuration(DEFAULT).make_heads()[0]
    while True:
        data = artnet.parse_dmx(receiver.recv(2048)).data[: head.last]
        found = head.angles_of(data)
        if abs(math.degrees(found.tilt) + 45.0) < 0.01:
            break
    assert math.degrees(found.pan) == pytest.approx(90.0, abs=0.01)
    assert data[5] == 255
    hardware.commands["tilt_joint/position"] = 7.0
    with pytest.raises(HardwareError, match="out of range"):
        hardware.write(0, 0.02)
    hardware.cleanup()
    while data[5]:
        data = artnet.parse_dmx(receiver.recv(2048)).data


@pytest.mark.parametrize(
    ("parameters", "problem"),
    [
        ({"head": "sopt"}, "there is no head 'sopt'"),
        ({"config": "no.yaml"}, "no.yaml"),
        ({"artnet_port": "x"}, "invalid literal"),
        ({"artnet_port": "99999"}, "at most 65535"),
    ],
)
def test_faults_of_parameters_are_named(parameters: dict[str, str], problem: str) -> None:
    info = described(**parameters)
    with pytest.raises(HardwareError, match=problem):
        hardware_class(info)(info).configure()


def test_a_head_has_two_axes() -> None:
    info = described()
    with pytest.raises(HardwareError, match="needs two joints"):
        hardware_class(info)(replace(info, components=info.components[:1]))
