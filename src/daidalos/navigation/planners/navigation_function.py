"""Kernels of the navigation function: wavefront over cells, and gradient descent."""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, Costs

Field = NDArray[np.float32]

NOT_WAITING = -2
"""In place of the following cell of one that is in no bucket; the last one of a bucket has -1."""

LARGEST_DELAY = 2.0
"""How much a value may be below that of the bucket where it waits: the share that a second side takes off a step."""

MAX_DETOUR_RATIO = 0.1
"""Distance in cells by which a cell must be nearer to the goal for each step that its path is longer."""

BUCKETS = 64
BUCKET_WIDTH = 0.5
"""Width of a bucket in steps over free ground; a step costs at most 5.1 of them, so 64 buckets never wrap."""


@compiled
def propagate(
    costs: Costs,
    step: Field,
    start_column: int,
    start_row: int,
    goal_column: int,
    goal_row: int,
    bound: float,
) -> Field:
    """Compute the cost of the best path from the start to each cell, in steps over free space; infinite without one.

    Solves `|grad u| = step` with upwind differences (Godunov's scheme). Cells wait in buckets of equal value (Dial
    1969), each a linked list through the cells, and are taken up again when a better value turns up; so the order
    inside of a bucket does not change the result. A cell whose value gets better while it waits stays in its bucket.

    Parameters
    ----------
    costs : ndarray of uint8, shape (height, width)
        The costmap.
    step : ndarray of float32, shape (256,)
        Cost of a step over a cell of each value, at least 1; infinite where the robot cannot be.
    start_column, start_row, goal_column, goal_row : int
        The two cells. The front stops when the goal's value is final.
    bound : float
        Cells over which the way to the goal must cost more than this, by their value and the straight
        distance to the goal, are left out; a way that costs less is found as if they were not.

    Returns
    -------
    ndarray of float32, shape (height, width)
        The navigation function.
    """
    height, width = costs.shape
    stride = width + 2
    price = np.full((height + 2) * stride, np.inf, dtype=np.float32)  # with a border, so that each cell has neighbours
    for row in range(height):
        for column in range(width):
            price[(row + 1) * stride + column + 1] = step[costs[row, column]]
    value = np.full(price.size, np.inf, dtype=np.float32)
    following = np.full(price.size, NOT_WAITING, dtype=np.int32)
    head = np.full(BUCKETS, -1, dtype=np.int32)
    start = (start_row + 1) * stride + start_column + 1
    goal = (goal_row + 1) * stride + goal_column + 1
    value[start] = 0.0
    current = 0
    head[0] = start
    following[start] = -1
    waiting = 1
    while waiting > 0:
        cell = head[current % BUCKETS]
        if cell < 0:
            current += 1
            if current * BUCKET_WIDTH > value[goal] + LARGEST_DELAY:
                break
            continue
        head[current % BUCKETS] = following[cell]
        following[cell] = NOT_WAITING
        waiting -= 1
        here = value[cell]
        for other in (cell - 1, cell + 1, cell - stride, cell + stride):
            cost = price[other]
            if cost == np.inf or not here < value[other]:
                continue
            a = min(value[other - 1], value[other + 1])
            b = min(value[other - stride], value[other + stride])
            low, high = min(a, b), max(a, b)
            apart = high - low
            better = low + cost
            if apart < cost:
                better = np.float32(0.5) * (low + high + np.sqrt(np.float32(2.0) * cost * cost - apart * apart))
            if better >= value[other] - np.float32(1e-4):
                continue
            if bound < np.inf:
                y = other // stride - 1
                x = other - (y + 1) * stride - 1
                if better + math.hypot(x - goal_column, y - goal_row) > bound:
                    continue
            value[other] = better
            if following[other] == NOT_WAITING:
                bucket = max(int(better / BUCKET_WIDTH), current) % BUCKETS
                following[other] = head[bucket]
                head[bucket] = other
                waiting += 1
    return value.reshape(height + 2, stride)[1:-1, 1:-1].copy()


@compiled
def descend(value: Field, goal_x: float, goal_y: float, start_x: float, start_y: float) -> Array:
    """Compute the path by descending the navigation function from the goal to the start.

    Steps of half a cell follow the gradient between the centres of cells; where that does not lead down, at
    edges of obstacles, the way leads over the centre of the cell to that of its lowest neighbour.

    Parameters
    ----------
    value : ndarray of float32, shape (height, width)
        The navigation function from the start.
    goal_x, goal_y, start_x, start_y : float
        The two points in cells, whole numbers at the centres of cells.

    Returns
    -------
    ndarray, shape (n, 2)
        Points (column, row), about a cell apart; the first is the start, the last the goal.
    """
    points = np.empty((1024, 2))
    points[0, 0], points[0, 1] = goal_x, goal_y
    count = 1
    x, y = goal_x, goal_y
    level = _interpolated(value, x, y)
    for number in range(8 * value.size):
        if math.hypot(x - start_x, y - start_y) < 1.0:
            break
        if count + 3 > points.shape[0]:
            larger = np.empty((2 * points.shape[0], 2))
            larger[:count] = points[:count]
            points = larger
        dx, dy = _steepest_descent(value, x, y)
        norm = math.hypot(dx, dy)
        if norm > 1e-3:
            nx, ny = x + 0.5 * dx / norm, y + 0.5 * dy / norm
            there = _interpolated(value, nx, ny)
            if there < level:
                x, y, level = nx, ny, there
                if number % 2 == 1:
                    points[count, 0], points[count, 1] = x, y
                    count += 1
                continue
        points[count, 0], points[count, 1] = float(round(x)), float(round(y))
        x, y, level = _lowest_neighbour(value, round(x), round(y))
        points[count + 1, 0], points[count + 1, 1] = x, y
        count += 2
    points[count, 0], points[count, 1] = start_x, start_y
    return points[: count + 1][::-1].copy()


@compiled
def _interpolated(value: Field, x: float, y: float) -> np.float32:
    """Return the bilinear value at a point; infinite if any cell around it is, to avoid blocked cells."""
    column = min(max(math.floor(x), 0), value.shape[1] - 2)
    row = min(max(math.floor(y), 0), value.shape[0] - 2)
    u, v = x - column, y - row
    low = (1.0 - u) * value[row, column] + u * value[row, column + 1]
    high = (1.0 - u) * value[row + 1, column] + u * value[row + 1, column + 1]
    return np.float32((1.0 - v) * low + v * high)


@compiled
def _steepest_descent(value: Field, x: float, y: float) -> tuple[float, float]:
    """Return the direction of steepest descent at a point, from the cells around it."""
    column = math.floor(x)
    row = math.floor(y)
    dx = dy = 0.0
    for j in range(2):
        for i in range(2):
            weight = abs(1 - i - (x - column)) * abs(1 - j - (y - row))
            cx, cy = column + i, row + j
            if weight <= 0.0 or cx < 0 or cy < 0 or cx >= value.shape[1] or cy >= value.shape[0]:
                continue
            here = value[cy, cx]
            if here == np.inf:
                continue
            gx = _slope(_value(value, cx - 1, cy), here, _value(value, cx + 1, cy))
            gy = _slope(_value(value, cx, cy - 1), here, _value(value, cx, cy + 1))
            norm = math.hypot(gx, gy)
            if norm > 0.0:
                dx += weight * gx / norm
                dy += weight * gy / norm
    return dx, dy


@compiled
def _value(value: Field, column: int, row: int) -> np.float32:
    """Return the value of a cell, infinite outside of the grid."""
    if 0 <= column < value.shape[1] and 0 <= row < value.shape[0]:
        return np.float32(value[row, column])
    return np.float32(np.inf)


@compiled
def _slope(before: np.float32, here: np.float32, after: np.float32) -> float:
    """Return the descent along one axis: towards the lower neighbour, zero if both are higher."""
    if before < after:
        return float(before - here) if before < here else 0.0
    return float(here - after) if after < here else 0.0


@compiled
def _lowest_neighbour(value: Field, column: int, row: int) -> tuple[float, float, np.float32]:
    """Return centre and value of the lowest of a cell's four neighbours."""
    best = np.float32(np.inf)
    x, y = column, row
    for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        beside = _value(value, column + dx, row + dy)
        if beside < best:
            best = beside
            x, y = column + dx, row + dy
    return float(x), float(y), best


@compiled
def nearest_reached(value: Field, column: int, row: int, reach: float) -> tuple[int, int]:
    """Return the nearest cell with a finite value within a distance in cells; (-1, -1) if there is none.

    The nearest, or one hardly farther off that costs less to get to: between two sides of an obstacle the
    choice must not change with every scan.
    """
    radius = math.floor(reach)
    best = np.inf
    found_column = found_row = -1
    for y in range(max(row - radius, 0), min(row + radius + 1, value.shape[0])):
        for x in range(max(column - radius, 0), min(column + radius + 1, value.shape[1])):
            d = math.hypot(x - column, y - row)
            if d > reach + 1e-6 or value[y, x] == np.inf:
                continue
            price = d + MAX_DETOUR_RATIO * value[y, x]
            if price < best:
                best = price
                found_column, found_row = x, y
    return found_column, found_row


@compiled
def nearest_passable_cell(costs: Costs, step: Field, column: int, row: int, reach: float) -> tuple[int, int]:
    """Return the nearest passable cell connected to a blocked cell; (-1, -1) if there is none.

    From inside of the inscribed radius the way leads over inscribed cells only, at any distance; from inside
    of an obstacle over anything, within a distance in cells.
    """
    height, width = costs.shape
    inside = costs[row, column] != INSCRIBED_INFLATED_OBSTACLE
    seen = np.zeros((height, width), dtype=np.bool_)
    queue = np.empty((height * width, 2), dtype=np.int32)
    queue[0, 0] = column
    queue[0, 1] = row
    seen[row, column] = True
    taken, waiting = 0, 1
    best = np.inf
    found_column = found_row = -1
    while taken < waiting:
        x, y = queue[taken, 0], queue[taken, 1]
        taken += 1
        d = math.hypot(x - column, y - row)
        if d > best or (inside and d > reach):
            continue
        if step[costs[y, x]] < np.inf:
            best = d
            found_column, found_row = x, y
            continue
        if not inside and costs[y, x] != INSCRIBED_INFLATED_OBSTACLE:
            continue
        for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            cx, cy = x + dx, y + dy
            if 0 <= cx < width and 0 <= cy < height and not seen[cy, cx]:
                seen[cy, cx] = True
                queue[waiting, 0] = cx
                queue[waiting, 1] = cy
                waiting += 1
    return found_column, found_row
