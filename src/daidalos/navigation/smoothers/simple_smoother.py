"""Iterative smoother: each point moves between its original position and the mean of its neighbours."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Smoother
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, NO_INFORMATION, Costmap, Costs
from daidalos.navigation.smoothers.parts import smooth_parts


@dataclass(frozen=True)
class SimpleSmootherParameters(Parameters):
    """Parameters of the smoother, by their Nav2 names."""

    tolerance: float = parameter(1e-10, "Change of the path at which smoothing ends.", unit="m", minimum=0.0)
    max_its: int = parameter(1000, "Largest number of iterations.", minimum=1)
    w_data: float = parameter(0.2, "Weight of staying near the path.", minimum=0.0)
    w_smooth: float = parameter(0.3, "Weight of smoothness.", minimum=0.0)
    do_refinement: bool = parameter(True, "Whether the smoothed path is smoothed again.")
    refinement_num: int = parameter(2, "How often it is smoothed again.", minimum=0)
    enforce_path_inversion: bool = parameter(True, "Whether the places where the robot reverses stay where they are.")


class SimpleSmoother(Smoother):
    """Smoother that minimizes squared displacements of points and squared second differences.

    A point stays where it is when its next place is one where the robot must not be.
    """

    names = ("nav2_smoother::SimpleSmoother",)
    Parameters = SimpleSmootherParameters
    parameters: SimpleSmootherParameters

    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Implement `Smoother.smooth`."""
        p = self.parameters

        def smooth(points: Array) -> Array:
            return relax(
                points, costmap.costs, costmap.resolution, costmap.origin, p.w_data, p.w_smooth, p.tolerance, p.max_its
            )

        times = 1 + p.refinement_num if p.do_refinement else 1
        return smooth_parts(path, smooth, split=p.enforce_path_inversion, times=times)


@compiled
def relax(
    points: Array,
    costs: Costs,
    resolution: float,
    origin: Array,
    w_data: float,
    w_smooth: float,
    tolerance: float,
    max_its: int,
) -> Array:
    """Move inner points by `w_data (given - here) + w_smooth (before + after - 2 here)` until convergence."""
    moved = points.copy()
    for _ in range(max_its):
        change = 0.0
        for i in range(1, points.shape[0] - 1):
            step = w_data * (points[i] - moved[i]) + w_smooth * (moved[i - 1] + moved[i + 1] - 2.0 * moved[i])
            there = moved[i] + step
            column = int(np.floor((there[0] - origin[0]) / resolution))
            row = int(np.floor((there[1] - origin[1]) / resolution))
            if 0 <= row < costs.shape[0] and 0 <= column < costs.shape[1]:
                cost = costs[row, column]
                if cost >= INSCRIBED_INFLATED_OBSTACLE and cost != NO_INFORMATION:
                    continue
            moved[i] = there
            change += step[0] * step[0] + step[1] * step[1]
        if change < tolerance:
            break
    return moved
