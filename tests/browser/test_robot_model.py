"""A robot's description in the 3-D view of a real browser."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from browser.cdp import Chromium
from nodes.terminal import Terminal

Image = pytest.importorskip("PIL.Image")

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (1000, 700)
_DOMAIN = 100 + os.getpid() % 100
_ROBOT = """<robot name="r">
<material name="painted"><texture filename="file://{image}"/></material>
<material name="blue"><color rgba="0 0 1 1"/></material>
<link name="base_link">
  <visual><geometry><box size="3 3 0.2"/></geometry><material name="painted"/></visual>
  <visual><origin xyz="0 0 0.6"/><geometry><capsule radius="0.5" length="1"/></geometry><material name="blue"/></visual>
</link></robot>"""
_GREEN, _BLUE = (0, 255, 0), (0, 0, 255)


def _share(picture: Path, wanted: tuple[int, int, int]) -> float:
    """Return how much of a picture has a colour, be it lit or in shadow."""
    pixels = Image.open(picture).convert("RGB").resize((120, 80), Image.Resampling.NEAREST)
    found = [pixels.getpixel((x, y)) for x in range(120) for y in range(80)]
    main = wanted.index(255)
    return sum(p[main] > 60 and all(2 * p[i] < p[main] for i in range(3) if i != main) for p in found) / len(found)


def test_images_and_capsules_are_drawn(browser: Chromium, tmp_path: Path) -> None:
    image, robot, picture = tmp_path / "green.png", tmp_path / "r.urdf", tmp_path / "seen.png"
    Image.new("RGB", (4, 4), _GREEN).save(image)
    robot.write_text(_ROBOT.format(image=image))
    with (
        Terminal("run", "robot_state_publisher", "robot_state_publisher", str(robot), domain=_DOMAIN) as publisher,
        Terminal("run", "rviz2", "rviz2", "-f", "base_link", domain=_DOMAIN) as view,
    ):
        publisher.wait_for("Robot initialized")
        browser.open(view.wait_for("^window: ")[0].split()[1])

        def seen() -> tuple[float, float]:
            browser.screenshot(picture)
            return _share(picture, _GREEN), _share(picture, _BLUE)

        browser.wait_for("document.body.innerText.includes('Robot')")
        for _ in range(20):
            green, blue = seen()
            if green > 0.02 and blue > 0.01:
                break
            browser.wait_for("new Promise((done) => setTimeout(() => done(true), 500))")
        assert green > 0.02
        assert blue > 0.006
        assert browser.errors == []
        assert view.interrupt() == 0
        assert publisher.interrupt() == 0
