"""Timed elastic band: the way ahead and its timing, optimised in each cycle on both sides of obstacles."""

from __future__ import annotations

import ast
import itertools
import math
from collections import deque

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError
from daidalos.common.pose2 import between, wrap
from daidalos.localization.likelihood_map import Table
from daidalos.navigation.contracts import ControlInput, Controller, NavigationContext
from daidalos.navigation.controllers.teb import optimization as places
from daidalos.navigation.controllers.teb.alternatives import (
    Obstacles,
    Signature,
    distinct_paths,
    is_free,
    obstacles_beside,
    signature_of,
)
from daidalos.navigation.controllers.teb.band import Band
from daidalos.navigation.controllers.teb.optimization import clearance, optimize
from daidalos.navigation.controllers.teb.teb_parameters import TebParameters
from daidalos.navigation.costmap.costmap import LETHAL_OBSTACLE, Costmap
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.errors import NoValidControl
from daidalos.navigation.paths import distances_along

_OUTLINE_SPACING = 0.1
"""Largest distance [m] between the points that stand for a line or the sides of a polygon."""

_FAR = 1e3


class TebController(Controller):
    """Timed elastic band (Rösmann et al. 2012, 2017).

    The band is kept from cycle to cycle. It leads along the path; with ``enable_homotopy_class_planning`` bands on
    other sides of the obstacles beside it are optimised as well, and the one of least cost is followed.
    """

    names = ("teb_local_planner::TebLocalPlannerROS", "teb_local_planner/TebLocalPlannerROS")
    Parameters = TebParameters
    parameters: TebParameters

    def __init__(self, parameters: TebParameters | None = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._outline = _outline_of(self.parameters)
        self._limit: float | None = None
        self.reset()

    def reconfigure(self, parameters: TebParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; lifts the speed limit."""
        outline = _outline_of(parameters)
        super().reconfigure(parameters)
        self._outline, self._limit = outline, None

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return self.parameters.max_global_plan_lookahead_dist

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`; speeds ahead, backwards and sideways fall in proportion."""
        share = speed_limit / 100.0 if percentage else speed_limit / self.parameters.max_vel_x
        self._limit = None if speed_limit <= 0.0 else min(share, 1.0)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        self._bands: dict[Signature, Band] = {}
        self._taken: Signature | None = None
        self._cycles = 0
        self._changed_at = -math.inf
        self._shrunk_until = -math.inf
        self._direction, self._direction_until = 0.0, -math.inf
        self._history: deque[Array] = deque()

    @property
    def bands(self) -> list[Band]:
        """The bands of the last cycle, the one that is followed first."""
        return sorted(self._bands.values(), key=lambda band: band is not self._bands.get(self._taken or ()))

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        self._cycles += 1
        p = self.parameters
        path = self._path_ahead(control)
        distance = self._distances(control)
        obstacles = self._obstacles(control.costmap, distance, path)
        along_path = signature_of(path[:, :2], obstacles)
        self._renew(control.costmap, distance, path, obstacles, along_path)
        self._optimize(control, distance, path)
        for signature in self._by_cost(along_path):
            band = self._bands[signature]
            if not self._is_free(control, distance, band):
                continue
            if signature != self._taken:
                self._taken, self._changed_at = signature, self._now
            velocity = self._saturated(band.velocity(p.control_look_ahead_poses, exact=p.exact_arc_length))
            self._watch_for_oscillation(velocity)
            return velocity
        self._bands = {}
        if p.shrink_horizon_backup:
            self._shrunk_until = self._now + p.shrink_horizon_min_duration
        raise NoValidControl(
            f"each band from ({float(control.pose[0]):.2f}, {float(control.pose[1]):.2f}) touches an obstacle"
        )

    @property
    def _now(self) -> float:
        """Time [s] of the cycles since the last reset."""
        return self._cycles / self.context.frequency

    @property
    def _speeds(self) -> tuple[float, float, float, float]:
        """Largest speeds ahead, backwards, sideways [m/s] and turn rate [rad/s] under the speed limit."""
        p, share = self.parameters, 1.0 if self._limit is None else self._limit
        return p.max_vel_x * share, p.max_vel_x_backwards * share, p.max_vel_y * share, p.max_vel_theta

    # The way ahead.

    def _path_ahead(self, control: ControlInput) -> Array:
        """Return the poses of the path to be optimised, from the robot's to where the band ends."""
        p = self.parameters
        length = p.max_global_plan_lookahead_dist
        if self._now < self._shrunk_until:
            length *= 0.5
        path = control.path
        inside = [control.costmap.holds(*control.costmap.world_to_map(float(x), float(y))) for x, y, _ in path]
        outside = inside.index(False) if False in inside else len(inside)
        count = int(np.searchsorted(distances_along(path), length, side="right"))
        path = path[: max(min(count, outside), 1)]
        end = path[-1].copy()
        if path.shape[0] == control.path.shape[0] and np.hypot(*(control.goal - end)[:2]) < 0.5:
            end = control.goal
        elif p.global_plan_overwrite_orientation and path.shape[0] > 1:
            step = path[-1] - path[-2]
            end[2] = math.atan2(float(step[1]), float(step[0]))
        return np.concatenate([control.pose[None], path[1:-1], end[None]])

    def _distances(self, control: ControlInput) -> Table:
        """Return the distance [m] of each cell of the costmap to the nearest obstacle that counts."""
        from scipy.ndimage import distance_transform_edt

        p, costmap = self.parameters, control.costmap
        lethal = costmap.costs == LETHAL_OBSTACLE
        if not p.include_costmap_obstacles:
            lethal = np.zeros_like(lethal)
        rows, columns = np.nonzero(lethal)
        cosine, sine = math.cos(float(control.pose[2])), math.sin(float(control.pose[2]))
        x = costmap.origin[0] + costmap.resolution * (columns + 0.5) - control.pose[0]
        y = costmap.origin[1] + costmap.resolution * (rows + 0.5) - control.pose[1]
        behind = cosine * x + sine * y < -p.costmap_obstacles_behind_robot_dist
        lethal[rows[behind], columns[behind]] = False
        if not lethal.any():
            return np.full(lethal.shape, _FAR, dtype=np.float32)
        away = distance_transform_edt(~lethal) * costmap.resolution - 0.5 * costmap.resolution
        field: Table = np.maximum(away, 0.0).astype(np.float32)
        return field

    def _obstacles(self, costmap: Costmap, distance: Table, path: Array) -> Obstacles:
        p = self.parameters
        if not p.enable_homotopy_class_planning:
            return Obstacles(np.zeros((0, 2)), np.zeros((0, 2, 2)))
        away = self.context.footprint.inscribed_radius
        return obstacles_beside(
            distance, costmap.origin, costmap.resolution, path[0, :2], path[-1, :2],
            width=p.roadmap_graph_area_width, away=away,
        )  # fmt: skip

    # The bands.

    def _renew(
        self, costmap: Costmap, distance: Table, path: Array, obstacles: Obstacles, along_path: Signature
    ) -> None:
        """Move the bands on, and add those of classes that have none."""
        p = self.parameters
        kept: dict[Signature, Band] = {}
        taken: Signature | None = None
        for signature, band in self._bands.items():
            moved = np.abs(band.poses[-1] - path[-1])
            if (
                math.hypot(float(moved[0]), float(moved[1])) > p.force_reinit_new_goal_dist
                or abs(float(wrap(band.poses[-1, 2] - path[-1, 2]))) > p.force_reinit_new_goal_angular
            ):
                continue
            band.follow(path[0], path[-1])
            now = signature_of(band.poses[:, :2], obstacles)
            if now not in kept or band.cost < kept[now].cost:
                kept[now] = band
            if signature == self._taken:
                taken = now
        self._taken = taken
        leads_through = not is_free(path[:, :2], distance, costmap.origin, costmap.resolution)
        if along_path not in kept and not leads_through:
            kept[along_path] = self._band(path)
        if p.enable_homotopy_class_planning and len(kept) < p.max_number_classes:
            others = distinct_paths(
                distance, costmap.origin, costmap.resolution, path[0, :2], path[-1, :2], obstacles,
                threshold=p.obstacle_heading_threshold, known=set(kept), most=p.max_number_classes - len(kept),
            )  # fmt: skip
            for points in others:
                way = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
                way[0], way[-1] = path[0], path[-1]
                kept[signature_of(points, obstacles)] = self._band(way)
        if not kept:
            kept[along_path] = self._band(path)
        self._bands = kept

    def _band(self, path: Array) -> Band:
        p = self.parameters
        forward, _, sideways, turn = self._speeds
        first = between(path[0], path[min(1, len(path) - 1)])
        backward = p.allow_init_with_backwards_motion and float(first[0]) < 0.0
        return Band.along(path, forward, turn, p.min_samples, backward=backward, sideways=sideways > 0.0)

    def _optimize(self, control: ControlInput, distance: Table, path: Array) -> None:
        p = self.parameters
        if not p.optimization_activate:
            for band in self._bands.values():
                band.cost = float(band.times.sum())
            return
        limits, weights = self._limits(), self._weights()
        via_points = self._via_points(path)
        for signature, band in list(self._bands.items()):
            for round_ in range(p.no_outer_iterations):
                if p.teb_autosize:
                    band.resize(p.dt_ref, p.dt_hysteresis, p.min_samples, p.max_samples)
                grown = weights.copy()
                grown[places.OBSTACLE] *= p.weight_adapt_factor**round_
                band.cost = optimize(
                    band.poses, band.times, control.velocity, limits, grown, self._outline, distance,
                    control.costmap.origin, control.costmap.resolution, via_points, self._nearest(band, via_points),
                    p.no_inner_iterations,
                )  # fmt: skip
            # The costs are those of the poses, and may let a band leap over an obstacle.
            costmap = control.costmap
            if not np.isfinite(band.poses).all() or not is_free(
                band.poses[:, :2], distance, costmap.origin, costmap.resolution
            ):
                del self._bands[signature]

    def _limits(self) -> Array:
        p = self.parameters
        forward, backward, sideways, turn = self._speeds
        direction = self._direction if self._now < self._direction_until else 0.0
        return np.array([
            forward, backward, sideways, turn, p.acc_lim_x, p.acc_lim_y, p.acc_lim_theta, p.min_turning_radius,
            p.penalty_epsilon, p.min_obstacle_dist, p.inflation_dist, p.obstacle_cost_exponent,
            float(p.exact_arc_length), float(p.free_goal_vel), direction,
        ])  # fmt: skip

    def _weights(self) -> Array:
        p = self.parameters
        return np.array([
            p.weight_max_vel_x, p.weight_max_vel_y, p.weight_max_vel_theta, p.weight_acc_lim_x, p.weight_acc_lim_y,
            p.weight_acc_lim_theta, p.weight_kinematics_nh, p.weight_kinematics_forward_drive,
            p.weight_kinematics_turning_radius, p.weight_optimaltime, p.weight_shortest_path, p.weight_obstacle,
            p.weight_inflation, p.weight_viapoint, p.weight_prefer_rotdir,
        ])  # fmt: skip

    def _via_points(self, path: Array) -> Array:
        """Return the points (n, 2) of the path that attract the band."""
        spacing = self.parameters.global_plan_viapoint_sep
        if spacing <= 0.0 or path.shape[0] < 3:
            return np.zeros((0, 2))
        along = distances_along(path)
        wanted = np.arange(spacing, float(along[-1]), spacing)
        return np.ascontiguousarray(path[np.searchsorted(along, wanted), :2])

    def _nearest(self, band: Band, via_points: Array) -> Array:
        """Return the index of the pose that each point attracts."""
        nearest = np.zeros(len(via_points))
        first, last = 1, len(band.poses) - 1
        for i, point in enumerate(via_points):
            away = np.hypot(*(band.poses[first:last, :2] - point).T)
            if away.size == 0:
                break
            nearest[i] = first + int(away.argmin())
            if self.parameters.via_points_ordered:
                first = min(int(nearest[i]) + 1, last - 1)
        return nearest

    def _by_cost(self, along_path: Signature) -> list[Signature]:
        """Return the classes, the one to be taken first."""
        p = self.parameters
        if self._taken in self._bands and self._now - self._changed_at < p.switching_blocking_period:
            others = [one for one in self._bands if one != self._taken]
            return [self._taken, *sorted(others, key=lambda one: self._bands[one].cost)]

        def cost(signature: Signature) -> float:
            value = self._bands[signature].cost
            if signature == self._taken:
                value *= p.selection_cost_hysteresis
            if signature == along_path:
                value *= p.selection_prefer_initial_plan
            return value

        return sorted(self._bands, key=cost)

    # The command.

    def _is_free(self, control: ControlInput, distance: Table, band: Band) -> bool:
        """Return whether the robot touches nothing at the first poses of a band.

        A robot that touches something already may go where it comes no nearer to it.
        """
        p = self.parameters
        checker = FootprintCollisionChecker(control.costmap, self.context.footprint)
        count = len(band.poses) if p.feasibility_check_no_poses < 0 else p.feasibility_check_no_poses + 1
        poses = band.poses[:count]
        touches = checker.in_collision(poses[0])
        least = self._clearance(control, distance, poses[0]) - 0.1 * control.costmap.resolution
        if p.feasibility_check_lookahead_distance > 0.0:
            poses = poses[distances_along(poses) <= p.feasibility_check_lookahead_distance]
        for before, pose in itertools.pairwise(poses):
            length = math.hypot(*(pose - before)[:2])
            turn = float(wrap(pose[2] - before[2]))
            parts = math.ceil(length / max(self.context.footprint.inscribed_radius, control.costmap.resolution))
            parts = max(parts, math.ceil(abs(turn) / p.min_resolution_collision_check_angular), 1)
            for share in np.linspace(0.0, 1.0, parts + 1)[1:]:
                x, y = before[:2] + share * (pose - before)[:2]
                there = np.array([x, y, before[2] + share * turn])
                if checker.in_collision(there) and not (touches and self._clearance(control, distance, there) > least):
                    return False
        return True

    def _clearance(self, control: ControlInput, distance: Table, pose: Array) -> float:
        costmap = control.costmap
        return float(clearance(pose, self._outline, distance, costmap.origin, costmap.resolution)[0])

    def _saturated(self, velocity: Array) -> Array:
        forward, backward, sideways, turn = self._speeds
        low, high = np.array([-backward, -sideways, -turn]), np.array([forward, sideways, turn])
        if not self.parameters.use_proportional_saturation:
            return np.clip(velocity, low, high)
        most = np.where(velocity >= 0.0, high, -low)
        over = np.abs(velocity[most > 0.0]) / most[most > 0.0]
        scaled = velocity / max(float(over.max(initial=0.0)), 1.0)
        return np.clip(scaled, low, high)

    def _watch_for_oscillation(self, velocity: Array) -> None:
        """Prefer one direction of turning for a while once the robot turns to and fro on the spot."""
        p = self.parameters
        forward, _, _, turn = self._speeds
        self._history.append(np.array([velocity[0] / forward, velocity[2] / turn]))
        wanted = max(int(p.oscillation_filter_duration * self.context.frequency), 3)
        while len(self._history) > wanted:
            self._history.popleft()
        if not p.oscillation_recovery or len(self._history) < wanted or self._now < self._direction_until:
            return
        history = np.array(self._history)
        changes = int((np.diff(np.sign(history[:, 1])) != 0).sum())
        speed, rate = np.abs(history.mean(axis=0))
        if changes > 2 and speed < p.oscillation_v_eps and rate < p.oscillation_omega_eps:
            self._direction = 1.0 if history[-1, 1] >= 0.0 else -1.0
            self._direction_until = self._now + p.oscillation_recovery_min_duration


def _outline_of(p: TebParameters) -> Array:
    """Return the circles (k, 3) that stand for the robot.

    Raises
    ------
    ParameterError
        The line or the corners are not such.
    """
    kind = p.footprint_type
    if kind == "circular":
        return np.array([[0.0, 0.0, p.footprint_radius]])
    if kind == "two_circles":
        return np.array([[p.front_offset, 0.0, p.front_radius], [-p.rear_offset, 0.0, p.rear_radius]])
    if kind not in ("line", "polygon"):
        return np.zeros((1, 3))
    try:
        corners = np.array(ast.literal_eval(p.vertices) if kind == "polygon" else (p.line_start, p.line_end), float)
    except (ValueError, SyntaxError):
        corners = np.zeros(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or corners.shape[0] < (3 if kind == "polygon" else 2):
        name = "vertices" if kind == "polygon" else "line_start"
        raise ParameterError(
            f"footprint_model.{name}", "must be points of two numbers, such as [[0.2, 0.1], [0.2, -0.1]]"
        )
    closed = np.concatenate([corners, corners[:1]]) if kind == "polygon" else corners
    points = []
    for one, other in itertools.pairwise(closed):
        count = max(math.ceil(math.hypot(*(other - one)) / _OUTLINE_SPACING), 1)
        points.append(np.linspace(one, other, count + 1))
    outline = np.unique(np.concatenate(points), axis=0)
    return np.concatenate([outline, np.zeros((len(outline), 1))], axis=1)
