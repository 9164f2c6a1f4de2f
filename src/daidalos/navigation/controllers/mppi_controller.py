"""MPPI controller: sampled control sequences, averaged by their costs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import ParameterError, Parameters, group, parameter, per_name
from daidalos.navigation.contracts import (
    Candidates,
    ControlInput,
    Controller,
    Critic,
    NavigationContext,
    Output,
    Scene,
)
from daidalos.navigation.controllers.mppi.proposals import turn_then_drive
from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts, Samples, correlated_noise
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, NO_INFORMATION
from daidalos.navigation.errors import NoValidControl
from daidalos.navigation.extensions import CRITICS, TRAJECTORY_VALIDATORS
from daidalos.navigation.paths import distances_along

TURN_TO = 0.5
"""Distance along the path [m] of the point that one sample turns to."""

NOISE_POOL = 8
"""Batches of noise that are drawn once; each cycle takes a random part of them."""


@dataclass(frozen=True)
class CriticSwitch(Parameters):
    """Parameter that enables a critic of the controller."""

    enabled: bool = parameter(True, "Whether the critic is used.", read_only=True)


@dataclass(frozen=True)
class AckermannConstraints(Parameters):
    """Parameters of the motion model of robots that steer."""

    min_turning_r: float = parameter(0.2, "Smallest radius of a curve.", unit="m", above=0.0)


@dataclass(frozen=True)
class VisualizerParameters(Parameters):
    """Parameters of what is shown of the rollouts."""

    trajectory_step: int = parameter(5, "Every how many rollouts one is shown.", minimum=1)
    time_step: int = parameter(3, "Every how many steps of a rollout one is shown.", minimum=1)


@dataclass(frozen=True)
class ValidatorChoice(Parameters):
    """Parameter that names the validator; its own parameters stand beside it."""

    plugin: str = parameter(
        "mppi::DefaultOptimalTrajectoryValidator", "Class of the validator.", not_empty=True, read_only=True
    )


@dataclass(frozen=True)
class MppiParameters(Parameters):
    """Parameters of the controller, by their Nav2 names.

    `open_loop` is on by default, other than in Nav2: rollouts begin with the last command rather than with odometry's
    velocity, whose delay makes a robot with limited acceleration crawl and sway. `regenerate_noises` is on by default
    and takes another part of noise that was drawn once. `noise_correlation_time` is ours.
    """

    motion_model: str = parameter(
        "DiffDrive", "How the robot moves.", choices=("DiffDrive", "Omni", "Ackermann"), read_only=True
    )
    time_steps: int = parameter(56, "Number of steps of a rollout.", minimum=2)
    model_dt: float = parameter(0.05, "Duration of a step.", unit="s", above=0.0)
    batch_size: int = parameter(1000, "Number of rollouts.", minimum=1)
    vx_std: float = parameter(0.3, "Standard deviation of sampled speeds.", unit="m/s", above=0.0)
    wz_std: float = parameter(0.8, "Standard deviation of sampled turn rates.", unit="rad/s", above=0.0)
    vy_std: float = parameter(0.2, "Standard deviation of sampled lateral speeds.", unit="m/s", above=0.0)
    vx_max: float = parameter(0.5, "Largest speed ahead.", unit="m/s")
    vy_max: float = parameter(0.5, "Largest lateral speed.", unit="m/s", minimum=0.0)
    vx_min: float = parameter(-0.15, "Least speed; negative drives backwards.", unit="m/s")
    wz_max: float = parameter(1.8, "Largest turn rate.", unit="rad/s", minimum=0.0)
    ax_max: float = parameter(2.5, "Largest acceleration.", unit="m/s^2", minimum=0.0)
    ax_min: float = parameter(-2.5, "Largest deceleration, negative.", unit="m/s^2", maximum=0.0)
    ay_max: float = parameter(3.0, "Largest lateral acceleration.", unit="m/s^2", minimum=0.0)
    ay_min: float = parameter(-3.0, "Largest lateral deceleration, negative.", unit="m/s^2", maximum=0.0)
    az_max: float = parameter(3.2, "Largest turn acceleration.", unit="rad/s^2", minimum=0.0)
    ackermann: AckermannConstraints = group(AckermannConstraints, "AckermannConstraints")
    regenerate_noises: bool = parameter(True, "Whether each cycle samples other noise.")
    iteration_count: int = parameter(1, "Number of optimizations in a cycle.", minimum=1)
    temperature: float = parameter(
        0.3, "How much worse trajectories contribute; less selects the best more sharply.", above=0.0
    )
    gamma: float = parameter(0.015, "Weight of smooth control against low cost.", minimum=0.0)
    prune_distance: float = parameter(1.7, "Length of path ahead that is looked at.", unit="m", above=0.0)
    retry_attempt_limit: int = parameter(1, "Number of further optimizations when all trajectories collide.", minimum=0)
    enforce_path_inversion: bool = parameter(False, "Whether the robot drives to the cusps of the path.")
    inversion_xy_tolerance: float = parameter(0.2, "Distance of a cusp at which it is reached.", unit="m", minimum=0.0)
    inversion_yaw_tolerance: float = parameter(0.4, "Angle at which a cusp is reached.", unit="rad", minimum=0.0)
    open_loop: bool = parameter(True, "Whether rollouts begin with the last command instead of odometry's velocity.")
    visualize: bool = parameter(False, "Whether rollouts, the path ahead and the best trajectory are published.")
    publish_optimal_trajectory: bool = parameter(False, "Whether the best trajectory is published.")
    visualizer: VisualizerParameters = group(VisualizerParameters, "TrajectoryVisualizer")
    validator: ValidatorChoice = group(ValidatorChoice, "TrajectoryValidator")
    noise_correlation_time: float = parameter(0.5, "How long a sampled deviation lasts.", unit="s", minimum=0.0)
    critics: tuple[str, ...] = parameter(
        (
            *("CostCritic", "GoalCritic", "GoalAngleCritic", "PathAlignCritic", "PathFollowCritic"),
            *("PathAngleCritic", "PreferForwardCritic"),
        ),
        "What judges trajectories.",
        read_only=True,
    )
    switches: Mapping[str, CriticSwitch] = per_name(CriticSwitch, by="critics", at="")

    def check(self) -> None:
        """Raise an error if the minimum speed is above the maximum."""
        if self.vx_min > self.vx_max:
            raise ParameterError("vx_min", f"is above vx_max: {self.vx_min:g} > {self.vx_max:g}")


class MppiController(Controller):
    """Model predictive path integral control (Williams et al. 2017) of robots that turn, steer or move sideways.

    Each cycle disturbs the last control sequence with noise, drives every disturbed sequence through the
    robot's motion model, lets the critics judge the trajectories and takes the mean of the sequences,
    weighted by `exp(-cost / temperature)`. Where the mean would touch an obstacle, which can happen between
    two ways around it, the best sample is taken instead. Two of the samples are not left to chance: to stop,
    and to turn to the path before driving.

    Parameters
    ----------
    parameters : MppiParameters, optional
        Horizon, samples and limits.
    context : NavigationContext, optional
    critics : sequence of Critic, optional
        What makes a trajectory good; the parameter `critics` names them where they are left out.
    """

    names = ("nav2_mppi_controller::MPPIController",)
    Parameters = MppiParameters
    parameters: MppiParameters

    def __init__(
        self,
        parameters: MppiParameters | None = None,
        context: NavigationContext | None = None,
        critics: Sequence[Critic] | None = None,
    ) -> None:
        super().__init__(parameters, context)
        self.critics = self._make_critics() if critics is None else tuple(critics)
        self._validator = self.context.make(
            TRAJECTORY_VALIDATORS, self.parameters.validator.plugin, "TrajectoryValidator.plugin", "TrajectoryValidator"
        )
        self.period = 1.0 / self.context.frequency
        self._path: Array | None = None
        self._generator = np.random.default_rng(self.context.seed)
        self.reconfigure(self.parameters)

    def reconfigure(self, parameters: MppiParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; lifts the speed limit and forgets the last plan."""
        super().reconfigure(parameters)
        p = parameters
        self._speed_limit = p.vx_max
        deviations = [p.vx_std, p.wz_std, p.vy_std] if p.motion_model == "Omni" else [p.vx_std, p.wz_std]
        self._deviations: Samples = np.array(deviations, dtype=np.float32)
        axes = self._deviations.size
        self._controls: Samples = np.zeros((p.time_steps, axes), dtype=np.float32)
        self._last_command: Array | None = None
        self._noise: Samples = np.zeros((p.batch_size, p.time_steps, axes), dtype=np.float32)
        self._rollouts = Rollouts.empty(p.batch_size, p.time_steps)
        self._single = Rollouts.empty(1, p.time_steps)
        correlation = math.exp(-p.model_dt / p.noise_correlation_time) if p.noise_correlation_time > 0.0 else 0.0
        batches = NOISE_POOL if p.regenerate_noises else 1
        self._pool = correlated_noise(self._generator, batches * p.batch_size, p.time_steps, correlation, axes)
        self._pool *= self._deviations

    def _make_critics(self) -> tuple[Critic, ...]:
        """Create the enabled critics of the parameters."""
        return tuple(
            self.context.make(CRITICS, name, "critics", below=name)
            for name in self.parameters.critics
            if self.parameters.switches.get(name, CriticSwitch()).enabled
        )

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        p = self.parameters
        fastest = math.hypot(p.vx_max, p.vy_max) if p.motion_model == "Omni" else p.vx_max
        return max(p.prune_distance, fastest * p.time_steps * p.model_dt) + 0.3

    @property
    def inversion_tolerances(self) -> tuple[float, float] | None:
        """Implement `Controller.inversion_tolerances`."""
        p = self.parameters
        return (p.inversion_xy_tolerance, p.inversion_yaw_tolerance) if p.enforce_path_inversion else None

    @property
    def trajectory(self) -> Array:
        """Poses (n, 3) of the last control sequence in the costmap's frame."""
        s = self._single
        return np.stack([s.x[0], s.y[0], s.yaw[0]], axis=-1).astype(np.float64)

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Controller.outputs`."""

        def trajectories() -> Candidates | None:
            p = self.parameters
            if not p.visualize or self._path is None:
                return None
            shown = slice(None, None, p.visualizer.trajectory_step), slice(None, None, p.visualizer.time_step)
            points = np.stack([self._rollouts.x[shown], self._rollouts.y[shown]], axis=-1)
            return Candidates(points, self._rollouts.costs[shown[0]].copy())

        def best() -> Array | None:
            p = self.parameters
            is_shown = (p.visualize or p.publish_optimal_trajectory) and self._path is not None
            return self.trajectory if is_shown else None

        return (
            Output("trajectories", Candidates, trajectories),
            Output("transformed_global_plan", np.ndarray, lambda: self._path if self.parameters.visualize else None),
            Output("optimal_trajectory", np.ndarray, best),
        )

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        self._shift()
        self._path = control.path
        if self.parameters.open_loop and self._last_command is not None:
            control = replace(control, velocity=self._last_command)
        for attempt in range(self.parameters.retry_attempt_limit + 1):
            if attempt > 0:
                self._controls[:] = 0.0
            for _ in range(self.parameters.iteration_count):
                scene = self._optimise(control)
            if not self._single.collides[0] and self._validator.is_valid(self.trajectory, scene):
                command = np.array([float(one[0, 0]) for one in (self._single.vx, self._single.vy, self._single.wz)])
                self._last_command = command
                return command.copy()
        self.reset()
        raise NoValidControl(
            f"all of {self.parameters.batch_size} motions from ({float(control.pose[0]):.2f}, "
            f"{float(control.pose[1]):.2f}) touch an obstacle"
        )

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`."""
        most = self.parameters.vx_max
        limit = most * speed_limit / 100.0 if percentage else speed_limit
        self._speed_limit = most if speed_limit <= 0.0 else min(limit, most)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        self._controls[:] = 0.0
        self._last_command = None

    def _shift(self) -> None:
        """Shift the last sequence by the elapsed time."""
        steps = self.parameters.time_steps
        then = np.minimum(np.arange(steps) + self.period / self.parameters.model_dt, steps - 1.0)
        for axis in range(self._controls.shape[1]):
            self._controls[:, axis] = np.interp(then, np.arange(steps), self._controls[:, axis])

    def _optimise(self, control: ControlInput) -> Scene:
        """Improve the control sequence by one iteration, simulate it, and return what it was judged by."""
        p = self.parameters
        rollouts = self._rollouts
        limits = self._limits()
        free = self._pool.shape[0] - p.batch_size
        first = int(self._generator.integers(free)) if free else 0
        self._noise[:] = self._pool[first : first + p.batch_size]
        self._noise[0] = -self._controls
        self._noise[1] = self._turn_then_drive(control, limits) - self._controls
        noise = self._noise
        rollouts.drive(control.pose, control.velocity, self._controls, noise, limits, p.model_dt)
        scene = self._scene(control, limits)
        for critic in self.critics:
            critic.score(rollouts, scene)
        if p.gamma > 0.0:
            pull = self._controls * (np.float32(p.gamma) / self._deviations**2)
            rollouts.costs[:] += noise.reshape(p.batch_size, -1) @ pull.ravel()
        weights = _weights(rollouts, p.temperature)
        change = (weights @ noise.reshape(p.batch_size, -1)).reshape(self._controls.shape)
        self._take(self._controls + change, control, limits, scene)
        if self._single.collides[0]:
            best = int(np.argmin(rollouts.costs))
            axes = (rollouts.vx, rollouts.wz, rollouts.vy)[: self._deviations.size]
            self._take(np.stack([axis[best] for axis in axes], axis=-1), control, limits, scene)
        return scene

    def _limits(self) -> Limits:
        """Return the limits of the motion model under the speed limit."""
        p = self.parameters
        share = self._speed_limit / p.vx_max if p.vx_max > 0.0 else 1.0
        curvature = 1.0 / p.ackermann.min_turning_r if p.motion_model == "Ackermann" else math.inf
        return Limits(
            max(p.vx_min, -self._speed_limit) if self._speed_limit > 0.0 else p.vx_min,
            self._speed_limit,
            p.wz_max,
            p.ax_min,
            p.ax_max,
            p.az_max,
            share * p.vy_max,
            p.ay_min,
            p.ay_max,
            curvature,
        )

    def _turn_then_drive(self, control: ControlInput, limits: Limits) -> Samples:
        """Return the sequence that turns to a point of the path ahead, or to its end, and drives there."""
        index = int(np.searchsorted(distances_along(control.path), TURN_TO))
        x, y = (float(value) for value in control.path[min(index, control.path.shape[0] - 1), :2])
        p = self.parameters
        sequence = turn_then_drive(control.pose, control.velocity, (x, y), limits, p.time_steps, p.model_dt)
        return np.pad(sequence, ((0, 0), (0, self._deviations.size - 2)))

    def _take(self, controls: Samples, control: ControlInput, limits: Limits, scene: Scene) -> None:
        """Set the current sequence and compute its trajectory."""
        self._controls[:] = controls
        still = np.zeros((1, *controls.shape), dtype=np.float32)
        single = self._single
        single.drive(control.pose, control.velocity, self._controls, still, limits, self.parameters.model_dt)
        for axis, driven in zip(range(controls.shape[1]), (single.vx, single.wz, single.vy), strict=False):
            self._controls[:, axis] = driven[0]
        for critic in self.critics:
            if critic.judges_contact:
                critic.score(self._single, scene)

    def _scene(self, control: ControlInput, limits: Limits) -> Scene:
        path = control.path
        cells = np.floor((path[:, :2] - control.costmap.origin) / control.costmap.resolution).astype(np.int64)
        inside = (cells >= 0).all(axis=1)
        inside &= (cells < (control.costmap.width, control.costmap.height)).all(axis=1)
        free = np.ones(path.shape[0], dtype=np.bool_)
        costs = control.costmap.costs[cells[inside, 1], cells[inside, 0]]
        free[inside] = (costs < INSCRIBED_INFLATED_OBSTACLE) | (costs == NO_INFORMATION)
        furthest = furthest_reached(self._rollouts.x, self._rollouts.y, np.ascontiguousarray(path[:, :2]))
        along, step = distances_along(path), self.parameters.model_dt
        return Scene(control, self.context.footprint, along, free, furthest, step, limits)


def _weights(rollouts: Rollouts, temperature: float) -> Samples:
    """Return the weight of each sample.

    The temperature is relative to how much worse than the best sample the best tenth is, so that the critics'
    weights need no tuning to it, and the last centimetres count as much as the first metres.
    """
    above = rollouts.costs - rollouts.costs.min()
    alive = above[~rollouts.collides]
    tenth = alive.size // 10
    spread = float(np.partition(alive, tenth)[tenth]) if alive.size else 1.0
    weights: Samples = np.exp(-above / np.float32(temperature * max(spread, 1e-4)))
    weights /= weights.sum()
    return weights


@compiled
def furthest_reached(x: Samples, y: Samples, points: Array) -> int:
    """Return the largest index of the path's points that are nearest to the ends of rollouts."""
    furthest = 0
    last = x.shape[1] - 1
    for b in range(x.shape[0]):
        best = np.inf
        index = 0
        for i in range(points.shape[0]):
            dx, dy = x[b, last] - points[i, 0], y[b, last] - points[i, 1]
            d = dx * dx + dy * dy
            if d < best:
                best = d
                index = i
        furthest = max(furthest, index)
    return furthest
