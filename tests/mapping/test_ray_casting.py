"""Rays in a grid."""

import math

import numpy as np
import pytest

from daidalos.mapping.ray_casting import cast_rays


def test_rays_end_at_occupied_cells_and_nowhere_else() -> None:
    occupied = np.zeros((40, 60), bool)
    occupied[:, 50] = True  # from x = 1.5 on, the origin being at (-1, -1)
    occupied[5, :] = True  # up to y = -0.7
    pose = np.array([0.0, 0.0, math.pi / 2])
    angles = np.array([-math.pi / 2, 0.0, math.pi, -math.pi / 4])
    distances = cast_rays(occupied, 0.05, np.array([-1.0, -1.0]), pose, angles, 5.0)
    assert distances == pytest.approx([1.5, math.inf, 0.7, math.inf], abs=0.05)
