"""The panel of the pendant, in a real browser: a program runs and asks, and the arm is jogged."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from browser.cdp import Chromium
from daidalos.nodes.daidalos_rapid.rapid_pendant import RapidPendant
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (560, 1000)
_DOMAIN = 100 + os.getpid() % 100
PROGRAM = """MODULE cell
  PERS robtarget pA := [[350,-100,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR num key;
    ConfL \\Off; ConfJ \\Off;
    MoveJ pA, v1000, fine, tool0;
    SetDO doDone, 1;
    TPReadFK key, "again?", "yes", "no", stEmpty, stEmpty, stEmpty;
    TPWrite "key " \\Num:=key;
  ENDPROC
ENDMODULE
"""


@pytest.fixture
def program(tmp_path: Path) -> Iterator[Path]:
    """The module of a running pendant."""
    file = tmp_path / "cell.mod"
    file.write_text(PROGRAM)
    context = Context()
    rclpy.init(context=context, domain_id=_DOMAIN)
    node = RapidPendant(context=context, parameter_overrides=[Parameter("program", value=str(file))])
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    thread = Thread(target=executor.spin)
    thread.start()
    yield file
    executor.shutdown()
    thread.join()
    node.destroy_node()
    rclpy.shutdown(context=context)


def test_a_program_is_run_and_the_arm_is_jogged(browser: Chromium, program: Path) -> None:
    with Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio:
        browser.open(studio.wait_for("^window: ")[0].split()[1].split("?")[0] + "?panel=rapid_pendant")
        state = "document.querySelector('[data-test=state]')?.textContent"
        browser.wait_for(f"{state} === 'idle'")
        browser.wait_for("document.querySelectorAll('.rapid-pendant-program li').length === 11")
        value = "document.querySelector('[data-test=value-1]').textContent"
        browser.click_on("[data-command='jog 1 +']")
        browser.wait_for(f"{value} === '1.00°'")
        browser.click_on("[data-command=start]")
        browser.wait_for("document.querySelector('[data-test=question]')?.textContent === 'again?'")
        browser.wait_for("document.querySelector('[aria-current=step] code').textContent.includes('TPReadFK')")
        browser.wait_for("[...document.querySelectorAll('td')].some((one) => one.textContent === 'dodone')")
        if os.environ.get("DAIDALOS_PICTURES"):
            browser.screenshot(Path(os.environ["DAIDALOS_PICTURES"]) / "rapid_pendant.png")
        browser.click_on("[data-command='answer 2']")
        browser.wait_for("document.querySelector('[data-test=screen]')?.textContent === 'key 2'")
        browser.wait_for(f"{state} === 'idle'")
        browser.click_on("[data-command='modpos pA']")
        browser.wait_for("!document.querySelector('[data-command=save]').disabled")
        browser.click_on("[data-command=save]")
        browser.wait_for("document.querySelector('[data-test=report]').textContent.startsWith('saved')")
        assert program.read_text() != PROGRAM
        assert browser.errors == []
        browser.open("about:blank")  # before its server ends
