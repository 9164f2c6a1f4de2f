"""The editors of a node's parameters, in a real browser."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (420, 720)
_DOMAIN = 100 + os.getpid() % 100
_PROGRAM = """
import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node

rclpy.init()
node = Node("base")
node.declare_parameter("speed", 0.5, ParameterDescriptor(
    description="Top speed [m/s]", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.0)]))
node.declare_parameter("rounds", 3, ParameterDescriptor(
    integer_range=[IntegerRange(from_value=1, to_value=9, step=2)]))
node.declare_parameter("mode", "slow", ParameterDescriptor(additional_constraints="one of slow, fast"))
node.declare_parameter("holonomic", False)
node.declare_parameter("frame", "odom", ParameterDescriptor(read_only=True))
node.declare_parameter("gains", [1.0, 2.0])
node.declare_parameter("label", "a")

def check(parameters):
    bad = [one for one in parameters if one.name == "label" and one.value == "forbidden"]
    return SetParametersResult(successful=not bad, reason="label must not be 'forbidden'" if bad else "")

node.add_on_set_parameters_callback(check)
rclpy.spin(node)
"""


@pytest.fixture
def url(browser: Chromium) -> Iterator[str]:
    environment = {**os.environ, "ROS_DOMAIN_ID": str(_DOMAIN)}
    node = subprocess.Popen([sys.executable, "-c", _PROGRAM], env=environment)
    try:
        with Terminal(
            "run", "rqt_reconfigure", "rqt_reconfigure", "--headless", "--port", "0", domain=_DOMAIN
        ) as studio:
            yield studio.wait_for("^window: ")[0].split()[1]
            browser.open("about:blank")  # before its server ends
            assert studio.interrupt() == 0
    finally:
        node.kill()
        node.wait()


def _field(name: str, element: str = "input, select") -> str:
    return f"document.querySelector('[data-parameter={name}]')?.querySelector('{element}')"


def _enter(browser: Chromium, name: str, text: str, event: str = "change") -> None:
    browser.evaluate(
        f"(() => {{ const e = {_field(name)}; e.value = {text!r};"
        f" e.dispatchEvent(new Event({event!r}, {{ bubbles: true }})); }})()"
    )


def _get(name: str) -> str:
    with Terminal("param", "get", "/base", name, domain=_DOMAIN) as get:
        assert get.wait(30) == 0, get.text
        return get.text


def test_parameters_are_edited_as_their_descriptors_say(browser: Chromium, url: str) -> None:
    browser.open(f"{url}&node=/base")
    browser.wait_for(f"{_field('speed')}?.value === '0.500'", 60)
    assert browser.evaluate(f"{_field('speed', '.slider')}.max") == "2"
    assert browser.evaluate("document.querySelector('[data-parameter=speed] .unit').textContent") == "m/s"
    assert "Top speed" in browser.evaluate("document.querySelector('[data-parameter=speed]').title")
    assert browser.evaluate(f"{_field('rounds', '.slider')}.step") == "2"
    assert browser.evaluate(f"[...{_field('mode')}.options].map((each) => each.value).join()") == "slow,fast"
    assert browser.evaluate(f"{_field('frame')}.disabled")
    assert not browser.evaluate(f"{_field('label')}.disabled")

    _enter(browser, "speed", "7")  # beyond the range
    browser.wait_for(f"{_field('speed')}.value === '2.000'")
    _enter(browser, "mode", "fast")
    _enter(browser, "gains", "[3, 4.5]")
    browser.click_on("[data-parameter=holonomic] input")
    _enter(browser, "label", "forbidden")
    browser.wait_for("document.querySelector('[role=alert]')?.textContent === \"label must not be 'forbidden'\"")
    browser.wait_for(f"{_field('label')}.value === 'a'")
    assert "2.0" in _get("speed")
    assert "fast" in _get("mode")
    assert "3.0, 4.5" in _get("gains")
    assert "True" in _get("holonomic")
    _enter(browser, "label", "b")
    browser.wait_for("!document.querySelector('[role=alert]')")

    with Terminal("param", "set", "/base", "speed", "1.25", domain=_DOMAIN) as change:
        assert change.wait(30) == 0, change.text
    browser.wait_for(f"{_field('speed')}.value === '1.250'")
    assert browser.errors == []
