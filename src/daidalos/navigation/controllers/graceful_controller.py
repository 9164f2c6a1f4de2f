"""Graceful motion: smooth curves to a pose of the path that can be reached without contact."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import between, compose, wrap
from daidalos.navigation.contracts import ControlInput, Controller, NavigationContext
from daidalos.navigation.controllers.ego_polar import EgoPolarLaw
from daidalos.navigation.controllers.look_ahead import look_ahead_point
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, MAX_NON_OBSTACLE, NO_INFORMATION, Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.errors import NoValidControl
from daidalos.navigation.paths import distances_along, with_headings

_MAX_DETOUR = 3.0
"""How much longer a simulated curve may be than the straight line to its target."""


@dataclass(frozen=True)
class GracefulParameters(Parameters):
    """Parameters of the controller, by their Nav2 names."""

    min_lookahead: float = parameter(0.25, "Least distance of the pose that is driven to.", unit="m", minimum=0.0)
    max_lookahead: float = parameter(1.0, "Largest distance of the pose that is driven to.", unit="m", above=0.0)
    k_phi: float = parameter(2.0, "How fast the robot turns to the target's heading, by distance.", minimum=0.0)
    k_delta: float = parameter(1.0, "How fast the robot turns to the curve.", minimum=0.0)
    beta: float = parameter(0.4, "How much the speed falls with the curvature.", minimum=0.0)
    lambda_: float = parameter(2.0, "Exponent of the curvature.", minimum=0.0, name="lambda")
    v_linear_min: float = parameter(0.1, "Least speed on a curve.", unit="m/s", minimum=0.0)
    v_linear_max: float = parameter(0.5, "Largest speed.", unit="m/s", above=0.0)
    v_angular_max: float = parameter(1.0, "Largest turn rate.", unit="rad/s", above=0.0)
    v_angular_min_in_place: float = parameter(0.25, "Least turn rate on the spot.", unit="rad/s", minimum=0.0)
    slowdown_radius: float = parameter(
        1.5, "Distance to the target within which the speed falls with it.", unit="m", minimum=0.0
    )
    deceleration_max: float = parameter(2.5, "Deceleration that ends at the target.", unit="m/s^2", above=0.0)
    initial_rotation: bool = parameter(True, "Whether to turn on the spot towards the path at the start.")
    initial_rotation_tolerance: float = parameter(
        0.75, "Angle to the target below which that turn ends.", unit="rad", minimum=0.0
    )
    prefer_final_rotation: bool = parameter(
        True, "Whether to go straight to the goal and turn there, rather than on a curve that ends as it looks."
    )
    rotation_scaling_factor: float = parameter(0.5, "Turn rate on the spot by angle and v_angular_max.", minimum=0.0)
    allow_backward: bool = parameter(False, "Whether to drive backwards to what is behind; not with initial_rotation.")
    in_place_collision_resolution: float = parameter(
        0.1, "Step at which turns on the spot are checked for collisions.", unit="rad", above=0.0
    )
    use_collision_detection: bool = parameter(True, "Whether curves and turns are checked for collisions.")
    footprint_scaling_linear_vel: float = parameter(
        0.5, "Speed above which the footprint is enlarged, and the least speed that is tried.", unit="m/s", minimum=0.0
    )
    footprint_scaling_factor: float = parameter(0.25, "By how much it is larger at v_linear_max.", minimum=0.0)
    footprint_scaling_step: float = parameter(
        0.1, "By how much less speed is tried where a curve touches something.", unit="m/s", above=0.0
    )
    obstacle_cost_margin: int = parameter(
        1, "How far below contact the costs of the way to the goal must be.", minimum=0, maximum=MAX_NON_OBSTACLE
    )
    final_rotation_search_step: float = parameter(
        0.1, "Step of the headings at the goal that are tried where they are not.", unit="rad", above=0.0
    )


@dataclass(frozen=True)
class _Curve:
    """Simulated way to a target.

    Attributes
    ----------
    velocity : ndarray, shape (3,)
        Its first velocity.
    poses : ndarray, shape (n, 3)
        In the costmap's frame.
    duration : float
        How long it takes [s].
    """

    velocity: Array
    poses: Array
    duration: float


class GracefulController(Controller):
    """Smooth control law with a look-ahead.

    The law (see `EgoPolarLaw`) leads to the farthest pose of the path within the look-ahead to which the simulated
    curve is free; where it is not, lower speeds are tried, then nearer poses. Near the goal the heading of the target
    is ignored, and the robot turns on the spot at the goal.
    """

    names = ("nav2_graceful_controller::GracefulController",)
    Parameters = GracefulParameters
    parameters: GracefulParameters

    def __init__(self, parameters: GracefulParameters | None = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._limit: float | None = None
        self._warn_of_conflict()
        self.reset()

    def reconfigure(self, parameters: GracefulParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; lifts the speed limit."""
        super().reconfigure(parameters)
        self._limit = None
        self._warn_of_conflict()

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return self.parameters.max_lookahead + 0.5

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        to_goal = between(control.pose, control.goal)
        if math.hypot(float(to_goal[0]), float(to_goal[1])) <= control.xy_goal_tolerance:
            self._at_goal = True
        if self._at_goal and self._can_turn(control, float(to_goal[2])):
            return self._turn(float(to_goal[2]))
        p = self.parameters
        is_near_goal = control.distance_to_goal < p.max_lookahead
        for target, distance in _targets(control, p.max_lookahead):
            if distance > p.max_lookahead or (distance < p.min_lookahead and not is_near_goal):
                continue
            curve = self._approach(control, target) if is_near_goal and p.prefer_final_rotation else None
            curve = curve or self._curve_to(control, target)
            if curve is not None:
                return curve.velocity
        raise NoValidControl(
            f"each curve to a pose of the path within {p.max_lookahead:g} m from "
            f"({float(control.pose[0]):.2f}, {float(control.pose[1]):.2f}) touches an obstacle"
        )

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`; the largest turn rate falls in proportion."""
        most = self.parameters.v_linear_max
        share = speed_limit / 100.0 if percentage else speed_limit / most
        self._limit = None if speed_limit <= 0.0 else min(share, 1.0)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        self._at_goal = False
        self._starting = True
        self._safe_heading: float | None = None

    def _warn_of_conflict(self) -> None:
        if self.parameters.allow_backward and self.parameters.initial_rotation:
            self.context.warn("allow_backward is ignored, as initial_rotation is true")

    @property
    def _may_reverse(self) -> bool:
        return self.parameters.allow_backward and not self.parameters.initial_rotation

    @property
    def _speeds(self) -> tuple[float, float]:
        """Largest speed [m/s] and turn rate [rad/s] under the speed limit."""
        p, share = self.parameters, 1.0 if self._limit is None else self._limit
        return max(p.v_linear_max * share, min(p.v_linear_min, p.v_linear_max)), p.v_angular_max * share

    def _law(self, speed: float) -> EgoPolarLaw:
        p = self.parameters
        return EgoPolarLaw(
            p.k_phi, p.k_delta, p.beta, p.lambda_, p.slowdown_radius,
            min(p.v_linear_min, speed), speed, self._speeds[1], p.deceleration_max,
        )  # fmt: skip

    def _approach(self, control: ControlInput, target: Array) -> _Curve | None:
        """Return a way to a target near the goal whose heading does not matter; None where there is none.

        A way that comes too near to obstacles is replaced by the fastest one of other headings that does not.
        """
        straight = math.atan2(float(target[1] - control.pose[1]), float(target[0] - control.pose[0]))
        curve = self._curve_to(control, _with_heading(target, straight))
        if curve is None or not self.parameters.use_collision_detection:
            return curve
        most = MAX_NON_OBSTACLE if self.context.footprint.circular else INSCRIBED_INFLATED_OBSTACLE
        limit = most - self.parameters.obstacle_cost_margin
        if _highest_cost(control.costmap, curve.poses) < limit:
            return curve
        return self._safer_approach(control, target, limit) or curve

    def _safer_approach(self, control: ControlInput, target: Array, limit: int) -> _Curve | None:
        """Return the fastest way to a position whose costs stay below a limit; the last heading is tried first."""
        if self._safe_heading is not None:
            curve = self._curve_to(control, _with_heading(target, self._safe_heading))
            if curve is not None and _highest_cost(control.costmap, curve.poses) < limit:
                return curve
        best: _Curve | None = None
        for heading in np.arange(0.0, 2.0 * math.pi, self.parameters.final_rotation_search_step):
            curve = self._curve_to(control, _with_heading(target, float(heading)))
            if curve is None or (best is not None and curve.duration >= best.duration):
                continue
            if _highest_cost(control.costmap, curve.poses) < limit:
                best, self._safe_heading = curve, float(heading)
        return best

    def _curve_to(self, control: ControlInput, target: Array) -> _Curve | None:
        """Return the way to a target at the largest speed at which it is free; None where it never is."""
        p = self.parameters
        bearing = between(control.pose, target)
        backward = self._may_reverse and float(bearing[0]) < 0.0
        if backward and _looks_along(control.pose, target):
            target = _with_heading(target, float(target[2]) + math.pi)
        speed = self._speeds[0]
        while True:
            curve = self._simulated(control, target, self._law(speed), backward=backward)
            speed -= p.footprint_scaling_step
            if curve is not None or speed < p.footprint_scaling_linear_vel:
                return curve

    def _simulated(self, control: ControlInput, target: Array, law: EgoPolarLaw, *, backward: bool) -> _Curve | None:
        """Return the way of the law to a target, after a turn towards it at the start; None where it touches."""
        angle = float(_angle_to(control.pose, target))
        pose = control.pose
        velocity: Array | None = None
        poses = [pose]
        if self._must_turn_first(angle):
            if not self._can_turn(control, angle):
                return None
            velocity, pose = self._turn(angle), pose + np.array([0.0, 0.0, angle])
        if velocity is None:
            speed, turn = law.velocity(pose, target, backward=backward)
            velocity = np.array([speed, 0.0, turn])
        checker = self._checker(control.costmap, float(velocity[0]))
        resolution = control.costmap.resolution
        away = math.hypot(*(target - pose)[:2])
        duration = 0.0
        for _ in range(max(math.ceil(_MAX_DETOUR * away / resolution), 1)):
            speed, _ = law.velocity(pose, target, backward=backward)
            step = resolution / max(abs(speed), 1e-3)
            duration += step
            pose = law.next_pose(pose, target, step, backward=backward)
            if checker is not None and checker.in_collision(pose):
                return None
            poses.append(pose)
            if math.hypot(*(target - pose)[:2]) <= resolution:
                break
        return _Curve(velocity, np.array(poses), duration)

    def _checker(self, costmap: Costmap, speed: float) -> FootprintCollisionChecker | None:
        """Return the check of a footprint that is enlarged by the speed; None where collisions are not checked."""
        p = self.parameters
        if not p.use_collision_detection:
            return None
        span = p.v_linear_max - p.footprint_scaling_linear_vel
        share = (speed - p.footprint_scaling_linear_vel) / span if span > 0.0 else 0.0
        scale = 1.0 + p.footprint_scaling_factor * max(share, 0.0)
        return FootprintCollisionChecker(costmap, _scaled(self.context.footprint, scale))

    def _must_turn_first(self, angle: float) -> bool:
        """Return whether to turn on the spot at the start; not any more once the target was ahead."""
        if abs(angle) < self.parameters.initial_rotation_tolerance:
            self._starting = False
        return self._starting and self.parameters.initial_rotation

    def _can_turn(self, control: ControlInput, angle: float) -> bool:
        """Return whether a turn on the spot by an angle [rad] touches nothing."""
        p = self.parameters
        if not p.use_collision_detection:
            return True
        checker = FootprintCollisionChecker(control.costmap, self.context.footprint)
        count = max(int(abs(angle) / p.in_place_collision_resolution), 1)
        turns = np.linspace(0.0, angle, count + 1)[1:]
        return not any(checker.in_collision(control.pose + np.array([0.0, 0.0, turn])) for turn in turns)

    def _turn(self, angle: float) -> Array:
        """Return the velocity of a turn on the spot, in proportion to the angle [rad] that is left."""
        p, most = self.parameters, self._speeds[1]
        rate = max(p.rotation_scaling_factor * abs(angle) * most, p.v_angular_min_in_place)
        return np.array([0.0, 0.0, math.copysign(min(rate, most), angle)])


def _targets(control: ControlInput, look_ahead: float) -> Iterator[tuple[Array, float]]:
    """Return poses of the path to drive to, the farthest first, each with its distance [m] along the path.

    The first is the point at the look-ahead distance [m], or the path's end where that is nearer.
    """
    path = _with_headings(control.path)
    ahead = between(control.pose, path)
    point, index = look_ahead_point(ahead[:, :2], look_ahead)
    away = math.hypot(float(point[0]), float(point[1]))
    yield compose(control.pose, np.array([point[0], point[1], ahead[index, 2]])), min(away, look_ahead)
    along = distances_along(path) + math.hypot(float(ahead[0, 0]), float(ahead[0, 1]))
    for i in range(path.shape[0] - 2, -1, -1):
        yield path[i], float(along[i])


def _with_headings(path: Array) -> Array:
    """Return a path along whose way its poses look, where all but the last look in one direction."""
    if path.shape[0] < 3 or np.any(np.abs(wrap(path[1:-1, 2] - path[1, 2])) > 1e-6):
        return path
    return with_headings(path[:, :2], final_heading=float(path[-1, 2]))


def _with_heading(target: Array, heading: float) -> Array:
    return np.array([target[0], target[1], heading])


def _angle_to(pose: Array, target: Array) -> Array:
    return wrap(math.atan2(float(target[1] - pose[1]), float(target[0] - pose[0])) - float(pose[2]))


def _looks_along(pose: Array, target: Array) -> bool:
    """Return whether a target looks away from a pose, as one that is reached ahead does."""
    return math.cos(float(_angle_to(_with_heading(pose, float(target[2])), target))) > 0.0


def _scaled(footprint: Footprint, scale: float) -> Footprint:
    """Return a larger footprint; a round one stays, as the inflation of the costmap is for its radius."""
    if footprint.circular or scale <= 1.0:
        return footprint
    return replace(
        footprint,
        polygon=footprint.polygon * scale,
        inscribed_radius=footprint.inscribed_radius * scale,
        circumscribed_radius=footprint.circumscribed_radius * scale,
    )


def _highest_cost(costmap: Costmap, poses: Array) -> int:
    """Return the largest known cost at positions."""
    costs = [costmap.cost_at(float(pose[0]), float(pose[1])) for pose in poses]
    return max((cost for cost in costs if cost != NO_INFORMATION), default=0)
