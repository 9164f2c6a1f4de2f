"""Parameters of all Smac planners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.costmap.costmap import Costmap


@dataclass(frozen=True)
class PathSmoothing(Parameters):
    """Parameters of the smoothing of a planner's paths, by their Nav2 names."""

    max_iterations: int = parameter(1000, "Largest number of iterations.", minimum=1)
    w_smooth: float = parameter(0.3, "Weight of smoothness.", minimum=0.0)
    w_data: float = parameter(0.2, "Weight of staying near the path.", minimum=0.0)
    tolerance: float = parameter(1e-10, "Change of the path at which smoothing ends.", minimum=0.0)
    do_refinement: bool = parameter(True, "Whether the smoothed path is smoothed again.")
    refinement_num: int = parameter(2, "How often it is smoothed again.", minimum=0)

    @property
    def times(self) -> int:
        """How often a path is smoothed."""
        return 1 + self.refinement_num if self.do_refinement else 1


def downsampled(costmap: Costmap, factor: int) -> Costmap:
    """Return a costmap of cells `factor` times as large, each with the highest cost in it; unknown only if all is."""
    if factor == 1:
        return costmap
    height, width = -(-costmap.height // factor), -(-costmap.width // factor)
    costs = np.full((height * factor, width * factor), 255, dtype=np.uint8)
    costs[: costmap.height, : costmap.width] = costmap.costs
    costs += np.uint8(1)  # unknown becomes the lowest
    blocks = costs.reshape(height, factor, width, factor).max(axis=(1, 3)) - np.uint8(1)
    return Costmap(blocks, costmap.resolution * factor, costmap.origin)


@dataclass(frozen=True)
class GoalHeadings(Parameters):
    """Parameters of the headings at which paths of planners over poses may end, by their Nav2 names."""

    goal_heading_mode: str = parameter(
        "DEFAULT",
        "Whether the path ends at the goal's heading, at this or its opposite, or at any.",
        choices=("DEFAULT", "BIDIRECTIONAL", "ALL_DIRECTION"),
    )
    coarse_search_resolution: int = parameter(
        1, "With any heading: how many headings on is the next that curves to the goal are tried to first.", minimum=1
    )

    def goals(self, goal: Array, headings: int) -> Array:
        """Return the goal (3,) at each heading (n, 3) that the path may end at, of so many in a full turn."""
        count = {"DEFAULT": 1, "BIDIRECTIONAL": 2}.get(self.goal_heading_mode, headings)
        goals = np.repeat(goal[None], count, axis=0)
        goals[:, 2] += 2.0 * np.pi * np.arange(count) / count
        return goals
