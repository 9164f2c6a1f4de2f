"""NavFn planner: navigation function over the costmap, and gradient descent."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import GlobalPlanner
from daidalos.navigation.costmap.costmap import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    MAX_NON_OBSTACLE,
    NO_INFORMATION,
    Costmap,
)
from daidalos.navigation.errors import GoalOccupied, NoPath
from daidalos.navigation.paths import with_headings
from daidalos.navigation.planners.navigation_function import descend, nearest_reached, propagate
from daidalos.navigation.planners.terminals import Cell, goal_cell, start_cell, way_out, words

COST_FACTOR = 0.8 / 50.0
"""Cost of a step over a cell is 1 + this times the cell's cost, in units of a step over free ground.

The proportion of Nav2's neutral cost (50) and cost factor (0.8), so that tuned inflation radii keep their
effect.
"""

OBSTACLE_SKIN = 0.1
"""Assumed depth [m] of obstacles behind the surface that sensors see; unknown goals there are rejected."""


@dataclass(frozen=True)
class NavfnPlannerParameters(Parameters):
    """Parameters of the planner, by their Nav2 names."""

    tolerance: float = parameter(
        0.5, "Distance to an occupied goal within which another cell may take its place.", unit="m", minimum=0.0
    )
    use_astar: bool = parameter(False, "Whether to search with A* instead of Dijkstra's algorithm.")
    allow_unknown: bool = parameter(True, "Whether paths may cross unknown cells.")
    use_final_approach_orientation: bool = parameter(
        False, "Whether the path ends in the direction in which it arrives."
    )


class NavfnPlanner(GlobalPlanner):
    """Planner by Dijkstra's algorithm or A* over cells, with a path off the grid by gradient descent.

    The wavefront solves the eikonal equation on the grid (upwind differences, Sethian 1996), so that its
    value is the cost of the best path in any direction, and the path follows its gradient between the cells.
    From a start inside of inflation the path takes the shortest way out. A goal that lies in an obstacle is
    refused; one too near to an obstacle, or cut off, is replaced by the nearest cell within the tolerance
    that can be reached.
    """

    names = ("nav2_navfn_planner::NavfnPlanner",)
    Parameters = NavfnPlannerParameters
    parameters: NavfnPlannerParameters

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        self._refuse_obstacles(costmap, last, goal)
        step = self._step_costs()
        entry = way_out(costmap, first, step, start)
        potential = self._potential(costmap, step, entry, last)
        reached = last if np.isfinite(potential[last[1], last[0]]) else self._near(costmap, potential, last, goal)
        end = goal[:2] if reached == last else np.array(costmap.map_to_world(*reached))
        begin = start[:2] if entry == first else np.array(costmap.map_to_world(*entry))
        from_cells, to_cells = ((p - costmap.origin) / costmap.resolution - 0.5 for p in (begin, end))
        cells = descend(potential, to_cells[0], to_cells[1], from_cells[0], from_cells[1])
        points = costmap.origin + (cells + 0.5) * costmap.resolution
        if entry != first:
            points = np.concatenate([start[None, :2], points])
        final = None if self.parameters.use_final_approach_orientation else float(goal[2])
        return with_headings(points, final_heading=final, initial_heading=float(start[2]))

    def _refuse_obstacles(self, costmap: Costmap, last: Cell, goal: Array) -> None:
        cost = int(costmap.costs[last[1], last[0]])
        if cost == LETHAL_OBSTACLE or (cost == NO_INFORMATION and _touches_obstacle(costmap, last)):
            raise GoalOccupied(f"the goal {words(goal)} is in an obstacle")
        if cost == NO_INFORMATION and not self.parameters.allow_unknown:
            raise GoalOccupied(f"the goal {words(goal)} is in unknown space and allow_unknown is false")

    def _potential(self, costmap: Costmap, step: NDArray[np.float32], entry: Cell, last: Cell) -> NDArray[np.float32]:
        """Compute the navigation function from the start, at least up to the goal if it is reachable.

        With A* the wavefront is bounded by the cost that the straight distance promises, which is raised
        until the goal is reached. That keeps the wavefront's order and with it smooth paths, which sorting
        cells by the promised total, as A* does on a graph, would not.
        """
        bound = 1.2 * math.hypot(entry[0] - last[0], entry[1] - last[1]) + 10.0
        highest = 10.0 * bound if self.parameters.use_astar else 0.0
        while bound < highest:
            potential = propagate(costmap.costs, step, entry[0], entry[1], last[0], last[1], bound)
            if np.isfinite(potential[last[1], last[0]]):
                return potential
            bound *= 1.6
        return propagate(costmap.costs, step, entry[0], entry[1], last[0], last[1], math.inf)

    def _step_costs(self) -> NDArray[np.float32]:
        """Return the cost of a step over a cell of each value, in units of a step over free space."""
        step = (1.0 + COST_FACTOR * np.arange(256)).astype(np.float32)
        step[INSCRIBED_INFLATED_OBSTACLE:] = np.inf
        if self.parameters.allow_unknown:
            step[NO_INFORMATION] = step[MAX_NON_OBSTACLE]
        return step

    def _near(self, costmap: Costmap, potential: NDArray[np.float32], last: Cell, goal: Array) -> Cell:
        """Return the reachable cell nearest to the goal, within the tolerance."""
        tolerance = self.parameters.tolerance
        column, row = nearest_reached(potential, last[0], last[1], tolerance / costmap.resolution)
        if column >= 0:
            return column, row
        within = f" and nothing within {tolerance} m of it can be reached" if tolerance > 0.0 else ""
        if costmap.costs[last[1], last[0]] == INSCRIBED_INFLATED_OBSTACLE:
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}: an obstacle is too near{within}")
        raise NoPath(f"no way leads to the goal {words(goal)}: obstacles cut it off{within}")


def _touches_obstacle(costmap: Costmap, cell: Cell) -> bool:
    reach = round(OBSTACLE_SKIN / costmap.resolution)
    column, row = cell
    left, below = max(column - reach, 0), max(row - reach, 0)
    around = costmap.costs[below : row + reach + 1, left : column + reach + 1]
    rows, columns = np.nonzero(around == LETHAL_OBSTACLE)
    return bool(np.any((rows + below - row) ** 2 + (columns + left - column) ** 2 <= reach**2))
