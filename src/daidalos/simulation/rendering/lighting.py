"""Lights and background of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from daidalos.common.pose3 import Pose
from daidalos.description.link import Light, Rgba


@dataclass(frozen=True)
class Lighting:
    """Lights and background of a scene.

    Parameters
    ----------
    lights : sequence of (Light, Pose)
        Lights with their poses in the world.
    ambient, background : tuple of 4 floats
        Colours, 0..1.
    sky : bool
        A sky that is lighter at the horizon instead of the background.
    shadows : bool
        Whether the first parallel light that casts shadows does so.
    """

    lights: Sequence[tuple[Light, Pose]] = ()
    ambient: Rgba = (0.4, 0.4, 0.4, 1.0)
    background: Rgba = (0.7, 0.7, 0.7, 1.0)
    sky: bool = False
    shadows: bool = True
