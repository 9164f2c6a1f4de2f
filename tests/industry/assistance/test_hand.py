"""Hands above places in depth images: what presses, what does not, and images that lie."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import pytest
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.assistance.hand import Camera, HandDetector, HandError, HandParameters

Array = NDArray[np.float64]
PLACE = (0.2, 0.1, 0.75)
CAMERA = Camera(200.0, 200.0, 79.5, 59.5, Pose.from_xyz_rpy((0.0, 0.0, 2.0), (math.pi, 0.0, 0.0)))
"""Camera of 160 x 120 pixels, 1.25 m above a table, x to the right of the image and y of the world up."""

TABLE = np.full((120, 160), 1.25)
PERIOD = 0.05


def with_block(image: Array, center: Vector, size: tuple[float, float]) -> Array:
    """Return an image with a horizontal plate [m] at a place of the world, seen from above."""
    z = 2.0 - center[2]
    rows, columns = np.mgrid[: image.shape[0], : image.shape[1]]
    x, y = (columns - CAMERA.cx) * z / CAMERA.fx, -(rows - CAMERA.cy) * z / CAMERA.fy
    is_plate = (np.abs(x - center[0]) <= 0.5 * size[0]) & (np.abs(y - center[1]) <= 0.5 * size[1])
    return np.where(is_plate, np.minimum(image, z), image)


def arm(center: Vector = (0.2, 0.1, 0.82)) -> Array:
    """Return an image of the table with an arm that reaches from the right edge to a place."""
    return with_block(TABLE, (center[0] + 0.2, center[1], center[2]), (0.46, 0.09))


class Film:
    """Images that a detector gets one after the other."""

    def __init__(self, **values: object) -> None:
        parameters = HandParameters(frames=5, hold=0.3, absorb=2.0, **values)  # type: ignore[arg-type]
        self.detector = HandDetector(parameters, {"a": PLACE, "b": (-0.2, -0.1, 0.75)})
        self.time = 10.0
        self.noise = np.random.default_rng(5)

    def show(self, image: Array, seconds: float = 0.5) -> list[tuple[float, str]]:
        """Show an image with noise of 2 mm and holes, and return what was pressed after which time."""
        found = []
        for n in range(round(seconds / PERIOD)):
            self.time += PERIOD
            noisy = image + self.noise.normal(0.0, 0.002, image.shape)
            noisy[self.noise.random(image.shape) < 0.02] = self.noise.choice([0.0, math.nan, math.inf])
            found += [((n + 1) * PERIOD, name) for name in self.detector.update(noisy, CAMERA, self.time)]
        return found


@pytest.fixture
def film() -> Film:
    one = Film()
    one.show(TABLE, 1.0)
    assert one.detector.is_ready
    return one


def test_a_hand_that_stays_presses_once(film: Film) -> None:
    assert film.show(arm(), 1.0) == [(pytest.approx(0.35), "a")]
    assert film.show(arm(), 1.0) == []
    assert film.show(TABLE) == []
    assert film.show(arm(), 1.0) == [(pytest.approx(0.35), "a")]


def test_the_other_place_is_pressed_by_its_own_hand(film: Film) -> None:
    image = with_block(TABLE, (-0.35, -0.1, 0.85), (0.4, 0.1))
    assert [name for _, name in film.show(image, 1.0)] == ["b"]


@pytest.mark.parametrize(
    "images",
    [
        [(arm(), 0.25), (TABLE, 0.3), (arm(), 0.25)],  # passes through
        [(arm((0.2, -0.1, 0.82)), 1.0)],  # beside the place
        [(arm((0.2, 0.1, 1.2)), 1.0)],  # far above it
        [(with_block(TABLE, (0.2, 0.1, 0.8), (0.02, 0.02)), 1.0)],  # a screw
        [(with_block(TABLE, (0.2, 0.1, 0.76), (0.1, 0.1)), 1.0)],  # a sheet of 10 mm
        [(with_block(TABLE, (0.2, 0.0, 0.85), (0.5, 0.5)), 1.0)],  # a box of a quarter of a square metre
        [(np.full(TABLE.shape, math.nan), 1.0), (np.zeros(TABLE.shape), 1.0)],  # the camera is covered
    ],
)
def test_what_is_no_hand_presses_nothing(film: Film, images: Iterable[tuple[Array, float]]) -> None:
    assert [name for image, seconds in images for _, name in film.show(image, seconds)] == []


def test_a_part_that_is_laid_down_is_no_hand_for_long(film: Film) -> None:
    part = with_block(TABLE, (0.2, 0.1, 0.8), (0.1, 0.1))
    film.show(part, 3.0)  # looks like a hand once, then it is the background
    over = with_block(part, (0.4, 0.1, 0.9), (0.46, 0.09))
    assert [name for _, name in film.show(over, 1.0)] == ["a"]
    film.show(TABLE, 1.0)  # hand and part are taken away: the table is the background again
    assert [name for _, name in film.show(arm(), 1.0)] == ["a"]


def test_a_hand_there_from_the_beginning_presses_nothing() -> None:
    film = Film()
    assert film.show(arm(), 3.0) == []
    assert film.show(TABLE, 1.5) == []
    assert [name for _, name in film.show(arm(), 1.0)] == ["a"]


def test_images_that_come_late_twice_or_not_at_all(film: Film) -> None:
    film.show(arm(), 0.2)
    film.time += 5.0  # nothing came: the hand may have left in between
    assert film.show(arm(), 0.25) == []
    assert [name for _, name in film.show(arm(), 0.3)] == ["a"]
    film.time += 5.0
    assert film.show(arm(), 1.0) == []  # the same hand
    film.show(TABLE)
    film.show(arm(), 0.2)
    for _ in range(20):  # the same image again and again, and older ones
        assert film.detector.update(arm(), CAMERA, film.time) == []
        assert film.detector.update(arm(), CAMERA, film.time - 1.0) == []
    assert [name for _, name in film.show(arm(), 0.5)] == ["a"]


def test_a_camera_that_moves_learns_anew(film: Film) -> None:
    with pytest.raises(HandError, match="most of the depth image has changed"):
        film.show(TABLE - 0.3)
    assert film.show(TABLE - 0.3) == []
    assert film.detector.is_ready
    turned = Camera(CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy, Pose.from_xyz_rpy((0, 0, 2.1), (math.pi, 0, 0)))
    film.detector.update(TABLE, turned, film.time + 1.0)
    assert not film.detector.is_ready
    film.detector.update(TABLE[:60], turned, film.time + 2.0)
    film.detector.update(TABLE, turned, film.time + 3.0)
    assert not film.detector.is_ready


def test_a_place_outside_of_the_image_is_named() -> None:
    for place in ((3.0, 0.0, 0.75), (0.0, 0.0, 3.0)):
        detector = HandDetector(HandParameters(), {"a": place})
        with pytest.raises(HandError, match=rf"\[{place[0]:g}, 0, {place[2]:g}\] is outside"):
            detector.update(TABLE, CAMERA, 1.0)


def test_pixels_and_points_are_inverse() -> None:
    camera = Camera(300.0, 310.0, 70.0, 50.0, Pose.from_xyz_rpy((0.5, -1.0, 1.6), (-2.2, 0.1, 0.4)))
    places = camera.points(np.array([10, 90]), np.array([20, 140]), np.array([1.2, 2.0]))
    assert camera.pixel(tuple(places[0])) == pytest.approx((10.0, 20.0))  # type: ignore[arg-type]
    assert camera.pixel(tuple(places[1])) == pytest.approx((90.0, 140.0))  # type: ignore[arg-type]
