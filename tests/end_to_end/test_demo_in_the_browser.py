"""The demonstration's page in a real Chromium: a goal given with the mouse, and a robot that arrives."""

import math
from collections.abc import Iterator

import pytest

from browser.cdp import Chromium, require_chromium
from end_to_end.processes import DAIDALOS, Command

GOAL = (1.9, -1.2)
AHEAD = (2.5, -1.2)


@pytest.fixture
def page(domain: int) -> Iterator[Chromium]:
    """The page of a running demonstration."""
    require_chromium()
    with Command(*DAIDALOS, "demo", "--no-browser", domain=domain) as demo:
        address = demo.wait_for_line("studio: http://").split("studio: ")[1]
        demo.wait_for_line("nav2_container.*Managed|Managed nodes are active")
        with Chromium(1440, 900) as chromium:
            chromium.open(address)
            yield chromium
            assert chromium.errors == []
        assert demo.interrupt() == 130
        demo.assert_no_traceback()


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.timeout(600)
def test_a_goal_set_with_the_mouse_is_reached(page: Chromium) -> None:
    page.wait_for("daidalos.state().connected")
    page.wait_for("daidalos.state().scanPoints > 500", timeout=180)
    page.wait_for("(daidalos.state().maps.Map ?? [0])[0] > 20", timeout=180)
    start = page.wait_for("daidalos.state().robotPose")
    assert math.hypot(start["x"] - GOAL[0], start["y"] - GOAL[1]) > 1.0
    drag_goal(page, GOAL, AHEAD)
    page.wait_for("daidalos.state().published['/goal_pose']")
    page.wait_for("daidalos.state().displays.Plan?.level === 'ok'")
    page.wait_for(
        f"(({{x, y, yaw}}) => Math.hypot(x - {GOAL[0]}, y - {GOAL[1]}) < 0.2 && Math.abs(yaw) < 0.3)"
        "(daidalos.state().robotPose)",
        timeout=240,
    )
    faults = {
        name: told for name, told in page.evaluate("daidalos.state().displays").items() if told["level"] == "error"
    }
    assert faults == {}


_STANDS = """(() => {
    const at = daidalos.project(0, 0), last = window.lastProjected;
    window.lastProjected = at;
    window.looksAlike = last && Math.hypot(at.x - last.x, at.y - last.y) < 1 ? (window.looksAlike ?? 0) + 1 : 0;
    return window.looksAlike > 60;
})()"""
"""Condition of the view having stood still for some two seconds."""


def drag_goal(page: Chromium, at: tuple[float, float], ahead: tuple[float, float]) -> None:
    """Take the goal tool, press at a place on the ground and pull towards where the robot is to look."""
    page.wait_for(_STANDS, timeout=180)  # the first view still moves while the map grows
    begin, end = (page.evaluate(f"daidalos.project({x}, {y})") for x, y in (at, ahead))
    page.evaluate("daidalos.takeTool('goal')")
    middle = ((begin["x"] + end["x"]) / 2, (begin["y"] + end["y"]) / 2)
    page.drag([(begin["x"], begin["y"]), middle, (end["x"], end["y"])])
