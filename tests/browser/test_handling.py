"""Handling of the studio's page: keyboards, widths of windows, closed panels, and what axe-core finds in each panel."""

import json
import os
import re
import signal
from collections.abc import Iterator

import pytest

from browser.cdp import Chromium
from daidalos.studio.server import StudioServer
from end_to_end.processes import DAIDALOS, Command
from places import REPOSITORY
from studio.demo_robot import DemoRobot
from studio.memory_source import MemorySource
from studio.test_page import READY, SEES, TABS, serve, show

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (1280, 720)
WEB = REPOSITORY / "src" / "daidalos" / "studio" / "web"
AXE = WEB / "node_modules" / "axe-core" / "axe.min.js"
PANELS = sorted(
    {
        name
        for file in (WEB / "src" / "panels").glob("*_panel.tsx")
        for name in re.findall(r'^\s+id: "([a-z_]+)",$', file.read_text(), re.MULTILINE)
    }
)
VIOLATIONS = (
    "axe.run(document, {resultTypes: ['violations'], rules: {region: {enabled: false}}})"
    ".then((found) => JSON.stringify(found.violations.map(({id, nodes}) => [id, nodes.map(({html}) => html)])))"
)
FOCUSED = "document.activeElement.textContent"


@pytest.fixture
def server() -> Iterator[StudioServer]:
    source = MemorySource()
    with DemoRobot(source), serve(source) as server:
        yield server


@pytest.fixture
def page(browser: Chromium, server: StudioServer) -> Iterator[Chromium]:
    browser.resize(*WINDOW)
    show(browser, server.url)
    browser.wait_for(SEES, 60)
    yield browser
    browser.resize(*WINDOW)
    assert browser.errors == []
    browser.open("about:blank")


def choose(page: Chromium, menu: str, entry: str) -> None:
    page.click_on(f"button[aria-label={menu}]")
    item = f"[...document.querySelectorAll('.menu-item')].find((each) => each.textContent === '{entry}')"
    page.wait_for(f"!!{item}")
    page.evaluate(f"{item}.click()")


def test_tabs_follow_the_keyboard(page: Chromium) -> None:
    roles = page.evaluate("[...document.querySelectorAll('.dv-tab')].map((e) => [e.role, e.ariaSelected, e.tabIndex])")
    assert all(role == "tab" and (selected == "true") == (index == 0) for role, selected, index in roles)
    page.evaluate("document.getElementById('tab-topics').focus()")
    page.press("ArrowRight")
    page.wait_for(f"{FOCUSED} === 'Message' && document.activeElement.ariaSelected === 'true'")
    page.press("ArrowRight")
    page.wait_for(f"{FOCUSED} === 'Topics' && document.activeElement.ariaSelected === 'true'")
    page.press("End")
    page.wait_for(f"{FOCUSED} === 'Message'")
    page.press("Home")
    page.wait_for(f"{FOCUSED} === 'Topics'")
    page.press("Delete")
    page.wait_for(f"!{TABS}.includes('Topics')")


def test_a_closed_panel_is_opened_again_where_it_was(page: Chromium) -> None:
    before = page.evaluate(TABS)
    page.evaluate("document.querySelector('#tab-plot .dv-default-tab-action').click()")
    page.wait_for(f"!{TABS}.includes('Plot')")
    page.click_on("[data-test=closed] button")
    page.wait_for(f"JSON.stringify({TABS}) === '{json.dumps(before, separators=(',', ':'))}'")
    for tab in ("tab-plot", "tab-log"):
        page.evaluate(f"document.querySelector('#{tab} .dv-default-tab-action').click()")
    page.wait_for(f"!{TABS}.includes('Log')")
    choose(page, "Panels", "Reopen “Log”")
    choose(page, "Panels", "Reopen “Plot”")
    page.wait_for(f"{TABS}.includes('Plot') && {TABS}.includes('Log')")


def test_panels_follow_the_width_of_the_window(page: Chromium) -> None:
    page.evaluate("document.querySelector('#tab-log .dv-default-tab-action').click()")
    page.wait_for(f"!{TABS}.includes('Log')")
    wide = page.evaluate(TABS)
    groups = "document.querySelectorAll('.dv-groupview').length"
    page.resize(820, 1180)
    page.wait_for(f"{groups} === 2")
    assert set(page.evaluate(TABS)) == set(wide)
    assert page.evaluate("document.querySelector('.scene-canvas').clientWidth") > 500
    page.resize(390, 844)
    page.wait_for(f"{groups} === 1")
    assert set(page.evaluate(TABS)) == set(wide)
    assert page.evaluate("document.querySelector('.scene-canvas').clientWidth") > 350
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.resize(*WINDOW)
    page.wait_for(f"JSON.stringify({TABS}) === '{json.dumps(wide, separators=(',', ':'))}'")
    page.wait_for(SEES, 60)


def test_each_panel_passes_axe_in_both_themes(browser: Chromium, server: StudioServer) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: npm ci --prefix src/daidalos/studio/web")
    show(browser, server.url)
    script, found = AXE.read_text() + ";1", []
    for panel in ("", *PANELS):
        browser.open(f"{server.url}?panel={panel}" if panel else server.url)
        browser.wait_for(f"{READY} && !!document.querySelector('.panel > *')")
        browser.evaluate(script)
        for _ in range(2):
            theme = browser.evaluate("document.documentElement.dataset.theme")
            found += [(panel, theme, *violation) for violation in json.loads(browser.evaluate(VIOLATIONS))]
            browser.press("d")
            browser.wait_for(f"document.documentElement.dataset.theme !== '{theme}'")
            browser.evaluate("Promise.all(document.getAnimations().map((each) => each.finished.catch(() => 0)))")
    browser.open("about:blank")  # before its server ends
    assert found == []


def test_the_panels_of_the_page_are_found() -> None:
    assert {"scene", "plot", "topics", "log", "simulation", "turtlesim"} <= set(PANELS)


def test_a_stopped_server_is_shown_as_silent(browser: Chromium) -> None:
    words = [*DAIDALOS, "studio", "--no-browser", "--port", "0"]
    with Command(*words, domain=100 + os.getpid() % 100) as studio:
        show(browser, studio.wait_for_line("^window: ").split()[1])
        studio.send(signal.SIGSTOP)
        try:
            browser.wait_for("document.querySelector('[data-test=silent]')?.textContent.includes('silent')")
        finally:
            studio.send(signal.SIGCONT)
        browser.wait_for(f"{READY} && !document.querySelector('[data-test=silent]')")
        assert browser.errors == []
        browser.open("about:blank")
        assert studio.interrupt() == 0
