"""Costmaps, lines and outlines, beside brute force."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point32, Polygon
from hypothesis import given
from hypothesis import strategies as st
from nav2_msgs.msg import Costmap
from nav2_simple_commander.costmap_2d import PyCostmap2D
from nav2_simple_commander.footprint_collision_checker import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    FootprintCollisionChecker,
)
from nav2_simple_commander.line_iterator import LineIterator
from nav2_simple_commander.occupancy_grid import PyOccupancyGrid
from nav2_simple_commander.utils import euler_to_quaternion, find_os_processes
from nav_msgs.msg import OccupancyGrid
from tf_transformations import quaternion_from_euler


def costmap(width=20, height=10):
    message = Costmap()
    message.metadata.size_x, message.metadata.size_y, message.metadata.resolution = width, height, 0.5
    message.metadata.origin.position.x, message.metadata.origin.position.y = -2.0, 1.0
    message.header.frame_id, message.header.stamp.sec = "map", 7
    message.data = bytes(width * height)
    return PyCostmap2D(message)


def test_a_costmap_by_cells_and_metres():
    grid = costmap()
    assert (grid.getSizeInCellsX(), grid.getSizeInCellsY()) == (20, 10)
    assert (grid.getSizeInMetersX(), grid.getSizeInMetersY()) == (9.75, 4.75)
    assert (grid.getOriginX(), grid.getOriginY(), grid.getResolution()) == (-2.0, 1.0, 0.5)
    assert (grid.getGlobalFrameID(), grid.getCostmapTimestamp().sec) == ("map", 7)
    grid.setCost(3, 2, 200)
    assert grid.getCostXY(3, 2) == grid.getCostIdx(43) == 200
    assert grid.getIndex(3, 2) == 43
    assert grid.mapToWorld(3, 2) == (-0.25, 2.25)
    assert grid.worldToMapValidated(-0.25, 2.25) == (3, 2)
    assert grid.worldToMapValidated(-2.01, 2.0) == (None, None)
    assert grid.worldToMapValidated(0.0, 6.0) == (None, None)
    assert grid.worldToMap(-0.25, 2.25) == (3, 2)
    assert grid.worldToMap(-2.01, 6.0) == (-1, 10)


def test_an_occupancy_grid():
    message = OccupancyGrid(data=[0, 100, -1, 50])
    message.info.width = message.info.height = 2
    message.info.resolution = 1.0
    grid = PyOccupancyGrid(message)
    assert [grid.getCostIdx(index) for index in range(4)] == [0, 100, 255, 50]


@given(*[st.integers(-20, 20)] * 4, st.sampled_from([0.3, 0.5, 1.0, 2.0]))
def test_a_line_goes_from_end_to_end_in_steps(x0, y0, x1, y1, step):
    if (x0, y0) == (x1, y1):
        with pytest.raises(ValueError, match="no length"):
            LineIterator(x0, y0, x1, y1, step)
        return
    line, points = LineIterator(x0, y0, x1, y1, step), []
    while line.isValid():
        points.append((line.getX(), line.getY()))
        line.advance()
    assert (points[0], points[-1]) == ((x0, y0), (x1, y1))
    length = abs(x1 - x0) or abs(y1 - y0)
    assert len(points) == math.ceil(round(length / step, 9)) + 1
    for x, y in points:
        assert abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) <= 1e-3 * line.get_line_length()


@pytest.mark.parametrize(
    ("arguments", "error"),
    [((0, 0, "a", 1), TypeError), ((0, None, 1, 1), TypeError), ((0, 0, 1, 1, 0), ValueError)],
)
def test_what_is_no_line(arguments, error):
    with pytest.raises(error):
        LineIterator(*arguments)


def box(half_length, half_width):
    corners = ((1, 1), (1, -1), (-1, -1), (-1, 1))
    return Polygon(points=[Point32(x=half_length * x, y=half_width * y) for x, y in corners])


@pytest.mark.parametrize("theta", [0.0, 0.4, math.pi / 2, 2.5])
def test_an_outline_meets_what_lies_on_its_edges(theta):
    grid, checker = costmap(40, 40), FootprintCollisionChecker()
    checker.setCostmap(grid)
    x, y = 7.6, 10.9
    assert checker.footprintCostAtPose(x, y, theta, box(3.0, 2.0)) == 0.0
    middle = (x + 2.99 * math.cos(theta), y + 2.99 * math.sin(theta))
    column, row = grid.worldToMapValidated(*middle)
    # Edges go from cell to cell, so they may be beside the true line by a cell.
    grid.costmap.reshape(40, 40)[row - 1 : row + 2, column - 1 : column + 2] = INSCRIBED_INFLATED_OBSTACLE
    assert checker.footprintCostAtPose(x, y, theta, box(3.0, 2.0)) == INSCRIBED_INFLATED_OBSTACLE
    grid.setCost(*grid.worldToMapValidated(x, y), LETHAL_OBSTACLE)  # inside, not on an edge
    assert checker.footprintCostAtPose(x, y, theta, box(3.0, 2.0)) == INSCRIBED_INFLATED_OBSTACLE
    assert checker.footprintCostAtPose(x, y, theta, box(0.1, 0.1)) == LETHAL_OBSTACLE
    assert checker.footprintCostAtPose(-1.0, y, theta, box(3.0, 2.0)) == LETHAL_OBSTACLE


def test_a_steep_line_passes_over_no_row():
    grid, checker = costmap(5, 40), FootprintCollisionChecker()
    checker.setCostmap(grid)
    for row in range(40):
        grid.costmap[:] = 0
        grid.costmap.reshape(40, 5)[row] = LETHAL_OBSTACLE
        assert checker.lineCost(1, 3, 0, 39) == LETHAL_OBSTACLE
        assert checker.lineCost(3, 1, 39, 0) == LETHAL_OBSTACLE


def test_an_outline_needs_a_costmap():
    with pytest.raises(ValueError, match="use setCostmap"):
        FootprintCollisionChecker().footprintCost(box(1.0, 1.0))


def test_rotations():
    rotation = euler_to_quaternion(0.3, -0.7, 1.9)
    assert (rotation.x, rotation.y, rotation.z, rotation.w) == pytest.approx(quaternion_from_euler(0.3, -0.7, 1.9))
    assert np.isclose(euler_to_quaternion(yaw=math.pi).z, 1.0)


def test_processes_by_name():
    import subprocess
    import sys

    with subprocess.Popen([sys.executable, "-c", "input()", "a name of its own"], stdin=subprocess.PIPE) as named:
        assert [pid for pid, _ in find_os_processes("a name of its own")] == [named.pid]
        named.kill()
    assert find_os_processes("no such process " + "at all") == []
