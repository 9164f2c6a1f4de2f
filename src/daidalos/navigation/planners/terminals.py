"""Cells of the start and the goal of a path, and the errors for those that cannot be used."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOutsideMap, StartOccupied, StartOutsideMap
from daidalos.navigation.planners.navigation_function import nearest_passable_cell

Cell = tuple[int, int]
"""Column and row."""

ESCAPE_RADIUS = 0.5
"""Maximum distance [m] of a free cell from a lethal start; localization is rarely worse."""


def start_cell(costmap: Costmap, start: Array) -> Cell:
    """Return the cell of the start.

    Raises
    ------
    StartOutsideMap
    """
    cell = _cell(costmap, start)
    if cell is None:
        raise StartOutsideMap(f"the robot at {words(start)} is outside of the map, {_extent(costmap)}")
    return cell


def goal_cell(costmap: Costmap, goal: Array) -> Cell:
    """Return the cell of the goal.

    Raises
    ------
    GoalOutsideMap
    """
    cell = _cell(costmap, goal)
    if cell is None:
        raise GoalOutsideMap(f"the goal {words(goal)} is outside of the map, {_extent(costmap)}")
    return cell


def way_out(costmap: Costmap, first: Cell, step: NDArray[np.float32], start: Array) -> Cell:
    """Return the cell at which a search begins: the robot's, or the nearest one outside of inflation.

    Parameters
    ----------
    costmap : Costmap
    first : Cell
        Of the robot.
    step : ndarray of float32, shape (256,)
        Cost of a step over a cell of each value; infinite where the robot cannot be.
    start : ndarray
        Position of the robot [m], for the error.

    Raises
    ------
    StartOccupied
        There is no such cell.
    """
    if np.isfinite(step[costmap.costs[first[1], first[0]]]):
        return first
    reach = ESCAPE_RADIUS / costmap.resolution
    column, row = nearest_passable_cell(costmap.costs, step, first[0], first[1], reach)
    if column < 0:
        raise StartOccupied(f"the robot at {words(start)} is enclosed by obstacles and no free cell is near")
    return column, row


def words(pose: Array) -> str:
    """Return a position in words for an error."""
    return f"({float(pose[0]):.2f}, {float(pose[1]):.2f})"


def _cell(costmap: Costmap, pose: Array) -> Cell | None:
    if not np.isfinite(pose).all():
        return None
    column, row = costmap.world_to_map(float(pose[0]), float(pose[1]))
    return (column, row) if costmap.holds(column, row) else None


def _extent(costmap: Costmap) -> str:
    x, y = (float(value) for value in costmap.origin)
    width, height = costmap.width * costmap.resolution, costmap.height * costmap.resolution
    return f"which covers x {x:.2f} to {x + width:.2f} m, y {y:.2f} to {y + height:.2f} m"
