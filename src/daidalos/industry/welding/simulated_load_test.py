"""Load tests in the simulated cell: weights and springs on the tool, its places measured by a laser tracker."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.elasticity.load_tests import LoadTest
from daidalos.industry.robots.arm import Arm
from daidalos.industry.welding.experiments import tracked
from daidalos.industry.welding.simulated_cell import TIMESTEP, SimulatedCell

RISE_TIME = 0.4
"""Time in which a load changes to the next [s]."""
SETTLING_TIME = 1.1
"""Time after which the tool is measured [s]."""
SPEEDS = np.radians([0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 4.0, 8.0, 16.0])
"""Speeds of the runs that friction is told from [rad/s]."""
TORQUE_NOISE = 0.02
"""Standard deviation of measured torques, as a share of Coulomb friction."""


def measure(arm: Arm, truth: Elasticity, test: LoadTest, tool: NDArray[np.float64], seed: int) -> LoadTest:
    """Return a load test with the places that a laser tracker measures in the simulated cell, under gravity."""
    rng = np.random.default_rng(seed)
    simulated = SimulatedCell(arm, truth, tool, gravity=True, friction=True)
    places = np.empty((len(test.poses), 3))
    rising, holding = round(RISE_TIME / TIMESTEP), round(SETTLING_TIME / TIMESTEP)
    for number in np.unique(test.poses):
        rows = np.flatnonzero(test.poses == number)
        motors = test.joints[rows[0]]
        stages, last = [], np.zeros(6)
        for load in test.wrenches[rows]:
            share = np.linspace(0.0, 1.0, rising)[:, None]
            stages += [last + share * (load - last), np.tile(load, (holding, 1))]
            last = load
        wrenches = np.concatenate(stages)
        run = simulated.run(np.tile(motors, (len(wrenches), 1)), wrenches, TIMESTEP, np.eye(3))
        places[rows] = run.positions[(np.arange(len(rows)) + 1) * (rising + holding) - 1]
    return replace(test, places=tracked(places, rng))


def friction_runs(truth: Elasticity, seed: int) -> str:
    """Return torques of runs at constant speed as CSV: those of the robot's friction curve, with noise."""
    rng = np.random.default_rng(seed)
    lines = ["axis,speed_deg_s,torque_nm"]
    for speed in np.concatenate([SPEEDS, -SPEEDS]):
        torques = truth.friction(np.full(6, speed)) + rng.normal(size=6) * TORQUE_NOISE * truth.coulomb_friction
        lines += [f"{axis},{np.degrees(speed):.4f},{torque:.4f}" for axis, torque in enumerate(torques, 1)]
    return "\n".join(lines) + "\n"
