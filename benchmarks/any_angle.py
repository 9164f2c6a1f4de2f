"""Lengths of Theta*'s paths beside the shortest ones at any angle, on maps like those of MovingAI's benchmarks.

The shortest paths lead over the outer corners of obstacles: Dijkstra's algorithm over all of them that see each other,
which shares nothing with the planner but the rule of which cells a line crosses.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners.grid_search import line_price
from daidalos.navigation.planners.search import prices
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner, ThetaStarPlannerParameters

SIZE = 64
PAIRS = 12
SEEDS = range(3)
BESIDE = 1e-3
"""Distance [cells] from the corner of an obstacle at which the shortest path passes it."""

PRICE = prices(1.0, 0.0, quadratic=True, allow_unknown=False)


def run() -> dict[str, float | str]:
    """Plan on rooms, on random obstacles and on streets."""
    results: dict[str, float | str] = {}
    for name, draw in (("rooms", rooms), ("random_10", lambda s: scattered(s, 0.1)), ("streets", streets)):
        excess = np.array([one for seed in SEEDS for one in excesses(draw(np.random.default_rng(seed)), seed)])
        results[f"any_angle.{name}_mean_excess_percent"] = float(100.0 * excess.mean())
        results[f"any_angle.{name}_largest_excess_percent"] = float(100.0 * excess.max())
    return results


def excesses(blocked: np.ndarray, seed: int) -> list[float]:
    """Return by what share the planner's paths between random cells are longer than the shortest ones."""
    costmap = Costmap(np.where(blocked, 254, 0).astype(np.uint8), 1.0, (0.0, 0.0))
    planner = ThetaStarPlanner(ThetaStarPlannerParameters(w_traversal_cost=0.0))
    stream = np.random.default_rng(seed)
    free = np.argwhere(~blocked)[:, ::-1].astype(float)
    found = []
    while len(found) < PAIRS:
        start, goal = free[stream.integers(len(free), size=2)]
        shortest = shortest_length(costmap, start, goal)
        if not np.isfinite(shortest) or shortest < 10.0:
            continue
        try:
            path = planner.create_plan(costmap, np.array([*start + 0.5, 0.0]), np.array([*goal + 0.5, 0.0]))
        except NavigationError:
            found.append(np.inf)
            continue
        found.append(path_length(path) / shortest - 1.0)
    return found


def shortest_length(costmap: Costmap, start: np.ndarray, goal: np.ndarray) -> float:
    """Return the length of the shortest path at any angle; infinite where there is none."""
    free = costmap.costs == 0
    height, width = free.shape
    padded = np.pad(free, 1)
    corners = []
    for i, j in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        diagonal = padded[1 + i : 1 + i + height, 1 + j : 1 + j + width]
        beside = padded[1 + i : 1 + i + height, 1 : 1 + width] & padded[1 : 1 + height, 1 + j : 1 + j + width]
        cells = np.argwhere(free & ~diagonal & beside)[:, ::-1].astype(float)
        corners.append(cells + (0.5 - BESIDE) * np.array([j, i]))
    points = np.concatenate([[start, goal], *corners])
    rows, columns, lengths = [], [], []
    for a in range(len(points)):
        for b in range(a + 1, len(points)):
            if np.isfinite(line_price(costmap.costs, PRICE, *points[a], *points[b])):
                rows.append(a)
                columns.append(b)
                lengths.append(float(np.hypot(*(points[a] - points[b]))))
    graph = coo_matrix((lengths, (rows, columns)), (len(points), len(points))).tocsr()
    return float(dijkstra(graph, directed=False, indices=0)[1])


def rooms(stream: np.random.Generator) -> np.ndarray:
    """Return rooms of 8 x 8 cells with a door in most walls."""
    blocked = np.zeros((SIZE, SIZE), dtype=bool)
    blocked[::8], blocked[:, ::8] = True, True
    for row in range(0, SIZE, 8):
        for column in range(0, SIZE, 8):
            if row and stream.random() < 0.8:
                blocked[row, column + stream.integers(1, 7)] = False
            if column and stream.random() < 0.8:
                blocked[row + stream.integers(1, 7), column] = False
    return blocked


def scattered(stream: np.random.Generator, share: float) -> np.ndarray:
    """Return random blocked cells."""
    return stream.random((SIZE, SIZE)) < share


def streets(stream: np.random.Generator) -> np.ndarray:
    """Return blocks of houses."""
    blocked = np.zeros((SIZE, SIZE), dtype=bool)
    for row in range(2, SIZE - 6, 10):
        for column in range(2, SIZE - 6, 10):
            blocked[row : row + stream.integers(4, 9), column : column + stream.integers(4, 9)] = True
    return blocked


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:<50} {value if isinstance(value, str) else format(value, '.4g')}")
