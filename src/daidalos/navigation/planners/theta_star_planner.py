"""Theta* planner: straight lines between cells in sight of each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import GlobalPlanner
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOccupied, NoPath
from daidalos.navigation.paths import with_headings
from daidalos.navigation.planners.grid_search import GridSearch, line_price, spaced, tightened
from daidalos.navigation.planners.search import FOUND, Prices, prices, run_search
from daidalos.navigation.planners.terminals import goal_cell, start_cell, way_out, words


@dataclass(frozen=True)
class ThetaStarPlannerParameters(Parameters):
    """Parameters of the planner, by their Nav2 names."""

    how_many_corners: int = parameter(8, "Neighbours of a cell in the search.", choices=(4, 8))
    w_euc_cost: float = parameter(1.0, "Weight of the path's length.", minimum=0.0)
    w_traversal_cost: float = parameter(2.0, "Weight of the squared costs along the path.", minimum=0.0)
    terminal_checking_interval: int = parameter(5000, "Expansions between two looks for a cancellation.", minimum=1)
    use_final_approach_orientation: bool = parameter(
        False, "Whether the path ends in the direction in which it arrives."
    )
    allow_unknown: bool = parameter(True, "Whether paths may cross unknown cells.")


class ThetaStarPlanner(GlobalPlanner):
    """Planner of paths of straight lines at any angle (Theta*, Nash and others 2007).

    The cost of a line is the integral of ``w_euc_cost + w_traversal_cost * (cost / 252)^2`` along it. The corners of
    the path that the search finds are moved from cell to cell until none can be better, so that paths on free ground
    are the shortest ones of their way around the obstacles.
    """

    names = ("nav2_theta_star_planner::ThetaStarPlanner",)
    Parameters = ThetaStarPlannerParameters
    parameters: ThetaStarPlannerParameters

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        price = prices(p.w_euc_cost, p.w_traversal_cost, quadratic=True, allow_unknown=p.allow_unknown)
        if not np.isfinite(price[costmap.costs[last[1], last[0]]]):
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}: its cell is not passable")
        entry = way_out(costmap, first, price, start)
        search = GridSearch(costmap, price, entry, last, corners=p.how_many_corners, is_any_angle=True)
        if run_search(search.advance, p.terminal_checking_interval, self.is_cancelled) != FOUND:
            raise NoPath(f"no way leads to the goal {words(goal)}: obstacles cut it off")
        corners = tightened(costmap.costs, price, search.cells().astype(np.float64))
        begin, end = ((pose[:2] - costmap.origin) / costmap.resolution - 0.5 for pose in (start, goal))
        corners = _with_ends(costmap, price, corners, begin if entry == first else None, end)
        points = costmap.origin + (corners + 0.5) * costmap.resolution
        if entry != first:
            points = np.concatenate([start[None, :2], points])
        final = None if p.use_final_approach_orientation else float(goal[2])
        return with_headings(spaced(points, costmap.resolution), final_heading=final, initial_heading=float(start[2]))


def _with_ends(costmap: Costmap, price: Prices, corners: Array, begin: Array | None, end: Array) -> Array:
    """Return corners (n, 2) from and to points beside the centres of the first and the last cell.

    An end takes the place of the centre where the next corner is in its sight, and is put before or after it otherwise.
    """
    if corners.shape[0] == 1:
        return np.stack([corners[0] if begin is None else begin, end])
    for point, at, beside in ((begin, 0, 1), (end, -1, -2)):
        if point is None:
            continue
        if np.isfinite(line_price(costmap.costs, price, point[0], point[1], *corners[beside])):
            corners[at] = point
        else:
            corners = np.concatenate([point[None], corners] if at == 0 else [corners, point[None]])
    return corners
