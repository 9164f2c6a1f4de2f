"""Editing a simulated world in the studio, while it runs, in a real browser."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import Any

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (1100, 760)
_DOMAIN = 100 + os.getpid() % 100
_MODELS = "document.querySelector('[data-test=models]')?.textContent"
_FACTOR = "document.querySelector('[data-test=rtf]').textContent"
_POSE = "document.querySelector('[data-test=pose]').textContent"
_SELECTED = "document.querySelector('footer select').value"


def _settle(browser: Chromium) -> None:
    """Wait until the view is drawn and damping has ended."""
    browser.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def _pose(browser: Chromium) -> tuple[float, float, float, float]:
    """What the page says of the selected model: x, y and z in m, yaw in degrees."""
    text = browser.wait_for("document.querySelector('[data-test=pose]')?.textContent")
    x, y, z, yaw = (float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text))
    return x, y, z, yaw


def _wait_for_pose(browser: Chromium, condition: str) -> tuple[float, float, float, float]:
    """Wait until the selected model rests where x, y, z and yaw fulfil a condition; return them."""
    numbers = rf"{_POSE}.match(/-?\d+([.]\d+)?/g).map(Number)"
    _let_rest(browser)
    browser.wait_for(f"(([x, y, z, yaw]) => {condition})({numbers})")
    _let_rest(browser)
    return _pose(browser)


def _let_rest(browser: Chromium) -> None:
    """Wait until all that was done has reached the simulator, and the selected model is shown where it rests."""
    browser.evaluate(
        f"""new Promise((done) => {{
            let [shown, since] = ["", performance.now()];
            const look = () => {{
                const now = {_POSE};
                if (now !== shown || daidalos.editing()) [shown, since] = [now, performance.now()];
                if (performance.now() - since > 400) done();
                else requestAnimationFrame(look);
            }};
            look();
        }})"""
    )


def _handle(browser: Chromium, axis: str) -> tuple[float, float]:
    _settle(browser)
    at = browser.evaluate(f"daidalos.handle('{axis}')")
    return at["x"], at["y"]


def _pull(browser: Chromium, axis: str, by: tuple[float, float], **how: Any) -> None:
    """Drag a handle of the selected model, with three moves of the mouse."""
    x, y = _handle(browser, axis)
    browser.drag([(x, y), *((x + by[0] * part, y + by[1] * part) for part in (0.2, 0.7, 1.0))], **how)
    _settle(browser)


def _told(name: str) -> str:
    """What a model looks like and where it is, asked from a terminal."""
    words = ("service", "call", "/gazebo/get_shapes", "daidalos_msgs/srv/GetShapes", f"{{names: [{name}]}}")
    with Terminal(*words, domain=_DOMAIN) as call:
        assert call.wait(30) == 0, call.text
        return call.text


def _size(told: str) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in re.findall(r"scale=\S*Vector3\(x=(\S+), y=(\S+), z=(\S+)\)", told)[0])
    return x, y, z


def _write_model(folder: Path) -> None:
    (folder / "lamp").mkdir()
    (folder / "lamp" / "model.config").write_text("<model><sdf version='1.6'>model.sdf</sdf></model>")
    shape = "<geometry><box><size>0.2 0.2 0.6</size></box></geometry>"
    (folder / "lamp" / "model.sdf").write_text(
        f"<sdf version='1.6'><model name='lamp'><link name='link'><pose>0 0 0.3 0 0 0</pose><collision name='c'>{shape}"
        f"</collision><visual name='v'>{shape}</visual></link></model></sdf>"
    )


def test_world_is_edited_while_it_runs(browser: Chromium, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _write_model(tmp_path)
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path))
    with (
        Terminal("run", "gazebo_ros", "gzserver", domain=_DOMAIN) as simulator,
        Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio,
    ):
        url = studio.wait_for("^window: ")[0].split()[1].split("?")[0]
        browser.open(f"{url}?panel=simulation")
        browser.wait_for(f"{_MODELS} === '1 model'", 60)
        browser.wait_for(f"/^[01][.]\\d\\d×$/.test({_FACTOR})")

        _shapes_are_put(browser)
        _a_box_is_moved_and_turned(browser)
        _every_shape_is_scaled(browser)
        _time_is_steered(browser)
        _models_are_put(browser)
        _all_is_taken_back(browser)
        assert browser.evaluate("document.querySelector('.error-text')?.textContent ?? ''") == ""
        browser.open(f"{url}?front=simulation")
        browser.wait_for(f"{_MODELS} === '3 models'")
        _entities_are_a_tree(browser)
        simulator.interrupt()
        browser.wait_for("document.body.textContent.includes('No simulator is running')")
        assert browser.errors == []


_HOUSE = """<sdf version="1.9"><world name="estate">
<model name="house"><static>true</static>
  <model name="ground_floor">{walls}</model>
</model></world></sdf>"""
_WALL = """<link name="{name}"><pose>{x} 0 1 0 0 0</pose>
<visual name="v"><geometry><box><size>0.1 6 2</size></box></geometry></visual></link>"""


def test_links_of_nested_models_are_drawn_at_their_poses(browser: Chromium, tmp_path: Path) -> None:
    walls = "".join(_WALL.format(name=name, x=x) for name, x in (("west", -4), ("east", 4)))
    (tmp_path / "house.sdf").write_text(_HOUSE.format(walls=walls))
    with (
        Terminal(
            "run",
            "ros_gz_sim",
            "gzserver",
            "--ros-args",
            "-p",
            f"world_sdf_file:={tmp_path / 'house.sdf'}",
            domain=_DOMAIN,
        ),
        Terminal("run", "rqt_gui", "rqt_gui", "--headless", "--port", "0", domain=_DOMAIN) as studio,
    ):
        browser.open(f"{studio.wait_for('^window: ')[0].split()[1].split('?')[0]}?panel=simulation")
        browser.wait_for(f"{_MODELS} === '1 model'", 60)
        browser.wait_for("daidalos.simulated('house::ground_floor::east')")
        _settle(browser)
        where = [
            browser.evaluate(f"daidalos.simulated('house{link}')")
            for link in ("::ground_floor::west", "", "::ground_floor::east")
        ]
        west, middle, east = ((each["x"], each["y"]) for each in where)
        assert math.dist(west, middle) > 100
        assert math.dist(east, middle) > 100
        assert math.dist(west, east) > 0.9 * (math.dist(west, middle) + math.dist(east, middle))


def _entities_are_a_tree(browser: Chromium) -> None:
    """Select by mouse and by keyboard, unfold and filter, in the panel beside the simulated world."""
    names = "[...document.querySelectorAll('[data-entity]')].map((e) => e.dataset.entity)"
    assert not browser.evaluate("document.querySelector('[data-panel=displays]')?.checkVisibility()")
    assert browser.wait_for(f"{names}.length && {names}") == ["ground_plane", "box", "cylinder"]
    browser.click_on("[data-entity=box]")
    browser.wait_for(f"{_SELECTED} === 'box'")
    browser.press("ArrowRight")
    browser.wait_for(f"{names}.includes('box::link')")
    browser.press("ArrowDown")
    browser.wait_for("document.activeElement?.dataset.entity === 'box::link'")
    assert browser.evaluate(_SELECTED) == "box", "a link's model is selected"
    browser.press("ArrowLeft")
    browser.press("ArrowLeft")
    browser.wait_for(f"!{names}.includes('box::link')")
    browser.click_on("[aria-label='Filter entities']")
    browser.type("link")
    browser.wait_for(f"{names}.length === 6")
    assert browser.evaluate("document.querySelectorAll('[data-test=rtf]').length") == 1, "one real-time factor"


def _put(browser: Chromium, shape: str, x: float, y: float, name: str) -> None:
    browser.click_on(f"[data-test=insert-{shape}]")
    browser.hover(x, y)
    browser.click(x, y)
    browser.wait_for(f"{_SELECTED} === '{name}'")


def _choose(browser: Chromium, name: str) -> None:
    browser.evaluate(
        f"(() => {{ const e = document.querySelector('footer select'); e.value = '{name}';"
        " e.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    browser.wait_for(f"{_SELECTED} === '{name}'")
    _settle(browser)


def _shapes_are_put(browser: Chromium) -> None:
    _put(browser, "sphere", 330, 300, "sphere")
    _put(browser, "cylinder", 800, 300, "cylinder")
    _put(browser, "box", 550, 430, "box")
    browser.wait_for(f"{_MODELS} === '4 models'")
    assert _pose(browser)[2] == pytest.approx(0.15, abs=0.02)


def _a_box_is_moved_and_turned(browser: Chromium) -> None:
    x, y, *_ = before = _pose(browser)
    browser.press("Escape")
    browser.wait_for(f"{_SELECTED} === ''")
    browser.press("t")
    browser.drag([(550, 428), (560, 440), (590, 460), (620, 480)])  # the model itself, along the ground
    browser.wait_for(f"{_SELECTED} === 'box'")
    after = _wait_for_pose(browser, f"Math.hypot(x - {x}, y - {y}) > 0.2")
    assert after[2] == pytest.approx(before[2], abs=0.02)

    _pull(browser, "x", (60, -60))  # by a handle, along its axis
    along = _wait_for_pose(browser, f"Math.abs(x - {after[0]}) > 0.1")
    assert along[1] == pytest.approx(after[1], abs=0.02)

    _pull(browser, "x", (60, 60), key="Escape")
    _wait_for_pose(browser, f"Math.abs(x - {along[0]}) < 0.02")

    browser.press("r")
    where = browser.evaluate("daidalos.simulated('box')")
    browser.drag([(where["x"] + by, where["y"]) for by in (0, 20, 60, 90)], ctrl=True)
    _wait_for_pose(browser, "yaw === 60")


def _every_shape_is_scaled(browser: Chromium) -> None:
    browser.press("s")
    for name, changes in (("box", (False, False, True)), ("cylinder", (False, False, True)), ("sphere", (True,) * 3)):
        _choose(browser, name)
        _pull(browser, "z", (0, -60))
        x, y, z = _size(_told(name))
        grown = (x > 0.31, y > 0.31, z > 0.31)
        assert grown == changes, name
        assert _pose(browser)[2] == pytest.approx(z / 2, abs=0.03), "it stands where it stood"


def _time_is_steered(browser: Chromium) -> None:
    time = "document.querySelector('.top-bar .clock .figures').textContent"
    browser.click_on("[data-test=play]")
    browser.wait_for(f"{_FACTOR} === 'paused'")
    before = browser.evaluate(time)
    browser.click_on("[data-test=step]")
    browser.wait_for(f"{time} !== '{before}'")
    browser.evaluate(
        "(() => { const e = document.querySelector('[aria-label=Speed]'); e.value = '0.5';"
        " e.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    browser.click_on("[data-test=play]")
    browser.wait_for(f"/^0[.][45]/.test({_FACTOR})")


def _models_are_put(browser: Chromium) -> None:
    browser.click_on("[data-test=models-to-insert]")
    browser.wait_for("[...document.querySelectorAll('.menu-item')].some((e) => e.textContent.startsWith('lamp'))")
    assert browser.evaluate("document.querySelector('.menu-list').textContent.includes('turtlebot3_waffle')")
    browser.click_on("[data-test=model-address]")
    browser.type("model://lamp")
    browser.press("Enter")
    browser.hover(300, 550)
    browser.click(300, 550)
    browser.wait_for(f"{_MODELS} === '5 models' && {_SELECTED} === 'lamp'")


def _all_is_taken_back(browser: Chromium) -> None:
    browser.press("z", ctrl=True)
    browser.wait_for(f"{_MODELS} === '4 models'")
    _choose(browser, "sphere")
    large = _pose(browser)[2]
    browser.press("z", ctrl=True)
    _wait_for_pose(browser, f"z < {large - 0.02}")
    browser.press("Delete")
    browser.wait_for(f"{_MODELS} === '3 models' && {_SELECTED} === ''")
    browser.press("z", ctrl=True)
    browser.wait_for(f"{_MODELS} === '4 models' && {_SELECTED} === 'sphere'")
    browser.click_on("[data-test=delete]")
    browser.wait_for(f"{_MODELS} === '3 models' && {_SELECTED} === ''")
