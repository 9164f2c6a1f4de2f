"""Linear-quadratic control with preview of the seam, and a Kalman filter of the robot.

T. Katayama, T. Ohki, T. Inoue and T. Kato, "Design of an optimal controller for a discrete-time system subject to
previewable demand", 1985: the future demand enters through gains that follow from the Riccati equation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.contracts import LoopSetup, Observation, SeamController
from daidalos.industry.servoing.controllers.plant_model import robot_model

PREVIEW = 60
"""Cycles that are looked ahead."""
EFFORT = 1.0
"""Cost of a correction beside that of a deviation."""
PLACE_NOISE, MOTION_NOISE = 5e-6, 2e-6
"""Standard deviations of the reported place, and of what moves the robot beside its model [m]."""


class LqgController(SeamController):
    """LQ regulator with preview on a Kalman filter's estimate."""

    names = ("lqg",)

    def __init__(self, setup: LoopSetup) -> None:
        from scipy.linalg import solve_discrete_are

        super().__init__(setup)
        a, b, c = robot_model(setup.model)
        column = b[:, None]
        cost = solve_discrete_are(a, column, np.outer(c, c), np.array([[EFFORT]]))
        weight = EFFORT + float(b @ cost @ b)
        self._gain = (b @ cost @ a) / weight
        closed = (a - np.outer(b, self._gain)).T
        preview, demand = [], c.copy()
        for _ in range(PREVIEW):
            preview.append(float(b @ demand) / weight)
            demand = closed @ demand
        # A constant seam must lead to a constant place: the last gain stands for all that come later.
        preview[-1] += float(self._gain @ np.array([1.0, 0.0, 1.0])) - sum(preview)
        self._preview = np.array(preview)
        noise = np.diag([MOTION_NOISE**2, (MOTION_NOISE / setup.model.cycle) ** 2, 1e-18])
        spread = solve_discrete_are(a.T, c[:, None], noise, np.array([[PLACE_NOISE**2]]))
        self._correct = spread @ c / (float(c @ spread @ c) + PLACE_NOISE**2)
        self._a, self._b = a, b
        self._state: NDArray[np.float64] | None = None

    def step(self, observation: Observation) -> float:
        """Return the regulator's correction; see `SeamController.step`."""
        if self._state is None:
            self._state = np.array([observation.lateral, 0.0, observation.commanded])
        estimate = self._state + self._correct * (observation.lateral - self._state[0])
        estimate[2] = observation.commanded
        cycle = self.setup.model.cycle
        ahead = observation.s + self.setup.speed * cycle * np.arange(1.0, PREVIEW + 1.0)
        wanted = float(self._preview @ observation.seam(ahead) - self._gain @ estimate)
        correction = min(max(wanted, -self.setup.max_step), self.setup.max_step)
        self._state = self._a @ estimate + self._b * correction
        return correction

    def hold(self) -> None:
        """Forget the estimate."""
        self._state = None
