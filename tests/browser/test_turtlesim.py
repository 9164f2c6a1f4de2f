"""Turtlesim's window in a real browser."""

from __future__ import annotations

import os

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (900, 960)
_DOMAIN = 100 + os.getpid() % 100
_TURTLES = "[...document.querySelectorAll('[data-turtle]')].map((each) => each.dataset.turtle).join()"
_COLOUR = "getComputedStyle(document.querySelector('.turtlesim-square')).backgroundColor"
_LILAC = (179, 184, 255)
_RED = (255, 10, 20)


def _ink(*colour: int) -> str:
    """Expression for how many pixels have a colour, or any where none is named; the browser rounds colours a bit."""
    return f"""(() => {{
        const canvas = document.querySelector(".turtlesim-square canvas");
        const {{ data }} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const wanted = {list(colour)};
        let count = 0;
        for (let i = 0; i < data.length; i += 4) {{
            count += data[i + 3] > 0 && wanted.every((each, k) => Math.abs(each - data[i + k]) < 5) ? 1 : 0;
        }}
        return count;
    }})()"""


def _ros2(*words: str) -> None:
    with Terminal(*words, domain=_DOMAIN) as command:
        assert command.wait(60) == 0, command.text


def _teleport(x: float, y: float) -> None:
    """Draw a straight line with the turtle's pen."""
    _ros2("service", "call", "/turtle1/teleport_absolute", "turtlesim/srv/TeleportAbsolute", f"{{x: {x}, y: {y}}}")


def test_window(browser: Chromium) -> None:
    with Terminal("run", "turtlesim", "turtlesim_node", domain=_DOMAIN) as simulator:
        url = simulator.wait_for("^window: ")[0].split()[1]
        browser.open(url)
        browser.wait_for(f"{_TURTLES} === 'turtle1'")
        assert browser.evaluate("document.title") == "TurtleSim · Daidalos"
        browser.wait_for(f"{_COLOUR} === 'rgb(69, 86, 255)'")

        _ros2("param", "set", "/turtlesim", "background_r", "150")
        browser.wait_for(f"{_COLOUR} === 'rgb(150, 86, 255)'")

        assert browser.evaluate(_ink()) == 0
        twist = "{linear: {x: 2.0}, angular: {z: 1.8}}"
        _ros2("topic", "pub", "--once", "/turtle1/cmd_vel", "geometry_msgs/msg/Twist", twist)
        browser.wait_for(f"{_ink(*_LILAC)} > 0")  # how far it drives depends on the machine's load
        _teleport(9.0, 3.0)
        browser.wait_for(f"{_ink(*_LILAC)} > 300")
        _ros2("service", "call", "/turtle1/set_pen", "turtlesim/srv/SetPen", "{r: 255, g: 10, b: 20, width: 9}")
        _teleport(9.0, 9.0)
        browser.wait_for(f"{_ink(*_RED)} > 1500")

        browser.reload()
        browser.wait_for(f"{_ink(*_RED)} > 1500 && {_ink(*_LILAC)} > 300")

        browser.click_on("[data-test=spawn]")
        browser.wait_for(f"{_TURTLES} === 'turtle1,turtle2'")
        browser.click_on("[data-test=clear]")
        browser.wait_for(f"{_ink()} === 0")
        browser.click_on("[data-test=reset]")
        browser.wait_for(f"{_TURTLES} === 'turtle1'")
        simulator.wait_for(r"\[turtlesim\]: Resetting turtlesim\.")

        assert simulator.interrupt() == 0
        browser.wait_for("!!document.querySelector('.turtlesim-note')")
    assert [error for error in browser.errors if "WebSocket" not in error] == []


def test_two_simulators_have_a_window_each(browser: Chromium) -> None:
    with Terminal("launch", "turtlesim", "multisim.launch.py", domain=_DOMAIN) as launched:
        lines = launched.wait_for("window: ", 2)
        urls = [line.split("window: ")[1] for line in lines]
        assert len({url.split("/?")[0] for url in urls}) == 2, "both have a server of their own"
        for url in urls:
            topic = url.split("window=")[1]
            browser.open(url)
            browser.wait_for(f"{_TURTLES} === 'turtle1'")
            assert (
                browser.evaluate("document.querySelector('.turtlesim strong').textContent") == topic.rpartition("/")[0]
            )
        assert launched.interrupt() == 0
