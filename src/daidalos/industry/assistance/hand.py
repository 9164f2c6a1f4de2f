"""A hand above a place of the cell, seen by a depth camera.

What is nearer than a learnt background is in front of it. A blob of such pixels of the size of a hand with its arm that
reaches into the space above a place for long enough presses it, as it would press a button.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Pose, Vector, rotation_matrix

Array = NDArray[np.float64]
MAX_GAP_S = 1.0
"""Time without images after which a hand has to stay for the whole time again."""

_RELEASE_S = 0.2
"""Time for which a place has to be free before it can be pressed again."""

_FARTHER_S = 0.5
"""Time after which what is farther than the background becomes the background."""

_STILL = 0.01
"""Change of a depth [m] up to which it stands still."""

_MOVED_SHARE = 0.5
"""Share of the image that differs from the background when the camera was moved, or something stands before it."""


class HandError(UserError):
    """Error of images in which no hand can be seen; the message names the reason."""


@dataclass(frozen=True)
class HandParameters(Parameters):
    """Parameters of the depth camera of a work sequence, and of the hands that it sees."""

    depth: str = parameter("/camera/depth/image_raw", "Topic of the depth images.", not_empty=True)
    info: str = parameter("/camera/depth/camera_info", "Topic of the camera's calibration.", not_empty=True)
    radius: float = parameter(0.08, "Radius of the space above a place.", unit="m", above=0.0)
    height: float = parameter(0.2, "Height of the space above a place.", unit="m", above=0.0)
    min_height: float = parameter(0.02, "Least distance of a hand from the background.", unit="m", above=0.0)
    min_area: float = parameter(0.0015, "Least area of a hand in that space.", unit="m^2", above=0.0)
    max_area: float = parameter(0.2, "Greatest area of a hand with its arm.", unit="m^2", above=0.0)
    hold: float = parameter(0.4, "Time for which the hand has to stay.", unit="s", minimum=0.0)
    frames: int = parameter(15, "Images from which the background is learnt.", minimum=1, maximum=200)
    absorb: float = parameter(
        5.0, "Time after which what stands still becomes the background, such as a part that was laid down.",
        unit="s", above=0.0,
    )  # fmt: skip


@dataclass(frozen=True)
class Camera:
    """Depth camera: focal lengths and principal point [pixels], and the pose of its optical frame in the world."""

    fx: float
    fy: float
    cx: float
    cy: float
    pose: Pose

    def points(self, rows: NDArray[np.int64], columns: NDArray[np.int64], depths: Array) -> Array:
        """Return the points ``(n, 3)`` of the world at pixels with depths along the optical axis [m]."""
        seen = np.column_stack([(columns - self.cx) / self.fx, (rows - self.cy) / self.fy, np.ones(len(rows))])
        return np.asarray(depths[:, None] * seen @ rotation_matrix(self.pose.orientation).T + self.pose.position)

    def pixel(self, place: Vector) -> tuple[float, float]:
        """Return row and column of a point of the world; not numbers where it is behind the camera."""
        x, y, z = self.pose.inverse.transform(place)
        return (self.cy + self.fy * y / z, self.cx + self.fx * x / z) if z > 0.0 else (np.nan, np.nan)


class HandDetector:
    """Detector of hands above places, for the images of one camera that come one by one.

    Parameters
    ----------
    parameters : HandParameters
    places : mapping of str to (x, y, z)
        Bottom centres of the spaces above which a hand is looked for [m].
    """

    def __init__(self, parameters: HandParameters, places: Mapping[str, Vector]) -> None:
        self._parameters = parameters
        self._places = dict(places)
        self._buttons = {name: _Button(parameters.hold) for name in places}
        self._camera: Camera | None = None
        self._stamp = -np.inf
        self._learning: list[Array] = []
        self._background: _Background | None = None

    @property
    def is_ready(self) -> bool:
        """Whether the background is known."""
        return self._background is not None

    def update(self, depth: Array, camera: Camera, stamp: float) -> list[str]:
        """Take an image and return the places that a hand presses from now on.

        Parameters
        ----------
        depth : (height, width) array
            Along the optical axis [m]; 0 or not a number where it is not known.
        camera : Camera
            When it changes, the background is learnt anew.
        stamp : float
            Time of the image [s]; an image that is not newer than the one before is left out.

        Raises
        ------
        HandError
            When a place is outside of the image, or the whole image has changed; the background is learnt anew.
        """
        if stamp <= self._stamp:
            return []
        dt, self._stamp = stamp - self._stamp, stamp
        depth = np.where(np.isfinite(depth) & (depth > 0.0), depth, np.nan)
        if camera != self._camera or (self._background is not None and self._background.depth.shape != depth.shape):
            self._check_places(camera, depth.shape)
            self._camera, self._background, self._learning = camera, None, []
        if self._background is None:
            self._learn(depth)
            return []
        if dt > MAX_GAP_S:
            dt = 0.0
            for button in self._buttons.values():
                button.interrupt()
        nearer, farther = self._background.compare(depth, self._parameters.min_height)
        if np.count_nonzero(nearer | farther) > _MOVED_SHARE * depth.size:
            self._background, self._learning = None, []
            raise HandError("most of the depth image has changed; the background is learnt anew")
        pressed = self._pressed(depth, nearer, camera)
        self._background.adapt(depth, nearer, farther, dt, self._parameters.absorb)
        return [name for name, button in self._buttons.items() if button.update(name in pressed, stamp)]

    def _check_places(self, camera: Camera, shape: tuple[int, ...]) -> None:
        for x, y, z in self._places.values():
            row, column = camera.pixel((x, y, z))
            if not (0.0 <= row < shape[0] and 0.0 <= column < shape[1]):
                raise HandError(f"the place [{x:g}, {y:g}, {z:g}] is outside of the depth camera's image")

    def _learn(self, depth: Array) -> None:
        self._learning.append(depth)
        if len(self._learning) >= self._parameters.frames:
            self._background = _Background(_median(np.array(self._learning)))
            self._learning = []
            self._buttons = {name: _Button(self._parameters.hold) for name in self._places}

    def _pressed(self, depth: Array, nearer: NDArray[np.bool_], camera: Camera) -> set[str]:
        """Return the places into whose spaces a blob of the size of a hand reaches."""
        from scipy.ndimage import label

        rows, columns = np.nonzero(nearer)
        if not len(rows):
            return set()
        one = self._parameters
        depths = depth[rows, columns]
        points = camera.points(rows, columns, depths)
        areas = depths**2 / (camera.fx * camera.fy)
        blobs = label(nearer)[0][rows, columns]
        is_hand = np.bincount(blobs, areas) <= one.max_area
        found = set()
        for name, (x, y, z) in self._places.items():
            is_within = (np.hypot(points[:, 0] - x, points[:, 1] - y) <= one.radius) & is_hand[blobs]
            is_within &= (points[:, 2] >= z - one.min_height) & (points[:, 2] <= z + one.height)
            if np.bincount(blobs[is_within], areas[is_within], minlength=1).max() >= one.min_area:
                found.add(name)
        return found


class _Background:
    """Depth image without hands, which follows what is taken away or laid down."""

    def __init__(self, depth: Array) -> None:
        self.depth = depth
        self._farther = np.zeros(depth.shape)
        self._still = np.zeros(depth.shape)
        self._before = depth.copy()

    def compare(self, depth: Array, threshold: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return what is nearer and what is farther; neither where one of both is not known."""
        return self.depth - depth > threshold, depth - self.depth > threshold

    def adapt(
        self, depth: Array, nearer: NDArray[np.bool_], farther: NDArray[np.bool_], dt: float, absorb: float
    ) -> None:
        """Take over what has been farther for a while, or has stood still for long."""
        is_new = farther | (np.isnan(self.depth) & np.isfinite(depth))
        self._farther = np.where(is_new, self._farther + dt, 0.0)
        is_still = nearer & (np.abs(depth - self._before) < _STILL)
        self._still = np.where(is_still, self._still + dt, 0.0)
        self._before = np.where(is_still, self._before, depth)
        is_taken = (self._farther > _FARTHER_S) | (self._still > absorb)
        self.depth = np.where(is_taken, depth, self.depth)


class _Button:
    """State of a place: it is pressed once by a hand that stays, after it has been free."""

    def __init__(self, hold: float) -> None:
        self._hold = hold
        self._is_armed = False
        self._pressed_since = self._free_since = np.nan

    def interrupt(self) -> None:
        """Forget how long it has been pressed or free."""
        self._pressed_since = self._free_since = np.nan

    def update(self, is_pressed: bool, stamp: float) -> bool:
        """Return whether it becomes pressed."""
        if not is_pressed:
            self._pressed_since = np.nan
            if np.isnan(self._free_since):
                self._free_since = stamp
            self._is_armed |= bool(stamp - self._free_since >= _RELEASE_S)
            return False
        self._free_since = np.nan
        if np.isnan(self._pressed_since):
            self._pressed_since = stamp
        if not self._is_armed or stamp - self._pressed_since < self._hold:
            return False
        self._is_armed = False
        return True


def _median(images: Array) -> Array:
    """Return the median of images of each pixel that most of them know, else not a number."""
    known = np.isfinite(images).sum(axis=0)
    ordered = np.sort(images, axis=0)  # what is no number comes last
    middle = np.take_along_axis(ordered, np.maximum(known - 1, 0)[None] // 2, axis=0)[0]
    return np.where(2 * known > len(images), middle, np.nan)
