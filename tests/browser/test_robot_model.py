"""A robot's description in the 3-D view of a real browser."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

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
_FEWEST_PIXELS = 5_000
_GREEN, _BLUE = (0, 255, 0), (0, 0, 255)


def _mask(picture: Path, wanted: tuple[int, int, int]) -> NDArray[np.bool_]:
    """Return which pixels of a picture have a colour, be it lit or in shadow."""
    pixels = np.asarray(Image.open(picture).convert("RGB"), dtype=int)
    main = wanted.index(255)
    others = np.delete(pixels, main, axis=2).max(axis=2)
    return (pixels[..., main] > 60) & (2 * others < pixels[..., main])


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

        browser.wait_for("document.body.innerText.includes('Robot')")
        for _ in range(120):
            browser.screenshot(picture)
            green, blue = (_mask(picture, colour) for colour in (_GREEN, _BLUE))
            if green.sum() > _FEWEST_PIXELS and blue.sum() > 0.2 * green.sum():
                break
            browser.wait_for("new Promise((done) => setTimeout(() => done(true), 500))")
        assert green.sum() > _FEWEST_PIXELS
        assert 0.2 < blue.sum() / green.sum() < 0.5  # how much of the plate the capsule covers, at any distance
        rows, columns = (np.flatnonzero(blue.any(axis=axis)) for axis in (1, 0))
        height, width = np.ptp(rows) + 1, np.ptp(columns) + 1
        assert 1.4 < height / width < 1.9  # seen from above; without its upper cap it would be 1.1
        assert blue[rows[0] + height // 30].sum() < 0.7 * width  # the top is round
        assert browser.errors == []
        assert view.interrupt() == 0
        assert publisher.interrupt() == 0
