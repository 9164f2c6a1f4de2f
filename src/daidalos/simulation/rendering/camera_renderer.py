"""Rendering of one camera: draws its view, then applies distortion, noise and the encoding of its sensor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose
from daidalos.simulation.noise import SILENT, Noise
from daidalos.simulation.physics import Physics
from daidalos.simulation.rendering.backends import make_renderer
from daidalos.simulation.rendering.image_effects import add_noise, distort, mosaic, pick
from daidalos.simulation.rendering.optics import Pinhole
from daidalos.simulation.rendering.renderer import View

_NOISE_TABLE = 1 << 20
_BAYER = {"rggb": ((0, 1), (1, 2)), "bggr": ((2, 1), (1, 0)), "gbrg": ((1, 2), (0, 1)), "grbg": ((1, 0), (2, 1))}


@dataclass(frozen=True)
class CameraRendererSettings:
    """Settings of a camera renderer.

    Parameters
    ----------
    pinhole : Pinhole
    near, far : float
        Between which depths it sees [m].
    mask : int
        Sees visuals whose visibility flags have a bit in common with it.
    noise : Noise
        On each colour of each pixel, in shares of full brightness.
    """

    pinhole: Pinhole
    near: float = 0.1
    far: float = 100.0
    mask: int = 0xFFFFFFFF
    noise: Noise = SILENT


class CameraRenderer:
    """Renderer of one camera; the arrays it returns belong to the caller.

    Parameters
    ----------
    settings : CameraRendererSettings
    """

    def __init__(self, settings: CameraRendererSettings) -> None:
        self.settings = settings
        self._renderer = make_renderer(settings.pinhole.ideal, settings.near, settings.far, settings.mask)
        self._view: View | None = None

    def render(self, physics: Physics, pose: Pose) -> None:
        """Render the current state of the simulation.

        Parameters
        ----------
        physics : Physics
        pose : Pose
            Of the camera in the world, x ahead and z up.
        """
        physics.refresh_positions()
        self._physics = physics
        data = physics.data
        self._view = self._renderer.render(physics.stage.scene, data.xpos, data.xmat, pose)

    @property
    def view(self) -> View:
        """View of the last `render`, without distortion."""
        if self._view is None:
            raise ValueError("nothing was rendered yet")
        return self._view

    def picture(self, start: int = 0) -> NDArray[np.uint8]:
        """Return the colours (height, width, 3) of the last view.

        Parameters
        ----------
        start : int
            Place in the table of noise; a random one for each picture.
        """
        data, pinhole = self._physics.data, self.settings.pinhole
        picture = self._renderer.paint(data.xpos, data.xmat, self._physics.stage.lighting)
        if pinhole.is_distorted:
            bent = np.empty((pinhole.height, pinhole.width, 3), dtype=np.uint8)
            distort(picture, pinhole.lookup, bent)
            picture = bent
        apply_noise(picture, self.settings.noise, start)
        return picture

    def depth(self, near: float = 0.0, far: float = np.inf) -> NDArray[np.float32]:
        """Return the depths (height, width) along the optical axis [m], infinite out of range as in REP 118."""
        return self._bent(self.view.depth(near, far))

    def of_parts(self, values: NDArray[Any], nothing: int = 0) -> NDArray[Any]:
        """Return for each pixel the value of the part of the scene that it sees."""
        return self._bent(self.view.of_parts(values, nothing))

    def _bent(self, ideal: NDArray[Any]) -> NDArray[Any]:
        pinhole = self.settings.pinhole
        if not pinhole.is_distorted:
            return ideal
        bent = np.empty((pinhole.height, pinhole.width), dtype=ideal.dtype)
        pick(ideal, pinhole.lookup, bent)
        return bent


def apply_noise(picture: NDArray[np.uint8], noise: Noise, start: int) -> None:
    """Add noise to a picture in place, from a place of a table on."""
    if noise.stddev or noise.mean:
        add_noise(picture.reshape(-1), _noise_table(noise.mean, noise.stddev), start % _NOISE_TABLE)


@lru_cache(maxsize=4)
def _noise_table(mean: float, stddev: float) -> NDArray[np.float32]:
    """Return random numbers that cameras with the same noise share; each picture reads from a place of its own."""
    return np.random.default_rng(0).normal(255 * mean, 255 * stddev, _NOISE_TABLE).astype(np.float32)


def encode(picture: NDArray[np.uint8], encoding: str) -> NDArray[Any]:
    """Return a picture (height, width, 3) in red, green, blue in another of ROS's encodings.

    Parameters
    ----------
    picture : array (height, width, 3) of uint8
    encoding : str
        ``rgb8``, ``bgr8``, ``rgba8``, ``bgra8``, ``rgb16``, ``mono8``, ``mono16`` or ``bayer_*8``.
    """
    if encoding == "rgb8":
        return picture
    if encoding == "bgr8":
        return np.ascontiguousarray(picture[:, :, ::-1])
    if encoding in ("rgba8", "bgra8"):
        opaque = np.full((*picture.shape[:2], 4), 255, dtype=np.uint8)
        opaque[:, :, :3] = picture if encoding == "rgba8" else picture[:, :, ::-1]
        return opaque
    if encoding == "rgb16":
        return picture.astype(np.uint16) * np.uint16(257)
    if encoding.startswith("bayer_"):
        raw = np.empty(picture.shape[:2], dtype=np.uint8)
        mosaic(picture, np.array(_BAYER[encoding[6:10]]), raw)
        return raw
    # Brightness after Rec. 601, as OpenCV computes it.
    grey = picture @ np.array((0.299, 0.587, 0.114), dtype=np.float32)
    if encoding == "mono8":
        return (grey + np.float32(0.5)).astype(np.uint8)
    if encoding == "mono16":
        return (grey * np.float32(257) + np.float32(0.5)).astype(np.uint16)
    raise ValueError(f"unknown encoding {encoding!r}")
