"""Model predictive control: corrections over a horizon, within the limits of each and of their sum."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.contracts import LoopSetup, Observation, SeamController
from daidalos.industry.servoing.controllers.limits_kernel import limit_prices
from daidalos.industry.servoing.controllers.plant_model import robot_model

Vector = NDArray[np.float64]

HORIZON = 30
"""Cycles."""
EFFORT = 1.0
"""Cost of a correction beside that of a deviation."""
MAX_SWEEPS = 400
TOLERANCE = 1e-9
"""Change of a limited value below which the solver ends [m]."""


class MpcController(SeamController):
    """Least squares of the predicted deviations, solved each cycle.

    Limits are those of each correction and of the sum of the corrections. The prices of the limits are those of the
    cycle before, to begin with.
    """

    names = ("mpc",)

    def __init__(self, setup: LoopSetup) -> None:
        super().__init__(setup)
        a, b, c = robot_model(setup.model)
        powers = [np.eye(3)]
        for _ in range(HORIZON):
            powers.append(a @ powers[-1])
        self._free = np.array([c @ power for power in powers[1:]])
        impulse = np.array([float(c @ power @ b) for power in powers[:HORIZON]])
        rows, columns = np.indices((HORIZON, HORIZON))
        self._forced = np.where(rows >= columns, impulse[np.abs(rows - columns)], 0.0)
        curvature = self._forced.T @ self._forced + EFFORT * np.eye(HORIZON)
        self._limited = np.concatenate([np.eye(HORIZON), np.tril(np.ones((HORIZON, HORIZON)))])
        self._inverse = np.linalg.inv(curvature)
        self._priced = self._inverse @ self._limited.T
        self._coupling = np.ascontiguousarray(self._limited @ self._priced)
        self._prices = np.zeros(2 * HORIZON)
        self._speed = 0.0
        self._last: float | None = None

    def step(self, observation: Observation) -> float:
        """Return the first correction of the best ones; see `SeamController.step`."""
        cycle = self.setup.model.cycle
        if self._last is not None:
            self._speed = (observation.lateral - self._last) / cycle
        self._last = observation.lateral
        ahead = observation.s + self.setup.speed * cycle * np.arange(1.0, HORIZON + 1.0)
        state = np.array([observation.lateral, self._speed, observation.commanded])
        target = self._forced.T @ (observation.seam(ahead) - self._free @ state)
        return float(self._solve(target, observation.commanded)[0])

    def hold(self) -> None:
        """Forget the speed and the prices of the limits."""
        self._prices[:] = 0.0
        self._last, self._speed = None, 0.0

    def _solve(self, target: Vector, commanded: float) -> Vector:
        """Return the corrections (HORIZON,) with the least cost within the limits."""
        most, total = self.setup.max_step, self.setup.max_correction
        upper = np.repeat([most, total - commanded], HORIZON)
        lower = np.repeat([-most, -total - commanded], HORIZON)
        free: Vector = self._inverse @ target
        values = self._limited @ free - self._coupling @ self._prices
        limit_prices(self._coupling, values, lower, upper, self._prices, MAX_SWEEPS, TOLERANCE)
        out: Vector = free - self._priced @ self._prices
        return out
