"""Rollouts: many noisy control sequences, driven through the motion model of the robot."""

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

Samples = NDArray[np.float32]


@dataclass(frozen=True)
class Limits:
    """Limits of the robot: m/s, rad/s and their rates; `curvature_max` [1/m] of robots that steer."""

    vx_min: float
    vx_max: float
    wz_max: float
    ax_min: float
    ax_max: float
    az_max: float
    vy_max: float = 0.0
    ay_min: float = 0.0
    ay_max: float = 0.0
    curvature_max: float = math.inf

    def as_array(self) -> Array:
        """Return the limits in the order of the fields, for `integrate`."""
        return np.array([getattr(self, entry.name) for entry in fields(self)], dtype=np.float64)


@dataclass(frozen=True)
class Rollouts:
    """Trajectories of one cycle; row b is the b-th sample, column t the end of the t-th step.

    Attributes
    ----------
    x, y, yaw : ndarray of float32, shape (batch, steps)
        Poses in the costmap's frame; the yaw is not wrapped.
    vx, vy, wz : ndarray of float32, shape (batch, steps)
        Velocities that lead to them; `vy` is zero for robots that cannot move sideways.
    costs : ndarray of float32, shape (batch,)
        Sum of what the critics gave.
    collides : ndarray of bool, shape (batch,)
        Whether a sample touches an obstacle.
    """

    x: Samples
    y: Samples
    yaw: Samples
    vx: Samples
    vy: Samples
    wz: Samples
    costs: Samples
    collides: NDArray[np.bool_]

    @classmethod
    def empty(cls, batch: int, steps: int) -> "Rollouts":
        """Return uninitialized rollouts of a number of samples and steps."""
        x, y, yaw, vx, vy, wz = (np.zeros((batch, steps), dtype=np.float32) for _ in range(6))
        return cls(x, y, yaw, vx, vy, wz, np.zeros(batch, dtype=np.float32), np.zeros(batch, dtype=np.bool_))

    def drive(
        self, pose: Array, velocity: Array, controls: Samples, noise: Samples, limits: Limits, step: float
    ) -> None:
        """Compute all trajectories from a pose and a velocity, and reset their costs.

        Parameters
        ----------
        pose, velocity : ndarray, shape (3,)
            State of the robot.
        controls : ndarray of float32, shape (steps, 2 or 3)
            Mean control sequence (forward velocity, angular velocity, and where there is a third: lateral velocity).
        noise : ndarray of float32, shape (batch, steps, 2 or 3)
            What is added to it.
        limits : Limits
            Velocities and accelerations are cut to these, so that what is judged is what the robot does.
        step : float
            Length of a step [s].
        """
        integrate(
            np.array(velocity, dtype=np.float64),
            np.array(pose, dtype=np.float64),
            controls,
            noise,
            limits.as_array(),
            step,
            self.x,
            self.y,
            self.yaw,
            self.vx,
            self.vy,
            self.wz,
        )
        self.costs[:] = 0.0
        self.collides[:] = False


@compiled
def integrate(
    velocity: Array,
    pose: Array,
    controls: Samples,
    noise: Samples,
    limits: Array,
    step: float,
    x: Samples,
    y: Samples,
    yaw: Samples,
    vx: Samples,
    vy: Samples,
    wz: Samples,
) -> None:
    """Integrate the motion of a robot from one state for every sample.

    Within a step the velocities are constant and the displacement is along the mean heading. The heading is
    kept as a cosine and a sine that are turned by each step's small angle, which spares their evaluation.
    """
    slowest, fastest, turn = limits[0], limits[1], limits[2]
    braking, gaining, turning = limits[3] * step, limits[4] * step, limits[5] * step
    aside, braking_aside, gaining_aside = limits[6], limits[7] * step, limits[8] * step
    curvature = limits[9]
    sideways = controls.shape[1] == 3
    for b in range(x.shape[0]):
        v, u, w = velocity[0], 0.0, velocity[2]
        if sideways:
            u = velocity[1]
        px, py, heading = pose[0], pose[1], pose[2]
        cosine, sine = math.cos(heading), math.sin(heading)
        for t in range(x.shape[1]):
            v = _approach(controls[t, 0] + noise[b, t, 0], slowest, fastest, v, braking, gaining)
            wanted = min(max(controls[t, 1] + noise[b, t, 1], -turn), turn)
            w = min(max(wanted, w - turning), w + turning)
            if curvature < math.inf:
                tightest = abs(v) * curvature
                w = min(max(w, -tightest), tightest)
            a = 0.5 * w * step
            a2 = a * a
            s = a * (1.0 - a2 * (1.0 / 6.0 - a2 / 120.0))
            c = 1.0 - a2 * (0.5 - a2 * (1.0 / 24.0 - a2 / 720.0))
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
            px += v * step * cosine
            py += v * step * sine
            if sideways:
                u = _approach(controls[t, 2] + noise[b, t, 2], -aside, aside, u, braking_aside, gaining_aside)
                px -= u * step * sine
                py += u * step * cosine
                vy[b, t] = u
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
            heading += w * step
            x[b, t] = np.float32(px)
            y[b, t] = np.float32(py)
            yaw[b, t] = np.float32(heading)
            vx[b, t] = v
            wz[b, t] = w


@compiled
def _approach(wanted: float, slowest: float, fastest: float, v: float, braking: float, gaining: float) -> float:
    """Return a velocity within its limits, no farther from the last than a step's acceleration or deceleration."""
    wanted = min(max(wanted, slowest), fastest)
    lower = braking if v >= 0.0 else -gaining
    upper = gaining if v >= 0.0 else -braking
    return min(max(wanted, v + lower), v + upper)


def correlated_noise(
    generator: np.random.Generator, rows: int, steps: int, correlation: float, axes: int = 2
) -> Samples:
    """Draw standard normal sequences in which neighbours are correlated, shape (rows, steps, axes).

    A first-order process of unit variance. White noise averages out over a horizon, so that all samples go
    nearly the same way; correlated noise spreads them and changes smoothly (Vlahov et al. 2024, "Low
    Frequency Sampling in Model Predictive Path Integral Control").

    Parameters
    ----------
    generator : numpy.random.Generator
        Source of randomness.
    rows, steps : int
        Number and length of the sequences.
    correlation : float
        Between neighbours, 0 to less than 1.
    axes : int
        Number of velocities.
    """
    noise = generator.standard_normal((rows, steps, axes), dtype=np.float32)
    fresh = np.float32(math.sqrt(1.0 - correlation * correlation))
    for t in range(1, steps):
        noise[:, t] = np.float32(correlation) * noise[:, t - 1] + fresh * noise[:, t]
    return noise
