"""Experiments of the workshop in the simulated cell: welding with and without correction, measured by a tracker."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.deflection import Options, deflections, windings
from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.welding.correction import Cell, in_axes
from daidalos.industry.welding.planning import Plan, Request, plan
from daidalos.industry.welding.seam import Seam
from daidalos.industry.welding.simulated_cell import TIMESTEP, SimulatedCell

WRENCH = np.array([420.0, -175.0, 8000.0, 0.0, 0.0, 7.0])
"""Measured in the workshop: that the tool exerts, x ahead, z into the workpiece [N, Nm]."""
SPEED = 0.3 / 60.0
"""Advance [m/s]."""
SPINDLE_SPEED = 800.0 / 60.0
"""[turns/s]"""

PLUNGE_TIME = 1.0
"""Time in which the force rises [s]."""
SETTLING_TIME = 2.0
"""Time at the first point before the weld [s]."""
SAMPLE_PERIOD = 0.05
RIPPLE = np.array([0.10, 0.10, 0.03, 0.0, 0.0, 0.10])
"""Amplitude of the force at the spindle's frequency, as a share of the force; the lateral one is a quarter later."""
NOISE = np.array([30.0, 30.0, 120.0, 1.0, 1.0, 0.5])
"""Standard deviation of the force's noise, which changes every 10 ms [N, Nm]."""
NOISE_PERIOD = 0.01
TRACKER_POSITION = np.array([4.0, -3.0, 1.5])
"""Place of the laser tracker in the base [m]."""


@dataclass(frozen=True)
class Weld:
    """A weld that was measured.

    Attributes
    ----------
    distances : array of shape (n,)
        Length of the desired path at each sample [m].
    deviations : array of shape (n, 3)
        Of the measured tool ahead, across and along the tool [m].
    zones : tuple of str
        Zone of each sample.
    """

    distances: NDArray[np.float64]
    deviations: NDArray[np.float64]
    zones: tuple[str, ...]

    @property
    def rms(self) -> NDArray[np.float64]:
        """Return the root mean squares ahead, across and along the tool (3,) [m]."""
        values: NDArray[np.float64] = np.sqrt((self.deviations**2).mean(axis=0))
        return values

    @property
    def lateral_range(self) -> tuple[float, float]:
        """Return the least and the greatest deviation across the path [m]."""
        return float(self.deviations[:, 1].min()), float(self.deviations[:, 1].max())


@dataclass(frozen=True)
class Experiment:
    """A path welded without correction, with correction for stiffness only, and with that for backlash too.

    Attributes
    ----------
    plans, welds : dict
        By name: ``uncorrected``, ``without_backlash`` and ``corrected``.
    """

    plans: dict[str, Plan]
    welds: dict[str, Weld]


def run_experiment(cell: Cell, truth: Elasticity, seam: Seam, seed: int = 0, points: int | None = None) -> Experiment:
    """Weld a seam in the simulated cell and measure it.

    Parameters
    ----------
    cell : Cell
        What the correction knows of the robot.
    truth : Elasticity
        What the simulated robot has.
    seam : Seam
        The seam.
    seed : int
        Of the forces' noise and the tracker's.
    points : int or None
        Points of the corrected path.
    """
    request = Request(SPEED, WRENCH, points=points)
    stiff = replace(cell, options=replace(cell.options, backlash=(False,) * 6))
    corrected, without = plan(cell, seam, request), plan(stiff, seam, request)
    simulated = SimulatedCell(cell.arm, truth, cell.tool, cell.options.gravity)
    welds = {
        "uncorrected": weld(simulated, corrected, _desired_motors(corrected), seed),
        "without_backlash": weld(simulated, without, without.correction.motors, seed + 1),
        "corrected": weld(simulated, corrected, corrected.correction.motors, seed + 2),
    }
    return Experiment({"uncorrected": corrected, "without_backlash": without, "corrected": corrected}, welds)


def weld(simulated: SimulatedCell, planned: Plan, motors: NDArray[np.float64], seed: int) -> Weld:
    """Weld with the motors' angles at each point of a plan (n, 6) [rad], and measure with a laser tracker."""
    rng = np.random.default_rng(seed)
    distances = planned.correction.distances
    start = PLUNGE_TIME + SETTLING_TIME
    times = np.arange(0.0, start + distances[-1] / planned.speed, TIMESTEP)
    along = np.maximum(times - start, 0.0) * planned.speed
    angles = np.stack([np.interp(along, distances, column) for column in motors.T], axis=1)
    run = simulated.run(angles, process_forces(planned, times, along, rng), SAMPLE_PERIOD)
    welding = run.times >= start
    measured = tracked(run.positions[welding], rng)
    along = np.clip((run.times[welding] - start) * planned.speed, 0.0, distances[-1])
    wanted = np.stack([np.interp(along, distances, one) for one in planned.correction.desired[:, :3, 3].T], axis=1)
    nearest = np.clip(np.searchsorted(distances, along), 0, len(distances) - 1)
    zones = tuple(planned.seam.zones[int(one)] for one in nearest) if planned.seam.zones else ()
    return Weld(along, in_axes(planned.axes[nearest], measured - wanted), zones)


def process_forces(
    planned: Plan, times: NDArray[np.float64], along: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """Return what the tool exerts at times (m,) [s] and lengths of the path (m,) [m], with ripple and noise.

    (m, 6) in the tool's axes [N, Nm]; the force rises in the first second.
    """
    at = np.clip(np.searchsorted(planned.correction.distances, along, side="right") - 1, 0, len(planned.axes) - 1)
    phase = 2.0 * np.pi * SPINDLE_SPEED * times
    waves = np.stack([np.cos(phase), np.sin(phase), np.cos(phase), 0.0 * phase, 0.0 * phase, np.cos(phase)], axis=1)
    noise = rng.normal(size=(int(times[-1] / NOISE_PERIOD) + 2, 6)) * NOISE
    acting = planned.wrenches[at] * (1.0 + RIPPLE * waves) + noise[(times / NOISE_PERIOD).astype(np.int64)]
    acting *= np.minimum(times / PLUNGE_TIME, 1.0)[:, None]
    turns = (np.swapaxes(planned.correction.desired[:, :3, :3], 1, 2) @ planned.axes)[at]
    return np.concatenate([np.einsum("nij,nj->ni", turns, acting[:, part]) for part in (slice(3), slice(3, 6))], 1)


def tracked(positions: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Return positions (n, 3) [m] as a laser tracker measures them: standard deviation 8 um + 3 um per metre."""
    ranges = np.linalg.norm(positions - TRACKER_POSITION, axis=1, keepdims=True)
    measured: NDArray[np.float64] = positions + rng.normal(size=positions.shape) * (8e-6 + 3e-6 * ranges)
    return measured


def model_deflections(planned: Plan) -> NDArray[np.float64]:
    """Return the deflections of the workshop's formula at the points of a plan, without backlash.

    (n, 6): ahead, across and along the tool [m], and A, B, C [rad].
    """
    cell, done = planned.cell, planned.correction
    wound, _ = windings(cell.elasticity, done.after.torques, Options(backlash=(False,) * 6))
    out = deflections(cell.arm, done.after.joints, done.desired[:, :3, 3], wound)
    out[:, :3] = in_axes(planned.axes, out[:, :3])
    return out


def figures(experiment: Experiment) -> dict[str, Any]:
    """Return the figures of an experiment [mm]."""
    out: dict[str, Any] = {}
    for name, one in experiment.welds.items():
        rms = 1e3 * one.rms
        out[name] = {
            "ahead_rms_mm": round(float(rms[0]), 4),
            "across_rms_mm": round(float(rms[1]), 4),
            "along_tool_rms_mm": round(float(rms[2]), 4),
            "across_range_mm": [round(1e3 * value, 4) for value in one.lateral_range],
        }
    return out


def _desired_motors(planned: Plan) -> NDArray[np.float64]:
    """Return the motors' angles (n, 6) when the desired path is programmed as it is [rad]."""
    from daidalos.industry.welding.joint_paths import choose_branch

    done = planned.correction
    return choose_branch(planned.cell.arm, done.desired @ np.linalg.inv(planned.cell.tool), "path")[0]
