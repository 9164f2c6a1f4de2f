"""The panel of slam_toolbox, in a real browser."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

from browser.cdp import Chromium
from daidalos.nodes.slam_toolbox.sync_slam_toolbox_node import SynchronousSlamToolbox
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (420, 640)
_DOMAIN = 100 + os.getpid() % 100


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """Save the pose graph of a short drive."""
    from daidalos.mapping.pose_graph_file import save_pose_graph
    from daidalos.mapping.slam import Slam, SlamConfig
    from mapping.worlds import Lidar, arena

    slam, rng = Slam(SlamConfig(minimum_travel_distance=0.2)), np.random.default_rng(7)
    for k in range(4):
        pose = np.array([0.3 * k - 3.0, -2.3, 0.0])
        slam.add_scan(round(k * 1e9), Lidar(beams=180).scan(arena(), pose, rng), pose)
    save_pose_graph(slam.saved(), tmp_path / "arena")
    return tmp_path / "arena"


@pytest.fixture
def node() -> Iterator[SynchronousSlamToolbox]:
    context = Context()
    rclpy.init(context=context, domain_id=_DOMAIN)
    node = SynchronousSlamToolbox(context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    thread = Thread(target=executor.spin)
    thread.start()
    yield node
    executor.shutdown()
    thread.join()
    node.destroy_node()
    rclpy.shutdown(context=context)


def _enter(browser: Chromium, label: str, text: str, event: str = "change") -> None:
    selector = f"document.querySelector('[aria-label=\"{label}\"]')"
    browser.wait_for(f"!!{selector}")
    browser.evaluate(
        f"(() => {{ const e = {selector}; e.value = {text!r};"
        f" e.dispatchEvent(new Event({event!r}, {{ bubbles: true }})); }})()"
    )


def _wait_for_report(browser: Chromium, words: str) -> None:
    browser.wait_for(f"document.querySelector('.slam-reports')?.textContent.includes({words!r})", 60)


def test_maps_are_saved_loaded_and_corrected(
    browser: Chromium, node: SynchronousSlamToolbox, saved: Path, tmp_path: Path
) -> None:
    with Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio:
        browser.open(studio.wait_for("^window: ")[0].split()[1].split("?")[0] + "?panel=slam_toolbox")
        browser.wait_for("document.querySelector('[aria-label=\"Accept new scans\"]')?.checked", 60)
        browser.click_on("[data-slam=save_map]")
        _wait_for_report(browser, "there is no map to be saved yet")

        _enter(browser, "File, without suffix", str(tmp_path / "nothing"))
        browser.click_on("[data-slam=deserialize_map]")
        browser.wait_for(
            "[...document.querySelectorAll('.slam-reports .error-text')]"
            ".some((report) => report.textContent.includes('nothing.posegraph'))",
            60,
        )
        _enter(browser, "File, without suffix", str(saved))
        browser.click_on("[data-slam=deserialize_map]")
        _wait_for_report(browser, "read a pose graph of 4 scans")
        _enter(browser, "Name of the map", str(tmp_path / "hall"))
        browser.click_on("[data-slam=save_map]")
        _wait_for_report(browser, "saved the map")
        assert (tmp_path / "hall.pgm").is_file()

        browser.click_on("[aria-label='Accept new scans']")
        _wait_for_report(browser, "new scans are ignored")
        browser.wait_for("!document.querySelector('[aria-label=\"Accept new scans\"]').checked")
        assert node.get_parameter("paused_new_measurements").value

        browser.click_on("[aria-label='Interactive mode']")
        browser.wait_for("document.querySelector('[aria-label=\"Key scan\"]')?.value === '3'")
        before = node.slam.key_pose(3)
        browser.wait_for(f"document.querySelector('[aria-label=\"Key scan: x\"]').value === '{before[0]:.3f}'")
        _enter(browser, "Key scan: y", f"{before[1] + 0.5:.2f}", "input")
        browser.click_on("[data-slam=move]")
        _wait_for_report(browser, "key scan 3 was moved")
        browser.click_on("[data-slam=manual_loop_closure]")
        _wait_for_report(browser, "optimized the graph with 1 key scans moved")
        assert node.slam.key_pose(3)[1] > before[1] + 0.04  # the edges hold it

        browser.click_on("[data-slam=serialize_map]")
        _wait_for_report(browser, "saved 4 scans")
        assert browser.errors == []
        browser.open("about:blank")  # before its server ends
