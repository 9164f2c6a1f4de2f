"""A robot on a simulated KUKA controller as hardware of ros2_control, by RSI over UDP."""

from __future__ import annotations

import math
import socket
import threading
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from daidalos.control.errors import HardwareError
from daidalos.control.extensions import hardware_class
from daidalos.description import urdf
from daidalos.description.ros2_control import HardwareInfo, read_hardware
from daidalos.industry.robots.kuka import joint_angles
from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.rsi.controller import ControllerSettings, SimulatedController
from daidalos.industry.rsi.controller_server import ControllerServer
from daidalos.interfaces.library import BUILT_IN
from daidalos.nodes.packages import package_share

SHARE = BUILT_IN / "kr500_2mt_description"
AXES = np.array([10.0, -80.0, 100.0, 0.0, 45.0, -20.0])


def described(**parameters: str) -> HardwareInfo:
    (info,) = read_hardware(urdf.load(SHARE / "urdf/rsi.urdf.xacro", resolve=package_share))
    return replace(info, parameters=info.parameters | parameters)


class Moving:
    """A controller that runs in a thread of its own until it is stopped."""

    def __init__(self) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            one.bind(("127.0.0.1", 0))
            self.port = int(one.getsockname()[1])
        settings = ControllerSettings(cycle=0.004, relative=False, axis_limit=20.0, max_lost=250)
        configuration = read_configuration(SHARE / "config/rsi/joints.xml")
        self.robot = SimulatedController(configuration, lambda _: np.zeros(6), settings, AXES)
        self._thread = threading.Thread(target=self._run)

    def start(self) -> None:
        self._thread.start()

    def _run(self) -> None:
        with ControllerServer(self.robot, "127.0.0.1", self.port) as server:
            server.wait_for_partner(30.0)
            server.run(30.0)

    def stop(self) -> None:
        self.robot.stopped = "the test is over"
        self._thread.join()


@pytest.fixture
def moving() -> Iterator[Moving]:
    one = Moving()
    yield one
    if one._thread.is_alive():
        one.stop()


def until(hardware: object, moving: Moving, holds: object, cycles: int = 3000) -> None:
    for _ in range(cycles):
        hardware.read(0, 0.001)  # type: ignore[attr-defined]
        if holds():  # type: ignore[operator]
            return
        threading.Event().wait(0.004)
    raise AssertionError(f"it did not become true: {moving.robot.axes}, {moving.robot.stopped}")


@pytest.mark.slow
def test_joints_are_read_and_commanded(moving: Moving) -> None:
    info = described(client_port=str(moving.port), timeout="20")
    hardware = hardware_class(info)(info)
    moving.start()
    hardware.configure()
    try:
        assert [hardware.states[f"joint_{one}/position"] for one in range(1, 7)] == pytest.approx(
            joint_angles(np.radians(AXES)).tolist(), abs=1e-6
        )
        hardware.activate()
        hardware.write(0, 0.004)
        start = float(hardware.states["joint_1/position"])
        hardware.commands["joint_1/position"] = start - math.radians(2.0)
        hardware.write(0, 0.004)
        until(hardware, moving, lambda: abs(moving.robot.axes[0] - 12.0) < 0.01)
        assert moving.robot.axes[1:] == pytest.approx(AXES[1:], abs=1e-6)
        assert hardware.states["joint_1/position"] == pytest.approx(start - math.radians(2.0), abs=1e-3)
        hardware.commands["joint_2/position"] = math.inf
        with pytest.raises(HardwareError, match="not finite"):
            hardware.write(0, 0.004)
        moving.stop()
        hardware.read(0, 0.0)  # what came before the robot stopped
        with pytest.raises(HardwareError, match="no telegram of the robot for 21 s"):
            hardware.read(0, 21.0)
    finally:
        hardware.cleanup()


def test_a_robot_that_does_not_send_is_an_error(moving: Moving) -> None:
    info = described(client_port=str(moving.port), connect_timeout="0.1")
    hardware = hardware_class(info)(info)
    with pytest.raises(HardwareError, match="'kuka': no telegram of the robot came"):
        hardware.configure()


@pytest.mark.parametrize(
    ("parameters", "problem"),
    [
        ({"axes": "both"}, "axes is 'both', but direct or arm is expected"),
        ({"timeout": "nan"}, "timeout is 'nan', but must be greater than 0"),
        ({"max_speed": "-1"}, "max_speed is '-1'"),
    ],
)
def test_wrong_parameters_are_named(parameters: dict[str, str], problem: str) -> None:
    info = described(**parameters)
    with pytest.raises(HardwareError, match=problem):
        hardware_class(info)(info)
