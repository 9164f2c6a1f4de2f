"""The window of joint_state_publisher_gui in a real browser."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from browser.cdp import Chromium
from daidalos.nodes.packages import package_share
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (420, 720)
_DOMAIN = 100 + os.getpid() % 100
_JOINTS = "[...document.querySelectorAll('[data-joint]')]"
_VALUES = f"{_JOINTS}.map((each) => Number(each.querySelector('.range-value').value))"


def _echo_position(wanted: str) -> None:
    with Terminal("topic", "echo", "--once", "--filter", wanted, "/joint_states", domain=_DOMAIN) as echo:
        assert echo.wait(30) == 0, echo.text


def test_sliders_set_joints(browser: Chromium) -> None:
    share = package_share("urdf_tutorial")
    assert share is not None
    robot = Path(share) / "urdf" / "robot_example.urdf"
    command = ("run", "joint_state_publisher_gui", "joint_state_publisher_gui", str(robot))
    with Terminal(*command, domain=_DOMAIN) as gui:
        url = gui.wait_for("^window: ")[0].split()[1]
        browser.open(url)
        browser.wait_for(f"{_JOINTS}.length > 3")
        assert browser.evaluate("document.title") == "Joints · Daidalos"
        first = browser.evaluate(f"{_JOINTS}[0].dataset.joint")
        start = browser.evaluate(_VALUES)

        box = browser.evaluate(
            f"(() => {{ const b = {_JOINTS}[0].querySelector('.slider').getBoundingClientRect();"
            " return [b.left, b.right, b.top + b.height / 2]; })()"
        )
        left, right, y = box
        browser.drag([(left + 0.5 * (right - left), y), (left + 0.7 * (right - left), y), (right - 4, y)])
        browser.wait_for(f"{_VALUES}[0] > {start[0]} + 0.1")
        value = browser.evaluate(f"{_VALUES}[0]")
        _echo_position(f"abs(m.position[list(m.name).index('{first}')] - {value}) < 0.002")

        browser.click_on("[data-test=randomize]")
        browser.wait_for(f"{_VALUES}.slice(1).some((value, i) => value !== {start}[i + 1])")
        browser.click_on("[data-test=center]")
        browser.wait_for(f"{_VALUES}.join() === '{','.join(f'{v:g}' for v in start)}'")
        assert browser.errors == []
        assert gui.interrupt() == 0
