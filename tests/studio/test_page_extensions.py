"""Panels and displays of installed packages, in a real browser."""

import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from browser.cdp import Chromium, require_chromium, require_page
from daidalos.studio.server import StudioServer

from .memory_source import MemorySource, encode, make
from .page_packages import Install, make_package

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EXAMPLE = Path(__file__).parents[2] / "examples" / "extensions" / "studio_panel"
PANELS, DISPLAYS = "daidalos.studio_panels", "daidalos.studio_displays"
READY = "window.daidalos && daidalos.state().connected"


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    require_chromium()
    require_page()
    with Chromium(1280, 800) as browser:
        yield browser


@pytest.fixture
def source() -> MemorySource:
    return MemorySource()


@pytest.fixture
def server(source: MemorySource, browser: Chromium) -> Iterator[StudioServer]:
    with StudioServer(source, port=0) as server:
        yield server
        browser.open("about:blank")  # before its server ends


def show(browser: Chromium, url: str) -> None:
    browser.open(url)
    browser.evaluate("localStorage.clear()")
    browser.open("about:blank")
    browser.errors.clear()
    browser.open(url)
    browser.wait_for(READY, 60)


def text_of(panel: str) -> str:
    return f"document.querySelector('[data-panel={panel}]')?.textContent"


def choose(browser: Chromium, menu: str, entry: str) -> None:
    button = f"[...document.querySelectorAll('button')].find((each) => each.textContent === '{menu}')"
    browser.wait_for(f"!!{button}")
    browser.evaluate(f"{button}.click()")
    item = f"[...document.querySelectorAll('.menu-item')].find((each) => each.textContent.startsWith('{entry}'))"
    browser.wait_for(f"!!{item}")
    browser.evaluate(f"{item}.click()")


def header(frame: str) -> object:
    return make("std_msgs/msg/Header", stamp=make("builtin_interfaces/msg/Time", sec=0, nanosec=0), frame_id=frame)


def battery(percentage: float) -> bytes:
    name = "sensor_msgs/msg/BatteryState"
    empty = np.zeros(0, np.float32)
    message = make(
        name, header=header(""), voltage=12.1, temperature=20.0, current=0.0, charge=0.0, capacity=0.0,
        design_capacity=0.0, percentage=percentage, power_supply_status=0, power_supply_health=0,
        power_supply_technology=0, present=True, cell_voltage=empty, cell_temperature=empty, location="",
        serial_number="",
    )  # fmt: skip
    return encode(name, message)


def test_the_example_panel_shows_a_value(browser, source, server, install: Install, monkeypatch) -> None:
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    install(project["name"], PANELS, project["entry-points"][PANELS])
    monkeypatch.syspath_prepend(EXAMPLE)
    source.add_topic("/battery_state", "sensor_msgs/msg/BatteryState", latched=True)
    source.send("/battery_state", battery(0.7))
    show(browser, server.url)
    choose(browser, "Panels", "Battery")
    browser.wait_for(f"{text_of('battery')} === '70 %, 12.1 V'")
    source.send("/battery_state", battery(0.4))
    browser.wait_for(f"{text_of('battery')} === '40 %, 12.1 V'")

    browser.wait_for("localStorage.getItem('daidalos.layout')?.includes('battery')")
    browser.reload()
    browser.wait_for(f"{text_of('battery')} === '40 %, 12.1 V'", 60)

    show(browser, f"{server.url}?panel=battery")
    browser.wait_for(f"{text_of('battery')} === '40 %, 12.1 V'", 60)
    assert browser.errors == []


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("export default { title: 'Broken', mount() { throw new Error('no luck'); } };", "no luck"),
        (
            "export default { title: 'Broken', mount(element, { visible }) { visible.subscribe(() => later()); } };",
            "later",
        ),
        ("export const panel = 1;", "the module has no default export"),
        ("this is not JavaScript", "Unexpected identifier"),
    ],
)
def test_a_panel_that_fails_says_why_and_leaves_the_rest_alone(
    browser, source, server, install: Install, tmp_path, text: str, error: str
) -> None:
    make_package(tmp_path, "broken_of_test", {"broken.js": text})
    install("broken", PANELS, {"broken": "broken_of_test:broken.js"})
    source.add_topic("/odom", "nav_msgs/msg/Odometry")
    show(browser, server.url)
    choose(browser, "Panels", "Broken")
    found = browser.wait_for(f"document.querySelector('[data-panel=broken] [role=alert]') && {text_of('broken')}")
    assert found.startswith("broken (broken 1.0): ")
    assert error in found
    browser.wait_for("daidalos.state().topics.includes('/odom') && !!document.querySelector('[data-display=Grid]')")


def test_a_panel_that_is_no_longer_installed_leaves_a_line(browser, server) -> None:
    show(browser, server.url)
    browser.evaluate(
        "addEventListener('pagehide', () => localStorage.setItem('daidalos.layout',"
        " localStorage.getItem('daidalos.layout').replaceAll('\"topics\"', '\"gone\"')))"
    )
    browser.reload()
    browser.wait_for(f"{READY} && !!document.querySelector('.dv-tab')", 60)
    browser.wait_for(f"{text_of('gone')} === 'No installed package has a panel gone'")


CUBES = """
export default ({ three, StampedDisplay }) => {
  class Cubes extends StampedDisplay {
    show({ point }) {
      const cube = new three.Mesh(new three.BoxGeometry(), new three.MeshStandardMaterial());
      cube.position.set(point.x, point.y, point.z);
      if (point.z > 5) throw new Error("too high");
      this.object.add(cube);
    }
    describe() {
      return `${this.object.children.length} cubes`;
    }
  }
  return {
    messages: ["geometry_msgs/msg/PointStamped"],
    properties: [{ key: "topic", label: "Topic", kind: "topic" }],
    defaults: { topic: "/cubes" },
    create: (context, settings) => new Cubes(context, settings, "latest"),
  };
};
"""


def add_display(browser: Chromium, kind: str) -> None:
    browser.click_on("[data-test=add-display]")
    browser.click_on(f"[data-add={kind}]")
    browser.wait_for("document.querySelector('dialog') === null")


def test_a_display_from_outside_draws_and_says_what_went_wrong(
    browser, source, server, install: Install, tmp_path
) -> None:
    make_package(tmp_path, "cubes_of_test", {"cubes.js": CUBES})
    install("cubes", DISPLAYS, {"Cubes": "cubes_of_test:cubes.js", "Absent": "cubes_of_test:absent.js"})
    name = "geometry_msgs/msg/PointStamped"
    source.add_topic("/cubes", name, latched=True)

    def send(z: float) -> None:
        point = make("geometry_msgs/msg/Point", x=0.0, y=0.0, z=z)
        source.send("/cubes", encode(name, make(name, header=header("map"), point=point)))

    send(1.0)
    show(browser, server.url)
    add_display(browser, "Cubes")
    browser.wait_for("daidalos.state().displays.Cubes?.text === '1 cubes'")
    add_display(browser, "Absent")
    browser.wait_for("daidalos.state().displays.Absent?.level === 'error'")
    assert "has no file absent.js" in browser.evaluate("daidalos.state().displays.Absent.text")
    send(9.0)
    browser.wait_for("daidalos.state().displays.Cubes.text === 'too high'")
    before = browser.evaluate("daidalos.state().drawn")
    browser.wheel(640, 400, 100)
    browser.wait_for(f"daidalos.state().drawn > {before}")

    browser.reload()
    browser.wait_for("daidalos.state().displays.Cubes?.text === 'too high'", 60)
