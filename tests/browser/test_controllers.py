"""The panel of controllers, in a real browser."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (700, 500)
_DOMAIN = 100 + os.getpid() % 100
_ROBOT = """<robot name="r"><link name="a"/><link name="b"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
  <ros2_control name="motors" type="system"><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="j"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control></robot>"""
_PARAMETERS = f"""
/controller_manager:
  ros__parameters:
    robot_description: '{_ROBOT}'
    states.type: joint_state_broadcaster/JointStateBroadcaster
"""


@pytest.fixture
def manager(tmp_path: Path) -> Iterator[None]:
    file = tmp_path / "parameters.yaml"
    file.write_text(_PARAMETERS, encoding="utf-8")
    node = ("run", "controller_manager", "ros2_control_node", "--ros-args", "--params-file", str(file))
    with (
        Terminal(*node, domain=_DOMAIN),
        Terminal("run", "controller_manager", "spawner", "states", domain=_DOMAIN) as spawner,
    ):
        spawner.wait_for("Configured and activated states")
        yield


def _state(name: str) -> str:
    return f"document.querySelector('[data-name={name}]')?.dataset.state"


def test_controllers_and_hardware_are_started_and_stopped(browser: Chromium, manager: None) -> None:
    words = ("run", "rqt_controller_manager", "rqt_controller_manager", "--headless", "--port", "0")
    with Terminal(*words, domain=_DOMAIN) as studio:
        browser.open(studio.wait_for("^window: ")[0].split()[1])
        browser.wait_for(f"{_state('states')} === 'active'")
        browser.wait_for(f"{_state('motors')} === 'active'")
        browser.click_on("[data-name=states] [data-step=deactivate]")
        browser.wait_for(f"{_state('states')} === 'inactive'")
        browser.click_on("[data-name=motors] button")
        browser.wait_for(f"{_state('motors')} === 'inactive'")
        browser.click_on("[data-name=states] [data-step=cleanup]")
        browser.wait_for(f"{_state('states')} === 'unconfigured'")
        browser.click_on("[data-name=states] [data-step=unload]")
        browser.wait_for("!document.querySelector('[data-name=states]')")
        assert browser.errors == []
        browser.open("about:blank")  # before its server ends
