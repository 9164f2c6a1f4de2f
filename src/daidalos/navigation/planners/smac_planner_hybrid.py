"""Smac Hybrid-A* planner: paths that a robot with a turning radius can drive."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import group, parameter
from daidalos.navigation.contracts import GlobalPlanner, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOccupied, NoPath, StartOccupied
from daidalos.navigation.planners.cost_to_go import CostsToGoal
from daidalos.navigation.planners.goal_curves import stands_free
from daidalos.navigation.planners.hybrid_search import HybridOptions, HybridSearch
from daidalos.navigation.planners.path_smoothing import smoothed
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, Prices, prices, run_search
from daidalos.navigation.planners.smac_parameters import GoalHeadings, PathSmoothing, downsampled
from daidalos.navigation.planners.terminals import goal_cell, start_cell, words


@dataclass(frozen=True)
class SmacPlannerHybridParameters(GoalHeadings):
    """Parameters of the planner, by their Nav2 names."""

    downsample_costmap: bool = parameter(False, "Whether to search over larger cells.")
    downsampling_factor: int = parameter(1, "How many times larger those are.", minimum=1)
    tolerance: float = parameter(
        0.25, "Distance to the goal within which another pose may take its place.", unit="m", minimum=0.0
    )
    allow_unknown: bool = parameter(True, "Whether paths may cross unknown cells.")
    max_iterations: int = parameter(1_000_000, "Poses that may be expanded; 0 or less for any number.")
    max_on_approach_iterations: int = parameter(
        1000, "Poses that are expanded within the tolerance before the nearest one is taken.", minimum=0
    )
    terminal_checking_interval: int = parameter(
        5000, "Expansions between two looks at the clock and for a cancellation.", minimum=1
    )
    max_planning_time: float = parameter(5.0, "Longest time of a search; 0 or less for any.", unit="s")
    motion_model_for_search: str = parameter(
        "DUBIN", "Whether the robot drives forward only, or both ways.", choices=("DUBIN", "REEDS_SHEPP")
    )
    angle_quantization_bins: int = parameter(72, "Headings of a full turn.", minimum=4)
    minimum_turning_radius: float = parameter(0.4, "Radius of the narrowest turn.", unit="m", above=0.0)
    reverse_penalty: float = parameter(2.0, "Factor of the cost of driving backwards.", minimum=1.0)
    change_penalty: float = parameter(0.0, "Added to the factor of a turn to another side.", minimum=0.0)
    non_straight_penalty: float = parameter(1.2, "Factor of the cost of a turn.", minimum=1.0)
    cost_penalty: float = parameter(2.0, "Weight of the costs along the path beside its length.", minimum=0.0)
    retrospective_penalty: float = parameter(
        0.015,
        "What each step is cheaper by, so that turns come late and the search is quicker.",
        minimum=0.0,
        below=1.0,
    )
    use_quadratic_cost_penalty: bool = parameter(False, "Whether costs count by their squares.")
    analytic_expansion_ratio: float = parameter(
        3.5, "How much more often curves to the goal are tried as it gets near.", minimum=1.0
    )
    analytic_expansion_max_length: float = parameter(3.0, "Longest curve to the goal.", unit="m", above=0.0)
    analytic_expansion_max_cost: float = parameter(200.0, "Highest cost under a curve to the goal.", minimum=0.0)
    analytic_expansion_max_cost_override: bool = parameter(
        False, "Whether curves within a full turn of the goal may have any cost."
    )
    allow_primitive_interpolation: bool = parameter(False, "Whether the search has turns wider than the narrowest.")
    lookup_table_size: float = parameter(
        20.0, "Edge of the area in which the turning radius is estimated.", unit="m", above=0.0
    )
    cache_obstacle_heuristic: bool = parameter(
        False,
        "Whether estimates of the costs to a goal are kept for the next plan to it, though costs may have changed.",
    )
    downsample_obstacle_heuristic: bool = parameter(True, "Whether these estimates are over cells twice as large.")
    smooth_path: bool = parameter(True, "Whether the path is smoothed.")
    smoother: PathSmoothing = group(PathSmoothing)


class SmacPlannerHybrid(GlobalPlanner):
    """Planner by Hybrid-A* (Dolgov and others 2008) with Dubins or Reeds-Shepp curves.

    The path keeps to the turning radius, smoothed or not, and the robot's footprint touches nothing along it. It ends
    at the goal, or within a cell and half of the narrowest turn of it where no curve fits.
    """

    names = ("nav2_smac_planner::SmacPlannerHybrid",)
    Parameters = SmacPlannerHybridParameters
    parameters: SmacPlannerHybridParameters

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._table: tuple[Any, Prices] | None = None
        self._rest = self._kept_costs()

    def reconfigure(self, parameters: Any) -> None:
        """Implement `NavigationExtension.reconfigure`."""
        super().reconfigure(parameters)
        self._rest = self._kept_costs()

    def _kept_costs(self) -> CostsToGoal:
        p = self.parameters
        return CostsToGoal(is_kept=p.cache_obstacle_heuristic, is_downsampled=p.downsample_obstacle_heuristic)

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        costmap = downsampled(costmap, p.downsampling_factor if p.downsample_costmap else 1)
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        price = prices(1.0, p.cost_penalty, quadratic=p.use_quadratic_cost_penalty, allow_unknown=p.allow_unknown)
        footprint = self.context.footprint
        polygon = np.empty((0, 2)) if footprint.circular else footprint.polygon / costmap.resolution
        begin, end = (
            np.array([*((pose[:2] - costmap.origin) / costmap.resolution - 0.5), pose[2]]) for pose in (start, goal)
        )
        if not stands_free(costmap.costs, price, polygon, *begin):
            raise StartOccupied(f"the robot at {words(start)} touches an obstacle, so that it is enclosed by it")
        goals = p.goals(end, p.angle_quantization_bins)
        is_free = any(stands_free(costmap.costs, price, polygon, *one) for one in goals)
        if not is_free and p.tolerance < costmap.resolution:
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}")
        options = self._options(costmap.resolution)
        factor = self._rest.factor
        rest = self._rest.compute(costmap, price, first, last, reach=options.reach, margin=4.0 * options.radius)
        search = HybridSearch(costmap.costs, price, polygon, rest, factor, begin, goals, options)
        state = EXHAUSTED
        if np.isfinite(rest[first[1] // factor, first[0] // factor]):
            state = run_search(
                search.advance,
                p.terminal_checking_interval,
                self.is_cancelled,
                max_iterations=p.max_iterations,
                max_planning_time=p.max_planning_time,
            )
        if state != FOUND:
            kind = NoPath if is_free else GoalOccupied
            raise kind(
                f"no way leads to the goal {words(goal)} or within {p.tolerance} m of it that the robot can drive"
            )
        path = search.path()
        if p.smooth_path:
            path = smoothed(path, costmap.costs, price, polygon, options.radius, p.smoother, costmap.resolution)
        path[:, :2] = costmap.origin + (path[:, :2] + 0.5) * costmap.resolution
        path[:, 2] = np.remainder(path[:, 2] + np.pi, 2.0 * np.pi) - np.pi
        return path

    def _options(self, resolution: float) -> HybridOptions:
        p = self.parameters
        is_reverse_allowed = p.motion_model_for_search == "REEDS_SHEPP"
        radius = max(p.minimum_turning_radius / resolution, 1.0)
        edge = 2 * math.ceil(0.5 * p.lookup_table_size / resolution) + 1
        key = (edge, p.angle_quantization_bins, radius, is_reverse_allowed)
        if self._table is None or self._table[0] != key:
            self._table = key, np.zeros((edge, edge // 2 + 1, p.angle_quantization_bins), dtype=np.float32)
        return HybridOptions(
            radius, p.angle_quantization_bins, is_reverse_allowed, p.reverse_penalty, p.change_penalty,
            p.non_straight_penalty, p.retrospective_penalty, p.analytic_expansion_ratio,
            p.analytic_expansion_max_length / resolution, p.analytic_expansion_max_cost,
            p.analytic_expansion_max_cost_override, p.allow_primitive_interpolation, p.coarse_search_resolution,
            p.tolerance / resolution,            p.max_on_approach_iterations, self._table[1],
        )  # fmt: skip
