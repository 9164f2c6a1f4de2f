"""The panel that guides through the calibration of a moving head, in a real browser."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from browser.cdp import Chromium
from daidalos.industry.lighting.calibration_file import read_geometry
from daidalos.nodes.daidalos_lighting.head_calibration import HeadCalibration
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (420, 760)
_DOMAIN = 100 + os.getpid() % 100


@pytest.fixture
def output(tmp_path: Path) -> Iterator[Path]:
    """The result's file of a running calibration."""
    file = tmp_path / "result.yaml"
    config = tmp_path / "lights.yaml"
    config.write_text("heads: [{name: spot}]\noutputs: []\n")
    context = Context()
    rclpy.init(context=context, domain_id=_DOMAIN)
    values = {"config": str(config), "output": str(file)}
    given: list[Parameter[Any]] = [Parameter(name, value=value) for name, value in values.items()]
    node = HeadCalibration(context=context, parameter_overrides=given)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    thread = Thread(target=executor.spin)
    thread.start()
    yield file
    executor.shutdown()
    thread.join()
    node.destroy_node()
    rclpy.shutdown(context=context)


def test_a_head_is_calibrated(browser: Chromium, output: Path) -> None:
    with Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio:
        browser.open(studio.wait_for("^window: ")[0].split()[1].split("?")[0] + "?panel=head_calibration")
        task = "document.querySelector('[data-test=task]')?.textContent"
        browser.wait_for(f"{task}?.startsWith('1 of 8: put the spot on [-1, -0.75, 0], straight')")
        browser.evaluate("document.querySelector('[data-test=head-calibration]').focus()")
        browser.press("Enter")
        browser.wait_for(f"{task}?.startsWith('2 of 8')")
        browser.click_on("[data-command=undo]")
        browser.wait_for(f"{task}?.startsWith('1 of 8')")
        for number in range(8):
            browser.wait_for(f"{task}?.startsWith('{number + 1} of 8')")
            browser.click_on("[data-command=enter]")
        browser.wait_for(f"{task} === 'All 8 directions are confirmed.'")
        browser.wait_for("document.querySelectorAll('.head-calibration-table rect').length === 63")
        if os.environ.get("DAIDALOS_PICTURES"):
            browser.screenshot(Path(os.environ["DAIDALOS_PICTURES"]) / "head_calibration.png")
        browser.click_on("[data-command=write]")
        browser.wait_for(
            "document.querySelector('.head-calibration [role=status]')?.textContent.startsWith('written to')"
        )
        assert math.dist(read_geometry(output).pose.position, (0.0, 0.0, 2.8)) < 1e-6
        assert browser.errors == []
        browser.open("about:blank")  # before its server ends
