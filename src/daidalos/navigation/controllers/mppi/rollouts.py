"""Rollouts: many noisy control sequences, driven through the motion model of the robot."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

Samples = NDArray[np.float32]


@dataclass(frozen=True)
class Limits:
    """Limits of the robot: m/s, rad/s and their rates."""

    vx_min: float
    vx_max: float
    wz_max: float
    ax_min: float
    ax_max: float
    az_max: float


@dataclass(frozen=True)
class Rollouts:
    """Trajectories of one cycle; row b is the b-th sample, column t the end of the t-th step.

    Attributes
    ----------
    x, y, yaw : ndarray of float32, shape (batch, steps)
        Poses in the costmap's frame; the yaw is not wrapped.
    vx, wz : ndarray of float32, shape (batch, steps)
        Velocities that lead to them.
    costs : ndarray of float32, shape (batch,)
        Sum of what the critics gave.
    collides : ndarray of bool, shape (batch,)
        Whether a sample touches an obstacle.
    """

    x: Samples
    y: Samples
    yaw: Samples
    vx: Samples
    wz: Samples
    costs: Samples
    collides: NDArray[np.bool_]

    @classmethod
    def empty(cls, batch: int, steps: int) -> "Rollouts":
        """Return uninitialized rollouts of a number of samples and steps."""
        x, y, yaw, vx, wz = (np.zeros((batch, steps), dtype=np.float32) for _ in range(5))
        return cls(x, y, yaw, vx, wz, np.zeros(batch, dtype=np.float32), np.zeros(batch, dtype=np.bool_))

    def drive(
        self, pose: Array, velocity: Array, controls: Samples, noise: Samples, limits: Limits, step: float
    ) -> None:
        """Compute all trajectories from a pose and a velocity, and reset their costs.

        Parameters
        ----------
        pose, velocity : ndarray, shape (3,)
            State of the robot.
        controls : ndarray of float32, shape (steps, 2)
            Mean control sequence (forward velocity, angular velocity).
        noise : ndarray of float32, shape (batch, steps, 2)
            What is added to it.
        limits : Limits
            Velocities and accelerations are cut to these, so that what is judged is what the robot does.
        step : float
            Length of a step [s].
        """
        drive_differential(
            float(velocity[0]),
            float(velocity[2]),
            float(pose[0]),
            float(pose[1]),
            float(pose[2]),
            controls,
            noise,
            np.array(
                [limits.vx_min, limits.vx_max, limits.wz_max, limits.ax_min, limits.ax_max, limits.az_max],
                dtype=np.float64,
            ),
            step,
            self.x,
            self.y,
            self.yaw,
            self.vx,
            self.wz,
        )
        self.costs[:] = 0.0
        self.collides[:] = False


@compiled
def drive_differential(
    v0: float,
    w0: float,
    x0: float,
    y0: float,
    yaw0: float,
    controls: Samples,
    noise: Samples,
    limits: Array,
    step: float,
    x: Samples,
    y: Samples,
    yaw: Samples,
    vx: Samples,
    wz: Samples,
) -> None:
    """Integrate the motion of a differential-drive robot from one state for every sample.

    Within a step the velocities are constant and the displacement is along the mean heading. The heading is
    kept as a cosine and a sine that are turned by each step's small angle, which spares their evaluation.
    """
    slowest, fastest, turn = limits[0], limits[1], limits[2]
    braking, gaining, turning = limits[3] * step, limits[4] * step, limits[5] * step
    for b in range(x.shape[0]):
        v, w = v0, w0
        px, py, heading = x0, y0, yaw0
        cosine, sine = math.cos(yaw0), math.sin(yaw0)
        for t in range(x.shape[1]):
            wanted = min(max(controls[t, 0] + noise[b, t, 0], slowest), fastest)
            lower = braking if v >= 0.0 else -gaining
            upper = gaining if v >= 0.0 else -braking
            v = min(max(wanted, v + lower), v + upper)
            wanted = min(max(controls[t, 1] + noise[b, t, 1], -turn), turn)
            w = min(max(wanted, w - turning), w + turning)
            a = 0.5 * w * step
            a2 = a * a
            s = a * (1.0 - a2 * (1.0 / 6.0 - a2 / 120.0))
            c = 1.0 - a2 * (0.5 - a2 * (1.0 / 24.0 - a2 / 720.0))
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
            px += v * step * cosine
            py += v * step * sine
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
            heading += w * step
            x[b, t] = np.float32(px)
            y[b, t] = np.float32(py)
            yaw[b, t] = np.float32(heading)
            vx[b, t] = v
            wz[b, t] = w


def correlated_noise(generator: np.random.Generator, rows: int, steps: int, correlation: float) -> Samples:
    """Draw standard normal sequences in which neighbours are correlated, shape (rows, steps, 2).

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
    """
    noise = generator.standard_normal((rows, steps, 2), dtype=np.float32)
    fresh = np.float32(math.sqrt(1.0 - correlation * correlation))
    for t in range(1, steps):
        noise[:, t] = np.float32(correlation) * noise[:, t - 1] + fresh * noise[:, t]
    return noise
