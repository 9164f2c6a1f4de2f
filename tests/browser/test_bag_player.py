"""The time line of a bag beside the studio, as `daidalos studio --bag` opens it, in a real browser."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from browser.cdp import Chromium
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.writer import BagWriter, WriterOptions
from end_to_end.processes import DAIDALOS, Command

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (1280, 720)
SECOND = 1_000_000_000
DURATION = 100
_DOMAIN = 100 + os.getpid() % 100
_TIME = "Number.parseFloat(document.querySelector('[data-test=bag-time]').textContent)"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Write a bag of 100 s with a message each tenth of a second."""
    folder = tmp_path / "numbers"
    with BagWriter(folder, WriterOptions("mcap")) as bag:
        bag.add_topic(Topic("/chatter", "std_msgs/msg/String", type_hash=String._TYPE_HASH))
        for k in range(10 * DURATION + 1):
            stamp = SECOND + k * SECOND // 10
            bag.write(BagMessage("/chatter", serialize_message(String(data=str(k))), stamp, stamp))
    return folder


@pytest.fixture
def studio(bag: Path, browser: Chromium) -> Iterator[Command]:
    with Command(*DAIDALOS, "studio", "--bag", str(bag), "--no-browser", "--port", "0", domain=_DOMAIN) as studio:
        yield studio
        browser.open("about:blank")  # before its server ends


def drag_time_to(browser: Chromium, seconds: float) -> None:
    browser.evaluate(
        "(() => { const e = document.querySelector('[aria-label=\"Time in the bag\"]');"
        f" e.value = {1 + seconds};"
        " for (const kind of ['input', 'change']) e.dispatchEvent(new Event(kind, { bubbles: true })); })()"
    )


def test_a_bag_is_paused_searched_and_played_faster(browser: Chromium, studio: Command) -> None:
    browser.open(studio.wait_for_line("^window: ").split()[1])
    browser.wait_for("document.querySelector('[data-test=bag-time]')?.textContent.includes('of 100.0 s')")
    browser.click_on("[data-test=pause]")
    browser.wait_for("document.querySelector('[data-test=pause]').title === 'Play'")
    drag_time_to(browser, 60)
    browser.wait_for(f"Math.abs({_TIME} - 60) < 0.3")
    browser.click_on("[data-test=next]")
    browser.wait_for("daidalos.state().topics.includes('/chatter')")
    browser.evaluate(
        "(() => { const e = document.querySelector('select[aria-label=Rate]'); e.value = '10';"
        " e.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    browser.wait_for("document.querySelector('select[aria-label=Rate]').value === '10'")
    browser.click_on("[data-test=pause]")
    browser.wait_for(f"{_TIME} > 70")
    assert browser.errors == []
    if os.environ.get("DAIDALOS_PICTURES"):
        browser.screenshot(Path(os.environ["DAIDALOS_PICTURES"]) / "bag_player.png")
    assert studio.interrupt() == 0
    studio.assert_no_traceback()
