"""The hardware of ros2_control on a simulated controller: it follows commands, and says when the controller is lost."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.control.contracts import HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.control.extensions import hardware_class
from daidalos.description import urdf
from daidalos.description.ros2_control import read_hardware
from daidalos.industry.egm import client as egm_client
from daidalos.industry.egm.controller import EgmSettings, GuidedController
from daidalos.industry.egm.controller_server import EgmControllerServer
from daidalos.industry.robots import ARMS
from description.robots import SHARE, share_of

PERIOD = 0.004
START = [0, 0, 0, 0, 30, 0]


@pytest.fixture(scope="module")
def info():
    robot = urdf.load(SHARE / "industrial_arm_description/urdf/egm.urdf.xacro", {"egm_port": "0"}, share_of)
    return read_hardware(robot)[0]


@pytest.fixture
def cell(info, monkeypatch):
    """Return hardware that is configured, the controller, and its server."""
    controller = GuidedController(ARMS["irb120"], settings=EgmSettings(communication_timeout=0.1, waits=True))
    made = []

    class Client(egm_client.EgmClient):
        def __init__(self, address, port, peer):
            super().__init__(address, 0, peer)
            made.append(EgmControllerServer(controller, "127.0.0.1", self.port))
            made[0].cycle()

    monkeypatch.setattr("daidalos.nodes.abb_hardware_interface._hardware.EgmClient", Client)
    hardware = hardware_class(info)(info, HardwareContext(250.0))
    hardware.configure()
    yield hardware, controller, made[0]
    hardware.cleanup()
    with made[0]:
        pass


def cycle(cell, **commands):
    hardware, _, server = cell
    server.cycle()
    hardware.read(0, PERIOD)
    for name, value in commands.items():
        hardware.commands[f"{name}/position"] = value
    hardware.write(0, PERIOD)


def test_states_are_those_of_the_controller(cell):
    hardware, controller, _ = cell
    found = [hardware.states[f"joint_{number}/position"] for number in range(1, 7)]
    np.testing.assert_allclose(np.degrees(found), START, atol=1e-9)
    hardware.activate()
    for number in range(60):
        cycle(cell, joint_1=0.002 * number)
    assert hardware.states["joint_1/velocity"] == pytest.approx(0.5, abs=1e-6)
    assert controller.joints[0] == pytest.approx(0.002 * 58, abs=1e-9)
    np.testing.assert_allclose(np.degrees(controller.joints[1:]), START[1:], atol=1e-9)


def test_nothing_is_sent_before_it_is_active_and_nothing_moves_before_a_command(cell):
    hardware, controller, _ = cell
    for _ in range(5):
        cycle(cell, joint_1=1.0)
    assert controller.time > 0.0
    np.testing.assert_allclose(np.degrees(controller.joints), START, atol=1e-9)
    hardware.activate()
    for _ in range(5):
        cycle(cell)
    np.testing.assert_allclose(np.degrees(controller.joints), START, atol=1e-9)


def test_a_silent_controller_is_an_error(cell):
    hardware = cell[0]
    hardware.activate()
    cycle(cell)
    hardware.read(0, 0.5)
    hardware.read(0, 0.5)
    with pytest.raises(HardwareError, match=r"'abb': no message of the controller for 1\.1 s"):
        hardware.read(0, 0.1)


def test_a_controller_that_has_stopped_is_an_error(cell):
    hardware = cell[0]
    hardware.activate()
    cycle(cell, joint_5=np.radians(130.0))
    with pytest.raises(HardwareError, match="'abb': the controller has stopped guided motion"):
        cycle(cell)


def test_a_command_that_is_infinite_is_an_error_and_not_sent(cell):
    hardware, controller, _ = cell
    hardware.activate()
    with pytest.raises(HardwareError, match="not finite is not sent"):
        cycle(cell, joint_1=np.inf)
    assert controller.refused == 0


def test_a_controller_that_never_sends_is_one_line(info, monkeypatch):
    monkeypatch.setattr("daidalos.nodes.abb_hardware_interface._hardware._CONNECT_S", 0.05)
    hardware = hardware_class(info)(info)
    with pytest.raises(HardwareError, match=r"no message of a controller came within 0\.05 s"):
        hardware.configure()


def test_two_units_of_a_multimove_system_are_one_hardware(info, monkeypatch):
    controllers = [GuidedController(ARMS["irb120"], np.radians([angle, 0, 0, 0, 30, 0])) for angle in (10, -10)]
    servers = []

    class Client(egm_client.EgmClient):
        def __init__(self, address, port, peer):
            super().__init__(address, 0, peer)
            servers.append(EgmControllerServer(controllers[len(servers)], "127.0.0.1", self.port))
            servers[-1].cycle()

    monkeypatch.setattr("daidalos.nodes.abb_hardware_interface._hardware.EgmClient", Client)
    joints = info.joints
    others = [replace(joint, name=f"other_{joint.name}") for joint in joints]
    ports = {"rob1egm_port": "6511", "rob2egm_port": "6512"}
    both = replace(info, components=(*joints, *others), parameters=ports)
    hardware = hardware_class(both)(both)
    hardware.configure()
    hardware.activate()
    assert hardware.states["joint_1/position"] == pytest.approx(np.radians(10))
    assert hardware.states["other_joint_1/position"] == pytest.approx(np.radians(-10))
    for _ in range(30):
        hardware.commands["other_joint_1/position"] = 0.0
        hardware.write(0, PERIOD)
        for server in servers:
            server.cycle()
        hardware.read(0, PERIOD)
    assert np.degrees(controllers[0].joints[0]) == pytest.approx(10)
    assert controllers[1].joints[0] == pytest.approx(0.0, abs=1e-9)
    hardware.cleanup()
    for server in servers:
        with server:
            pass
