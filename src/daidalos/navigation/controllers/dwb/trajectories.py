"""Trajectories of constant commands, which the DWB controller chooses from."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import ParameterError, Parameters, parameter

MAX_POSES = 2000
"""Largest number of poses of one trajectory; finer granularities are made coarser."""


@dataclass(frozen=True)
class Trajectories:
    """Trajectories of one cycle.

    Attributes
    ----------
    commands : ndarray, shape (n, 3)
        Velocities (x [m/s], y [m/s], yaw [rad/s]) that are commanded, in the robot's frame.
    poses : ndarray, shape (n, m, 3)
        Poses (x, y, yaw) in the costmap's frame, from the robot's on; those beyond `counts` mean nothing.
    counts : ndarray of int64, shape (n,)
        Number of poses of each.
    duration : float
        Simulated time [s] of each.
    """

    commands: Array
    poses: Array
    counts: NDArray[np.int64]
    duration: float

    def at_time(self, time: float) -> Array:
        """Return the poses (n, 3) at a time [s], or the last ones where it is beyond the end or negative."""
        last = self.counts - 1
        index = last
        if 0.0 <= time < self.duration:
            index = np.minimum(np.ceil(time / self.duration * last).astype(np.int64), last)
        poses: Array = self.poses[np.arange(last.size), index]
        return poses

    def subset(self, chosen: NDArray[np.bool_]) -> "Trajectories":
        """Return some of the trajectories."""
        return Trajectories(self.commands[chosen], self.poses[chosen], self.counts[chosen], self.duration)


@dataclass(frozen=True)
class GeneratorParameters(Parameters):
    """Velocities of the robot, and how they are sampled and simulated, by their Nav2 names."""

    trajectory_generator_name: str = parameter(
        "dwb_plugins::StandardTrajectoryGenerator",
        "Standard: the robot accelerates to the command within the simulated time; LimitedAccel: commands are those "
        "that it reaches within a cycle, and are simulated at once.",
        choices=(
            "dwb_plugins::StandardTrajectoryGenerator",
            "dwb_plugins::LimitedAccelGenerator",
        ),
        read_only=True,
    )
    min_vel_x: float = parameter(0.0, "Least velocity ahead; negative drives backwards.", unit="m/s")
    max_vel_x: float = parameter(0.0, "Largest velocity ahead.", unit="m/s")
    min_vel_y: float = parameter(0.0, "Least lateral velocity; negative to the right.", unit="m/s")
    max_vel_y: float = parameter(0.0, "Largest lateral velocity.", unit="m/s")
    max_vel_theta: float = parameter(0.0, "Largest turn rate.", unit="rad/s", minimum=0.0)
    min_speed_xy: float = parameter(0.0, "Least translational speed, unless the robot turns faster than its least.")
    max_speed_xy: float = parameter(0.0, "Largest translational speed; negative for none.", unit="m/s")
    min_speed_theta: float = parameter(0.0, "Least turn rate, unless the robot drives.", unit="rad/s")
    acc_lim_x: float = parameter(0.0, "Largest acceleration ahead.", unit="m/s^2", minimum=0.0)
    acc_lim_y: float = parameter(0.0, "Largest lateral acceleration.", unit="m/s^2", minimum=0.0)
    acc_lim_theta: float = parameter(0.0, "Largest turn acceleration.", unit="rad/s^2", minimum=0.0)
    decel_lim_x: float = parameter(0.0, "Largest deceleration ahead, negative.", unit="m/s^2", maximum=0.0)
    decel_lim_y: float = parameter(0.0, "Largest lateral deceleration, negative.", unit="m/s^2", maximum=0.0)
    decel_lim_theta: float = parameter(0.0, "Largest turn deceleration, negative.", unit="rad/s^2", maximum=0.0)
    vx_samples: int = parameter(20, "Number of samples of the velocity ahead.", minimum=0)
    vy_samples: int = parameter(5, "Number of samples of the lateral velocity.", minimum=0)
    vtheta_samples: int = parameter(20, "Number of samples of the turn rate.", minimum=0)
    sim_time: float = parameter(1.7, "Simulated time.", unit="s", above=0.0)
    discretize_by_time: bool = parameter(False, "Whether poses are a time apart, instead of a length and an angle.")
    time_granularity: float = parameter(0.5, "Time between poses.", unit="s", above=0.0)
    linear_granularity: float = parameter(0.5, "Largest distance between poses.", unit="m", above=0.0)
    angular_granularity: float = parameter(0.025, "Largest angle between poses.", unit="rad", above=0.0)
    include_last_point: bool = parameter(True, "Whether the pose at the end of the simulated time is judged.")

    def check(self) -> None:
        """Raise an error if a minimum is above its maximum."""
        for axis in "xy":
            low, high = getattr(self, f"min_vel_{axis}"), getattr(self, f"max_vel_{axis}")
            if low > high:
                raise ParameterError(f"min_vel_{axis}", f"is above max_vel_{axis}: {low:g} > {high:g}")


def generate(
    parameters: GeneratorParameters, pose: Array, velocity: Array, period: float, share: float
) -> Trajectories:
    """Return the trajectories of all commands that a robot can be given.

    Parameters
    ----------
    parameters : GeneratorParameters
    pose, velocity : ndarray, shape (3,)
        State of the robot: (x, y, yaw) and its rates in its own frame.
    period : float
        Length of a cycle [s].
    share : float
        Of the largest velocities, for speed limits; 0 to 1.
    """
    p = parameters
    accelerates = p.trajectory_generator_name.endswith("StandardTrajectoryGenerator")
    window = p.sim_time if accelerates else period
    gains = np.array([p.acc_lim_x, p.acc_lim_y, p.acc_lim_theta])
    losses = np.array([p.decel_lim_x, p.decel_lim_y, p.decel_lim_theta])
    low = share * np.array([p.min_vel_x, p.min_vel_y, -p.max_vel_theta])
    high = share * np.array([p.max_vel_x, p.max_vel_y, p.max_vel_theta])
    numbers = (p.vx_samples, p.vy_samples, p.vtheta_samples)
    axes = [
        _samples(float(velocity[i]), low[i], high[i], gains[i] * window, losses[i] * window, numbers[i])
        for i in range(3)
    ]
    commands = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    commands = commands[_are_allowed(commands, p, share)]
    counts = _step_counts(commands, velocity, p, accelerates) + int(p.include_last_point)
    poses = np.empty((commands.shape[0], int(counts.max(initial=1)), 3))
    rates = np.stack([gains, losses]) if accelerates else np.full((2, 3), np.inf) * np.array([[1.0], [-1.0]])
    simulate(
        np.ascontiguousarray(pose, dtype=np.float64),
        np.ascontiguousarray(velocity, dtype=np.float64),
        commands,
        rates,
        counts,
        p.sim_time,
        int(p.include_last_point),
        poses,
    )
    return Trajectories(commands, poses, counts, p.sim_time)


def _samples(now: float, low: float, high: float, gain: float, loss: float, number: int) -> Array:
    """Return the velocities of one axis that are reached in time: evenly spaced, and zero where it lies between."""
    now = min(max(now, low), high)
    up, down = (gain, loss) if now >= 0.0 else (-loss, -gain)
    lowest, highest = max(low, now + down), min(high, now + up)
    if highest - lowest < 1e-9:
        return np.array([lowest])
    samples = np.linspace(lowest, highest, max(number, 2))
    if lowest < 0.0 < highest and not (samples == 0.0).any():
        samples = np.sort(np.append(samples, 0.0))
    return samples


def _are_allowed(commands: Array, p: GeneratorParameters, share: float) -> NDArray[np.bool_]:
    """Return which commands are within the limits of speed, and move the robot."""
    speeds, turns = np.hypot(commands[:, 0], commands[:, 1]), np.abs(commands[:, 2])
    allowed: NDArray[np.bool_] = (speeds > 0.0) | (turns > 0.0)
    if p.max_speed_xy >= 0.0:
        allowed &= speeds <= share * p.max_speed_xy + 1e-9
    if p.min_speed_xy >= 0.0 and p.min_speed_theta >= 0.0:
        allowed &= (speeds >= p.min_speed_xy - 1e-9) | (turns >= p.min_speed_theta - 1e-9)
    return allowed


def _step_counts(commands: Array, velocity: Array, p: GeneratorParameters, accelerates: bool) -> NDArray[np.int64]:
    """Return the number of steps that each command is simulated in."""
    if p.discretize_by_time:
        count = max(math.ceil(p.sim_time / p.time_granularity), 1)
        return np.full(commands.shape[0], min(count, MAX_POSES), dtype=np.int64)
    speeds, turns = np.hypot(commands[:, 0], commands[:, 1]), np.abs(commands[:, 2])
    if accelerates:  # it may be faster at first
        speeds = np.maximum(speeds, float(np.hypot(velocity[0], velocity[1])))
        turns = np.maximum(turns, abs(float(velocity[2])))
    steps = np.ceil(p.sim_time * np.maximum(speeds / p.linear_granularity, turns / p.angular_granularity))
    return np.clip(steps, 1, MAX_POSES).astype(np.int64)


@compiled
def simulate(
    pose: Array,
    velocity: Array,
    commands: Array,
    rates: Array,
    counts: NDArray[np.int64],
    duration: float,
    with_last: int,
    poses: Array,
) -> None:
    """Write the poses of each command; `rates` are the largest accelerations and decelerations (2, 3)."""
    now = np.empty(3)
    for k in range(commands.shape[0]):
        steps = counts[k] - with_last
        step = duration / steps
        x, y, yaw = pose[0], pose[1], pose[2]
        now[:] = velocity
        for t in range(counts[k]):
            poses[k, t, 0], poses[k, t, 1], poses[k, t, 2] = x, y, yaw
            for axis in range(3):
                up, down = rates[0, axis] * step, rates[1, axis] * step
                if now[axis] < 0.0:
                    up, down = -down, -up
                now[axis] = min(max(commands[k, axis], now[axis] + down), now[axis] + up)
            middle = yaw + 0.5 * now[2] * step
            cosine, sine = math.cos(middle), math.sin(middle)
            x += step * (now[0] * cosine - now[1] * sine)
            y += step * (now[0] * sine + now[1] * cosine)
            yaw += now[2] * step
