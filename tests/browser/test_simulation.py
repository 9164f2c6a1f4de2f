"""Editing a simulated world in the studio, while it runs, in a real browser."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from browser.cdp import Chromium, require_chromium
from daidalos.studio.build import build, is_fresh
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_DOMAIN = 100 + os.getpid() % 100
_MODELS = "document.querySelector('[data-test=models]')?.textContent"
_FACTOR = "document.querySelector('[data-test=rtf]').textContent"
_SELECTED = "document.querySelector('footer select').value"


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    require_chromium()
    words: list[str] = []
    if not is_fresh() and not build(words.append):
        if os.environ.get("DAIDALOS_REQUIRE_BROWSER"):
            pytest.fail(f"the page can not be built: {words}")
        pytest.skip(f"the page is not built: {words}")
    with Chromium(1100, 760) as browser:
        yield browser


def _settle(browser: Chromium) -> None:
    """Wait until the view is drawn and damping has ended."""
    browser.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def _position(name: str) -> tuple[float, float, float]:
    with Terminal(
        "service", "call", "/gazebo/get_entities_states", "simulation_interfaces/srv/GetEntitiesStates",
        f"{{filters: {{filter: '^{name}$'}}}}", domain=_DOMAIN,
    ) as call:  # fmt: skip
        assert call.wait(30) == 0, call.text
        numbers = call.text.partition("Point(")[2].partition(")")[0]
    x, y, z = (float(part.partition("=")[2]) for part in numbers.split(","))
    return x, y, z


def test_world_is_edited_while_it_runs(browser: Chromium) -> None:
    with (
        Terminal("run", "gazebo_ros", "gzserver", domain=_DOMAIN),
        Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio,
    ):
        url = studio.wait_for("^window: ")[0].split()[1].split("?")[0]
        browser.open(f"{url}?panel=simulation")
        browser.wait_for(f"{_MODELS} === '1 models'", 60)
        browser.wait_for(f"/^[01][.]\\d\\d×$/.test({_FACTOR})")

        browser.click_on("[data-test=insert-box]")
        browser.click(550, 430)
        browser.wait_for(f"{_MODELS} === '2 models' && {_SELECTED} === 'box'")
        _settle(browser)
        before = _position("box")
        assert before[2] == pytest.approx(0.15, abs=0.02)

        browser.click_on("[data-test=mode-move]")
        browser.drag([(550, 428), (570, 440), (620, 470), (680, 500)])
        browser.wait_for(f"{_SELECTED} === 'box'")
        after = _position("box")
        assert abs(after[0] - before[0]) + abs(after[1] - before[1]) > 0.3

        browser.click_on("[data-test=mode-scale]")
        browser.drag([(680, 497), (680, 460), (680, 400)])
        browser.wait_for("!document.querySelector('.complaint-text')")

        browser.click_on("[data-test=play]")
        browser.wait_for(f"{_FACTOR} === 'paused'")
        assert _position("box")[2] > 0.2, "twice as large, its middle is higher"
        browser.click_on("[data-test=step]")
        browser.click_on("[data-test=play]")
        browser.wait_for(f"{_FACTOR} !== 'paused'")

        browser.click_on("[data-test=delete]")
        browser.wait_for(f"{_MODELS} === '1 models'")
        assert browser.evaluate("document.querySelector('.complaint-text')?.textContent ?? ''") == ""
        assert browser.errors == []
