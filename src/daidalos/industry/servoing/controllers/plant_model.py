"""Model of the robot in discrete time, for controllers that are computed from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.loop_design import LoopModel

Matrix = NDArray[np.float64]


def robot_model(model: LoopModel) -> tuple[Matrix, Matrix, Matrix]:
    """Return A (3, 3), B (3,) and C (3,) of the state place, speed, and sum of the corrections.

    A correction is added to the sum, which the robot follows over the cycle after it.
    """
    from scipy.linalg import expm

    w, d = model.natural_frequency, model.damping
    move = expm(np.array([[0.0, 1.0], [-(w**2), -2.0 * d * w]]) * model.cycle)
    a = np.eye(3)
    a[:2, :2] = move
    a[:2, 2] = (np.eye(2) - move) @ np.array([1.0, 0.0])
    b = np.array([*a[:2, 2], 1.0])
    return a, b, np.array([1.0, 0.0, 0.0])
