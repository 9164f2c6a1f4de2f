"""Calling services and publishing from the studio, in a real browser."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (800, 700)
_DOMAIN = 100 + os.getpid() % 100


@pytest.fixture
def url(browser: Chromium) -> Iterator[str]:
    with Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio:
        yield studio.wait_for("^window: ")[0].split()[1].split("?")[0]
        browser.open("about:blank")  # before its server ends
        assert studio.interrupt() == 0


def _fill(browser: Chromium, selector: str, text: str, event: str) -> None:
    browser.wait_for(f"!!document.querySelector({selector!r})")
    browser.evaluate(
        f"(() => {{ const e = document.querySelector({selector!r}); e.value = {text!r};"
        f" e.dispatchEvent(new Event({event!r}, {{ bubbles: true }})); }})()"
    )


def test_a_service_is_called(browser: Chromium, url: str) -> None:
    with Terminal("run", "demo_nodes_py", "add_two_ints_server", domain=_DOMAIN):
        browser.open(f"{url}?panel=service")
        _fill(browser, "[data-test=service-name]", "/add_two_ints", "change")
        browser.wait_for("JSON.parse(document.querySelector('[data-test=draft]').value).b === 0")
        _fill(browser, "[data-test=draft]", '{"a": 40, "b": 2}', "input")
        browser.click_on("[data-test=call]")
        browser.wait_for("JSON.parse(document.querySelector('[data-test=answer]').textContent).sum === 42")

        _fill(browser, "[data-test=draft]", '{"a": 40', "input")
        browser.click_on("[data-test=call]")
        browser.wait_for("document.querySelector('[role=alert]').textContent.includes('JSON')")
        assert browser.errors == []


def test_messages_are_published_once_and_again(browser: Chromium, url: str) -> None:
    with Terminal("run", "demo_nodes_py", "listener", domain=_DOMAIN) as listener:
        browser.open(f"{url}?panel=publish")
        _fill(browser, "[data-test=topic-name]", "/chatter", "change")
        browser.wait_for("JSON.parse(document.querySelector('[data-test=draft]').value).data === ''")
        _fill(browser, "[data-test=draft]", '{"data": "from the page"}', "input")
        # The first message may be out before the listener knows of its publisher.
        _fill(browser, "input[type=number]", "10", "input")
        browser.click_on("[data-test=repeat]")
        listener.wait_for(r"I heard: \[from the page\]", 3)
        browser.click_on("[data-test=repeat]")
        browser.wait_for("document.querySelector('[data-test=repeat]').ariaPressed === 'false'")
        assert browser.errors == []
