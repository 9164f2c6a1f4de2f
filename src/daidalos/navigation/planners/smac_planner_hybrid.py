"""Smac Hybrid-A* planner: paths that a robot with a turning radius can drive."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.planners.hybrid_search import HybridOptions, HybridSearch
from daidalos.navigation.planners.pose_search_planner import PoseSearchParameters, PoseSearchPlanner, Terrain
from daidalos.navigation.planners.search import Prices
from daidalos.navigation.planners.smac_parameters import downsampled


@dataclass(frozen=True)
class SmacPlannerHybridParameters(PoseSearchParameters):
    """Parameters of the planner, by their Nav2 names."""

    downsample_costmap: bool = parameter(False, "Whether to search over larger cells.")
    downsampling_factor: int = parameter(1, "How many times larger those are.", minimum=1)
    motion_model_for_search: str = parameter(
        "DUBIN", "Whether the robot drives forward only, or both ways.", choices=("DUBIN", "REEDS_SHEPP")
    )
    angle_quantization_bins: int = parameter(72, "Headings of a full turn.", minimum=4)
    minimum_turning_radius: float = parameter(0.4, "Radius of the narrowest turn.", unit="m", above=0.0)
    change_penalty: float = parameter(0.0, "Added to the factor of a turn to another side.", minimum=0.0)
    non_straight_penalty: float = parameter(1.2, "Factor of the cost of a turn.", minimum=1.0)
    allow_primitive_interpolation: bool = parameter(False, "Whether the search has turns wider than the narrowest.")


class SmacPlannerHybrid(PoseSearchPlanner):
    """Planner by Hybrid-A* (Dolgov and others 2008) with Dubins or Reeds-Shepp curves.

    The path keeps to the turning radius, smoothed or not, and the robot's footprint touches nothing along it. It ends
    at the goal, or within a cell and half of the narrowest turn of it where no curve fits.
    """

    names = ("nav2_smac_planner::SmacPlannerHybrid",)
    Parameters = SmacPlannerHybridParameters
    parameters: SmacPlannerHybridParameters

    @property
    def heading_count(self) -> int:
        """Implement `PoseSearchPlanner.heading_count`."""
        return self.parameters.angle_quantization_bins

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        costmap = downsampled(costmap, p.downsampling_factor if p.downsample_costmap else 1)
        return super().create_plan(costmap, start, goal)

    def _no_way(self, goal: str) -> str:
        return f"no way leads to the goal {goal} or within {self.parameters.tolerance} m of it that the robot can drive"

    def _search(self, terrain: Terrain, rest: Prices, factor: int, options: HybridOptions) -> HybridSearch:
        costmap, price, polygon, start, goals = terrain
        return HybridSearch(costmap.costs, price, polygon, rest, factor, start, goals, options)

    def _options(self, resolution: float) -> HybridOptions:
        p = self.parameters
        is_reverse_allowed = p.motion_model_for_search == "REEDS_SHEPP"
        radius = max(p.minimum_turning_radius / resolution, 1.0)
        lengths = self._lengths(resolution, p.angle_quantization_bins, radius, is_reverse_allowed)
        return HybridOptions(
            radius, p.angle_quantization_bins, is_reverse_allowed, p.reverse_penalty, p.change_penalty,
            p.non_straight_penalty, p.retrospective_penalty, p.analytic_expansion_ratio,
            p.analytic_expansion_max_length / resolution, p.analytic_expansion_max_cost,
            p.analytic_expansion_max_cost_override, p.allow_primitive_interpolation, p.coarse_search_resolution,
            p.tolerance / resolution, p.max_on_approach_iterations, lengths,
        )  # fmt: skip
