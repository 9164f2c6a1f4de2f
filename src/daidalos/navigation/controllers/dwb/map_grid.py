"""Distances over the costmap's free cells from some of them, and scores of trajectories by them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.controllers.dwb.trajectories import Trajectories
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, Costmap, Costs

AGGREGATIONS = ("last", "sum", "product")


@dataclass(frozen=True)
class MapGridParameters(Parameters):
    """Parameters of critics by distances over free cells, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    aggregation_type: str = parameter(
        "last", "How the scores of a trajectory's poses are joined.", choices=AGGREGATIONS
    )


def scores(
    trajectories: Trajectories,
    costmap: Costmap,
    targets: Array,
    parameters: MapGridParameters,
    *,
    ahead: float = 0.0,
    stops: bool = True,
) -> Array:
    """Return the weighted score of each trajectory by its distance from some points.

    Parameters
    ----------
    trajectories : Trajectories
    costmap : Costmap
        Inflated costs; cells where the robot's centre must not be, and unknown ones, have no distance.
    targets : ndarray, shape (n, 2)
        Points with distance 0.
    parameters : MapGridParameters
    ahead : float
        Distance [m] before the robot of the point that is scored.
    stops : bool
        Whether a point without a distance makes the trajectory impossible.

    Returns
    -------
    ndarray, shape (n,)
        Infinite where a trajectory is impossible.
    """
    seeds = np.floor((targets - costmap.origin) / costmap.resolution).astype(np.int64).reshape(-1, 2)
    inside = ((seeds >= 0) & (seeds < (costmap.width, costmap.height))).all(axis=1)
    distances = manhattan_distances(costmap.costs, seeds[inside])
    raw = np.empty(trajectories.counts.size)
    score_poses(
        trajectories.poses,
        trajectories.counts,
        distances,
        costmap.resolution,
        costmap.origin,
        ahead,
        AGGREGATIONS.index(parameters.aggregation_type),
        stops,
        raw,
    )
    return parameters.scale * 0.5 * costmap.resolution * raw


@compiled
def manhattan_distances(costs: Costs, seeds: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the number of steps from the nearest of some cells, (columns, rows), over free cells.

    Obstacles have the number of all cells, and what cannot be reached one more.
    """
    height, width = costs.shape
    size = height * width
    distances = np.full((height, width), size + 1, dtype=np.int64)
    queue = np.empty((size, 2), dtype=np.int64)
    end = 0
    for i in range(seeds.shape[0]):
        column, row = seeds[i, 0], seeds[i, 1]
        if distances[row, column] != 0:
            distances[row, column] = 0
            queue[end, 0], queue[end, 1] = column, row
            end += 1
    begin = 0
    while begin < end:
        column, row = queue[begin, 0], queue[begin, 1]
        begin += 1
        for k in range(4):
            c = column + (1 if k == 0 else -1 if k == 1 else 0)
            r = row + (1 if k == 2 else -1 if k == 3 else 0)
            if c < 0 or r < 0 or c >= width or r >= height or distances[r, c] != size + 1:
                continue
            if costs[r, c] >= INSCRIBED_INFLATED_OBSTACLE:
                distances[r, c] = size
                continue
            distances[r, c] = distances[row, column] + 1
            queue[end, 0], queue[end, 1] = c, r
            end += 1
    return distances


@compiled
def score_poses(
    poses: Array,
    counts: NDArray[np.int64],
    distances: NDArray[np.int64],
    resolution: float,
    origin: Array,
    ahead: float,
    aggregation: int,
    stops: bool,
    raw: Array,
) -> None:
    """Write the joined distance of each trajectory's poses; see `scores`."""
    height, width = distances.shape
    size = height * width
    for k in range(poses.shape[0]):
        total = 1.0 if aggregation == 2 else 0.0
        for t in range(counts[k] - 1 if aggregation == 0 and not stops else 0, counts[k]):
            x = poses[k, t, 0] + ahead * np.cos(poses[k, t, 2])
            y = poses[k, t, 1] + ahead * np.sin(poses[k, t, 2])
            column, row = int(np.floor((x - origin[0]) / resolution)), int(np.floor((y - origin[1]) / resolution))
            if column < 0 or row < 0 or column >= width or row >= height:
                total = np.inf
                break
            distance = distances[row, column]
            if stops and distance >= size:
                total = np.inf
                break
            if aggregation == 0:
                total = distance
            elif aggregation == 1:
                total += distance
            elif total > 0.0:
                total *= distance
        raw[k] = total
