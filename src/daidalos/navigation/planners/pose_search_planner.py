"""What planners by A* over poses have in common: parameters, and the way from a costmap to a path."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import group, parameter
from daidalos.navigation.contracts import GlobalPlanner, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOccupied, NoPath, StartOccupied
from daidalos.navigation.planners.cost_to_go import CostsToGoal
from daidalos.navigation.planners.goal_curves import stands_free
from daidalos.navigation.planners.path_smoothing import smoothed
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, Prices, prices, run_search
from daidalos.navigation.planners.smac_parameters import GoalHeadings, PathSmoothing
from daidalos.navigation.planners.terminals import goal_cell, start_cell, words


@dataclass(frozen=True)
class PoseSearchParameters(GoalHeadings):
    """Parameters that these planners share, by their Nav2 names."""

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
    reverse_penalty: float = parameter(2.0, "Factor of the cost of driving backwards.", minimum=1.0)
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


class Terrain(NamedTuple):
    """Costmap of a search and its two ends, in cells.

    Attributes
    ----------
    costmap : Costmap
    price : ndarray
        Price of a step over a cell of each cost.
    polygon : ndarray, shape (n, 2)
        Outline of the robot; empty where it is round.
    start : ndarray, shape (3,)
    goals : ndarray, shape (k, 3)
        The goal at each heading that the path may end at.
    """

    costmap: Costmap
    price: Prices
    polygon: Array
    start: Array
    goals: Array


class PoseSearchPlanner(GlobalPlanner):
    """Planner by A* over poses; a subclass says which motions there are.

    Attributes
    ----------
    smooth : callable
        Makes a path smoother that keeps to the turning radius.
    """

    parameters: PoseSearchParameters
    smooth: Any = staticmethod(smoothed)

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

    @property
    @abstractmethod
    def heading_count(self) -> int:
        """Number of headings in a full turn."""

    @abstractmethod
    def _options(self, resolution: float) -> Any:
        """Return the options of a search on cells of some size [m]."""

    @abstractmethod
    def _search(self, terrain: Terrain, rest: Prices, factor: int, options: Any) -> Any:
        """Return a search that has not begun.

        Parameters
        ----------
        terrain : Terrain
        rest : ndarray
            Costs to the goal of cells `factor` times as large.
        factor : int
        options
            Those of `_options`.
        """

    @abstractmethod
    def _no_way(self, goal: str) -> str:
        """Return that no way leads to a goal."""

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        terrain = self._terrain(costmap, start, goal)
        if not _stands_free(terrain, terrain.start):
            raise StartOccupied(f"the robot at {words(start)} touches an obstacle, so that it is enclosed by it")
        is_free = any(_stands_free(terrain, one) for one in terrain.goals)
        if not is_free and p.tolerance < costmap.resolution:
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}")
        options = self._options(costmap.resolution)
        factor = self._rest.factor
        margin = 4.0 * options.radius
        rest = self._rest.compute(costmap, terrain.price, first, last, reach=options.reach, margin=margin)
        search = self._search(terrain, rest, factor, options)
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
            raise (NoPath if is_free else GoalOccupied)(self._no_way(words(goal)))
        path: Array = search.path()
        if p.smooth_path:
            costs, resolution = costmap.costs, costmap.resolution
            path = self.smooth(path, costs, terrain.price, terrain.polygon, options.radius, p.smoother, resolution)
        path[:, :2] = costmap.origin + (path[:, :2] + 0.5) * costmap.resolution
        path[:, 2] = np.remainder(path[:, 2] + np.pi, 2.0 * np.pi) - np.pi
        return path

    def _terrain(self, costmap: Costmap, start: Array, goal: Array) -> Terrain:
        p, footprint = self.parameters, self.context.footprint
        price = prices(1.0, p.cost_penalty, quadratic=p.use_quadratic_cost_penalty, allow_unknown=p.allow_unknown)
        polygon = np.empty((0, 2)) if footprint.circular else footprint.polygon / costmap.resolution
        begin, end = (
            np.array([*((pose[:2] - costmap.origin) / costmap.resolution - 0.5), pose[2]]) for pose in (start, goal)
        )
        return Terrain(costmap, price, polygon, begin, p.goals(end, self.heading_count))

    def _lengths(self, resolution: float, bins: int, *key: Any) -> Prices:
        """Return the table of the curves' lengths for cells of some size [m], empty where its key has changed."""
        edge = 2 * math.ceil(0.5 * self.parameters.lookup_table_size / resolution) + 1
        if self._table is None or self._table[0] != (edge, bins, *key):
            self._table = (edge, bins, *key), np.zeros((edge, edge // 2 + 1, bins), dtype=np.float32)
        return self._table[1]


def _stands_free(terrain: Terrain, pose: Array) -> bool:
    return bool(stands_free(terrain.costmap.costs, terrain.price, terrain.polygon, *pose))
