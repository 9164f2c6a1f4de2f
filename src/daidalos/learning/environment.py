"""Environments of Gymnasium: a robot in a world, with a reward of the user."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.learning.robot import SimulatedRobot
from daidalos.learning.state import State

_MAX_TRIES = 200


class WorldEnv(gymnasium.Env[dict[str, Any], Array]):  # type: ignore[misc, unused-ignore]
    """Robot in a world.

    Observations are a dictionary: ``lidar`` (rays,) [m], ``velocity`` (2,) [m/s, rad/s], ``joints`` (2, joints),
    ``camera`` (height, width, 3) and ``extra``, as far as they are asked for. The action is a velocity of the base
    (forwards [m/s], to the left [rad/s]), or the efforts of the joints [N m, N].

    Parameters
    ----------
    world : str or Path
        File or name of the world; an empty one where empty.
    robot : str or Path
        File of the robot or its name: ``waffle`` or ``burger``.
    reward : callable, optional
        Of the `State` before and after a step; by default the way forwards [m] less 1 for a collision.
    is_done : callable, optional
        Of the `State`: whether the episode ends; by default at a collision.
    start : callable, optional
        Of a random stream: pose x, y, yaw [m, rad] of an episode's start; by default anywhere free in the world.
    extra : callable, optional
        Of the `State`: an array (`extra_size`,) that is observed as well, such as where the goal is.
    extra_size : int
    rays : int
        Of the lidar; 0 for none.
    joints : sequence of str
        Joints that are driven by efforts in place of the base.
    max_effort : float
        Limit of their efforts [N m, N].
    camera : bool
        Whether the camera is observed.
    period : float
        Simulated time of a step [s].
    max_linear, max_angular : float
        Limits of the velocity [m/s, rad/s].
    max_steps : int
        After which an episode is truncated.
    motion : str
        ``dynamics``, or ``kinematic``: the base moves exactly as commanded, which is many times faster.
    render_mode : str, optional
        ``rgb_array``: `render` returns what the robot's camera sees, whether that is observed or not.

    Raises
    ------
    UserError
        When there is no such world, robot or sensor, or an option is wrong.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012  # as Gymnasium declares it

    def __init__(
        self,
        world: str | Path = "arena",
        robot: str | Path = "waffle",
        *,
        reward: Callable[[State, State], float] | None = None,
        is_done: Callable[[State], bool] | None = None,
        start: Callable[[np.random.Generator], tuple[float, float, float]] | None = None,
        extra: Callable[[State], Array] | None = None,
        extra_size: int = 0,
        rays: int = 36,
        joints: Sequence[str] = (),
        max_effort: float = 1.0,
        camera: bool = False,
        period: float = 0.1,
        max_linear: float = 0.26,
        max_angular: float = 1.82,
        max_steps: int = 500,
        motion: str = "dynamics",
        render_mode: str | None = None,
    ) -> None:
        if motion not in ("dynamics", "kinematic"):
            raise UserError(f"'motion' should be 'dynamics' or 'kinematic', got '{motion}'")
        if not period > 0.0 or max_steps < 1 or rays < 0:
            raise UserError(
                "expected a period above 0 s, 1 step or more and 0 rays or more, got "
                f"{period:g} s, {max_steps} steps and {rays} rays"
            )
        if joints and motion == "kinematic":
            raise UserError("joints are driven by efforts, which the motion 'kinematic' does not have")
        if render_mode not in (None, "rgb_array"):
            raise UserError(f"'render_mode' should be 'rgb_array' or None, got '{render_mode}'")
        self.robot = SimulatedRobot(world, robot, rays, joints, camera or bool(render_mode), motion == "kinematic")
        if not joints and motion == "dynamics" and not self.robot.has_base:
            raise UserError("the robot takes no velocities; name the 'joints' to drive")
        self.render_mode = render_mode
        self._observes_camera = camera
        self._period, self._max_steps = period, max_steps
        self._reward, self._is_done = reward or _way_forwards, is_done or _has_collided
        self._start, self._extra = start, extra
        self._limits = np.full(len(joints), max_effort) if joints else np.array([max_linear, max_angular])
        self._steps = 0
        self.action_space = spaces.Box(-self._limits.astype(np.float32), self._limits.astype(np.float32))
        self.observation_space = self._spaces(rays, len(joints), camera, extra_size)
        self._state = self._read(np.zeros(len(self._limits)))

    def _spaces(self, rays: int, joints: int, camera: bool, extra_size: int) -> spaces.Dict:
        found: dict[str, spaces.Space[Any]] = {
            "velocity": spaces.Box(-np.inf, np.inf, (2,), np.float32),
        }
        if rays:
            count = len(self.robot.ranges())
            found["lidar"] = spaces.Box(0.0, self.robot.range_max, (count,), np.float32)
        if joints:
            found["joints"] = spaces.Box(-np.inf, np.inf, (2, joints), np.float32)
        if camera:
            found["camera"] = spaces.Box(0, 255, self.robot.image_shape(), np.uint8)
        if self._extra is not None:
            found["extra"] = spaces.Box(-np.inf, np.inf, (extra_size,), np.float32)
        return spaces.Dict(found)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start an episode; the same seed gives the same episode for the same actions.

        Parameters
        ----------
        seed : int, optional
        options : dict, optional
            ``pose``: where the robot stands, in place of what `start` draws.
        """
        super().reset(seed=seed)
        self._steps = 0
        given = (options or {}).get("pose")
        for _ in range(_MAX_TRIES):
            x, y, yaw = given or (self._start(self.np_random) if self._start is not None else self._anywhere())
            self.robot.reset(x, y, yaw, self.np_random)
            self.robot.simulation.physics.refresh()
            if given or not self.robot.collided:
                break
        self._state = self._read(np.zeros(len(self._limits)))
        return self._observe(self._state), {"state": self._state}

    def _anywhere(self) -> tuple[float, float, float]:
        reach = min(self.robot.extent, 20.0)
        x, y = self.np_random.uniform(-reach, reach, 2)
        return float(x), float(y), float(self.np_random.uniform(-math.pi, math.pi))

    def step(self, action: Array) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Carry out an action for one period."""
        limited = np.clip(np.asarray(action, dtype=float), -self._limits, self._limits)
        if self.robot.joints:
            self.robot.push_joints(limited, self._period)
        else:
            self.robot.drive(float(limited[0]), float(limited[1]), self._period)
        self._steps += 1
        before, self._state = self._state, self._read(limited)
        done = bool(self._is_done(self._state))
        is_late = self._steps >= self._max_steps
        reward = float(self._reward(before, self._state))
        return self._observe(self._state), reward, done, is_late, {"state": self._state}

    def render(self) -> Any:
        """Return what the robot's camera sees: the picture that was observed last, where it is observed."""
        if self.render_mode is None:
            return None
        return self._state.image if self._observes_camera else self.robot.image()

    def _read(self, action: Array) -> State:
        robot = self.robot
        pose = robot.pose
        linear, angular = robot.velocity
        return State(
            self._steps * self._period,
            pose.position[0],
            pose.position[1],
            pose.yaw,
            linear,
            angular,
            action,
            robot.collided,
            robot.ranges(),
            np.array([joint.position for joint in robot.joints]),
            np.array([joint.velocity for joint in robot.joints]),
            robot.image() if self._observes_camera else None,
        )

    def _observe(self, state: State) -> dict[str, Any]:
        found: dict[str, Any] = {"velocity": np.array([state.linear, state.angular], dtype=np.float32)}
        if len(state.ranges):
            found["lidar"] = state.ranges.astype(np.float32)
        if self.robot.joints:
            found["joints"] = np.stack([state.joint_positions, state.joint_velocities]).astype(np.float32)
        if state.image is not None:
            found["camera"] = state.image
        if self._extra is not None:
            found["extra"] = np.asarray(self._extra(state), dtype=np.float32)
        return found


def make_vector(count: int, *, processes: bool = False, **options: Any) -> gymnasium.vector.VectorEnv[Any, Any, Any]:
    """Return several environments that step together.

    Parameters
    ----------
    count : int
    processes : bool
        Whether each has a process of its own.
    **options
        Of `WorldEnv`.
    """

    def make() -> WorldEnv:
        return WorldEnv(**options)

    kind = gymnasium.vector.AsyncVectorEnv if processes else gymnasium.vector.SyncVectorEnv
    return kind([make] * count)


def _way_forwards(before: State, after: State) -> float:
    way = (after.x - before.x) * math.cos(before.yaw) + (after.y - before.y) * math.sin(before.yaw)
    return way - float(after.collided)


def _has_collided(state: State) -> bool:
    return state.collided
