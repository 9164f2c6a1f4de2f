"""The studio's graph of nodes and topics, opened by rqt_graph, in a real browser."""

from __future__ import annotations

import os

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (1100, 700)
_DOMAIN = 100 + os.getpid() % 100
_ARROWS = "[...document.querySelectorAll('[data-arrow]')].map((each) => each.dataset.arrow).sort().join('; ')"


def _shows(*names: str) -> str:
    """Expression for whether exactly these boxes are shown."""
    return (
        "[...document.querySelectorAll('[data-box]')].map((each) => each.dataset.box).sort().join()"
        f" === {','.join(sorted(names))!r}"
    )


def test_graph_follows_who_talks_to_whom(browser: Chromium) -> None:
    with (
        Terminal("run", "rqt_graph", "rqt_graph", "--headless", "--port", "0", domain=_DOMAIN) as graph,
        Terminal("run", "demo_nodes_py", "talker", domain=_DOMAIN) as talker,
    ):
        url = graph.wait_for("^window: ")[0].split()[1]
        browser.open(url)
        browser.wait_for(_shows("/talker"))
        assert browser.evaluate("document.title") == "Graph · Daidalos"

        with Terminal("run", "demo_nodes_py", "listener", domain=_DOMAIN) as listener:
            browser.wait_for(_shows("/chatter", "/listener", "/talker"))
            assert browser.evaluate(_ARROWS) == "/chatter /listener; /talker /chatter"

            browser.click_on("[data-box='/chatter']")
            browser.wait_for(
                "document.querySelector('[data-test=graph-details]')?.textContent.includes('1 publisher, 1 subscriber')"
            )
            browser.wait_for("document.querySelectorAll('.graph-box.near').length === 3")

            browser.click_on("[data-test=graph-debug]")
            browser.wait_for("!!document.querySelector(\"[data-box^='/rqt_gui_py_node']\")")
            browser.click_on("[data-test=graph-debug]")
            assert listener.interrupt() == 0
        browser.wait_for(_shows("/talker"))
        assert talker.interrupt() == 0
        browser.wait_for("!document.querySelector('[data-box]')")
        assert browser.errors == []
        assert graph.interrupt() == 0
