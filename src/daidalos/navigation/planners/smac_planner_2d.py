"""Smac 2D planner: A* over the costs of cells, and a smoothed path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, group, parameter
from daidalos.navigation.contracts import GlobalPlanner
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOccupied, NoPath
from daidalos.navigation.paths import with_headings
from daidalos.navigation.planners.grid_search import GridSearch, restore_where_blocked
from daidalos.navigation.planners.search import FOUND, prices, run_search
from daidalos.navigation.planners.smac_parameters import PathSmoothing, downsampled
from daidalos.navigation.planners.terminals import goal_cell, start_cell, way_out, words
from daidalos.navigation.smoothers.parts import smooth_parts
from daidalos.navigation.smoothers.simple_smoother import relax


@dataclass(frozen=True)
class SmacPlanner2DParameters(Parameters):
    """Parameters of the planner, by their Nav2 names."""

    tolerance: float = parameter(
        0.125, "Distance to the goal within which another cell may take its place.", unit="m", minimum=0.0
    )
    downsample_costmap: bool = parameter(False, "Whether to search over larger cells.")
    downsampling_factor: int = parameter(1, "How many times larger those are.", minimum=1)
    allow_unknown: bool = parameter(True, "Whether paths may cross unknown cells.")
    max_iterations: int = parameter(1_000_000, "Cells that may be expanded; 0 or less for any number.")
    max_on_approach_iterations: int = parameter(
        1000, "Cells that are expanded within the tolerance before the nearest one is taken.", minimum=0
    )
    max_planning_time: float = parameter(2.0, "Longest time of a search; 0 or less for any.", unit="s")
    cost_travel_multiplier: float = parameter(1.0, "Weight of the costs along the path beside its length.", minimum=0.0)
    use_final_approach_orientation: bool = parameter(
        False, "Whether the path ends in the direction in which it arrives."
    )
    terminal_checking_interval: int = parameter(
        5000, "Expansions between two looks at the clock and for a cancellation.", minimum=1
    )
    smoother: PathSmoothing = group(PathSmoothing)


class SmacPlanner2D(GlobalPlanner):
    """Planner by A* over cells and their eight neighbours, for round robots that turn in place.

    The cost of a cell's length is ``1 + cost_travel_multiplier * cost / 252``.
    """

    names = ("nav2_smac_planner::SmacPlanner2D",)
    Parameters = SmacPlanner2DParameters
    parameters: SmacPlanner2DParameters

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        costmap = downsampled(costmap, p.downsampling_factor if p.downsample_costmap else 1)
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        price = prices(1.0, p.cost_travel_multiplier, quadratic=False, allow_unknown=p.allow_unknown)
        is_free = bool(np.isfinite(price[costmap.costs[last[1], last[0]]]))
        reach = p.tolerance / costmap.resolution
        if not is_free and reach < 1.0:
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}: its cell is not passable")
        entry = way_out(costmap, first, price, start)
        search = GridSearch(costmap, price, entry, last, reach=reach, on_approach=p.max_on_approach_iterations)
        state = run_search(
            search.advance,
            p.terminal_checking_interval,
            self.is_cancelled,
            max_iterations=p.max_iterations,
            max_planning_time=p.max_planning_time,
        )
        if state != FOUND:
            kind = NoPath if is_free else GoalOccupied
            raise kind(f"no way leads to the goal {words(goal)} or within {p.tolerance} m of it: obstacles cut it off")
        cells = search.cells()
        points = costmap.origin + (cells + 0.5) * costmap.resolution
        if tuple(cells[-1]) == last:
            points = np.concatenate([points[:-1] if len(points) > 2 else points[:1], goal[None, :2]])
        points = np.concatenate([start[None, :2], points if entry != first else points[1:]])
        given = with_headings(points, initial_heading=float(start[2]))
        path = self._smoothed(given, costmap)
        restore_where_blocked(path, given, costmap, price)
        final = None if p.use_final_approach_orientation else float(goal[2])
        return with_headings(path[:, :2], final_heading=final, initial_heading=float(start[2]))

    def _smoothed(self, path: Array, costmap: Costmap) -> Array:
        s = self.parameters.smoother

        def smooth(points: Array) -> Array:
            return relax(
                points, costmap.costs, costmap.resolution, costmap.origin, s.w_data, s.w_smooth, s.tolerance,
                s.max_iterations,
            )  # fmt: skip

        return smooth_parts(path, smooth, split=False, times=s.times)
