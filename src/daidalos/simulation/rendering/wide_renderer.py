"""Rendering of wide-angle cameras: sides of a cube around the camera, resampled by the lens."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose
from daidalos.simulation.noise import SILENT, Noise
from daidalos.simulation.physics import Physics
from daidalos.simulation.rendering.backends import make_renderer
from daidalos.simulation.rendering.camera_renderer import apply_noise
from daidalos.simulation.rendering.image_effects import distort
from daidalos.simulation.rendering.wide_lens import WideLens


class WideRenderer:
    """Renderer of one wide-angle camera; the pictures it returns belong to the caller.

    Parameters
    ----------
    lens : WideLens
    near, far : float
        Depths between which things are seen, along the axis of each side of the cube [m].
    mask : int
        Sees visuals whose visibility flags have a bit in common with it.
    noise : Noise
        On each colour of each pixel, in shares of full brightness.
    """

    def __init__(self, lens: WideLens, near: float, far: float, mask: int, noise: Noise = SILENT) -> None:
        self._lens = lens
        self._noise = noise
        self._sides = [(face, make_renderer(face.pinhole, near, far, mask)) for face in lens.faces]

    def picture(self, physics: Physics, pose: Pose, start: int = 0) -> NDArray[np.uint8]:
        """Return the colours (height, width, 3) that the camera sees, black where its lens shows nothing.

        Parameters
        ----------
        physics : Physics
        pose : Pose
            Of the camera in the world, x ahead and z up.
        start : int
            Place in the table of noise; a random one for each picture.
        """
        physics.refresh_positions()
        data, stage = physics.data, physics.stage
        picture = np.zeros((self._lens.height, self._lens.width, 3), dtype=np.uint8)
        flat = picture.reshape(-1, 3)
        for face, renderer in self._sides:
            renderer.render(stage.scene, data.xpos, data.xmat, pose @ face.pose)
            side = renderer.paint(data.xpos, data.xmat, stage.lighting)
            resampled = np.empty((1, len(face.pixels), 3), dtype=np.uint8)
            distort(side, face.places, resampled)
            flat[face.pixels] = resampled[0]
        apply_noise(picture, self._noise, start)
        return picture
