"""Smac State Lattice planner: paths put together from the motions of a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.parameters import ParameterError, parameter
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.lattice_motions import LatticeMotions
from daidalos.navigation.planners.lattice_search import LatticeSearch, LatticeSearchOptions
from daidalos.navigation.planners.path_smoothing import smoothed, smoothed_at_headings
from daidalos.navigation.planners.pose_search_planner import PoseSearchParameters, PoseSearchPlanner, Terrain
from daidalos.navigation.planners.search import Prices
from daidalos.navigation.planners.state_lattice import LatticeError, StateLattice, read_lattice

TABLE_BINS = 72
"""Headings of the table of curves' lengths."""


@dataclass(frozen=True)
class SmacPlannerLatticeParameters(PoseSearchParameters):
    """Parameters of the planner, by their Nav2 names."""

    lattice_filepath: str = parameter(
        "", "File of the motions; those of a car that turns on 0.5 m, on cells of 0.05 m, where empty."
    )
    allow_reverse_expansion: bool = parameter(False, "Whether motions are driven backwards as well.")
    change_penalty: float = parameter(0.05, "Added to the factor of a turn to the other side.", minimum=0.0)
    non_straight_penalty: float = parameter(1.05, "Factor of the cost of a turn.", minimum=1.0)
    rotation_penalty: float = parameter(
        5.0, "Cost of a turn in place to the next heading, in lengths of a cell.", minimum=0.0
    )


class SmacPlannerLattice(PoseSearchPlanner):
    """Planner by A* over a state lattice, which is laid through the start.

    The robot's footprint touches nothing along the path, and the path keeps to the lattice's turning radius, smoothed
    or not. It ends at the goal, or within a cell and half of the angle between headings of it where no curve fits.
    """

    names = ("nav2_smac_planner::SmacPlannerLattice",)
    Parameters = SmacPlannerLatticeParameters
    parameters: SmacPlannerLatticeParameters

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._use(_lattice_of(self.parameters))

    def reconfigure(self, parameters: Any) -> None:
        """Implement `NavigationExtension.reconfigure`."""
        lattice = _lattice_of(parameters)
        super().reconfigure(parameters)
        self._use(lattice)

    def _use(self, lattice: StateLattice) -> None:
        self._lattice = lattice
        self.smooth = smoothed_at_headings if lattice.motion_model == "omni" else smoothed

    @property
    def heading_count(self) -> int:
        """Implement `PoseSearchPlanner.heading_count`."""
        return int(self._lattice.headings.size)

    def _no_way(self, goal: str) -> str:
        return f"no way of the lattice leads to the goal {goal} or within {self.parameters.tolerance} m of it"

    def _search(self, terrain: Terrain, rest: Prices, factor: int, options: LatticeSearchOptions) -> LatticeSearch:
        costmap, price, polygon, start, goals = terrain
        reach = float(np.hypot(*polygon.T).max()) if polygon.size else 0.0
        is_reverse_allowed = self.parameters.allow_reverse_expansion
        motions = LatticeMotions(
            self._lattice, float(start[2]), costmap.resolution, reach, is_reverse_allowed=is_reverse_allowed
        )
        return LatticeSearch(costmap.costs, price, polygon, rest, factor, start, goals, motions, options)

    def _options(self, resolution: float) -> LatticeSearchOptions:
        p = self.parameters
        radius = max(self._lattice.turning_radius / resolution, 1.0)
        lengths = self._lengths(resolution, TABLE_BINS, radius, p.allow_reverse_expansion)
        return LatticeSearchOptions(
            radius, p.allow_reverse_expansion, self._lattice.motion_model == "omni", p.reverse_penalty,
            p.change_penalty, p.non_straight_penalty, p.rotation_penalty, p.retrospective_penalty,
            p.analytic_expansion_ratio, p.analytic_expansion_max_length / resolution, p.analytic_expansion_max_cost,
            p.analytic_expansion_max_cost_override, p.coarse_search_resolution, p.tolerance / resolution,
            p.max_on_approach_iterations, any(one.length == 0.0 for one in self._lattice.primitives), lengths,
        )  # fmt: skip


def _lattice_of(parameters: SmacPlannerLatticeParameters) -> StateLattice:
    """Return the lattice that the parameters name.

    Raises
    ------
    ParameterError
        Its file cannot be read, or its motions cannot be driven backwards as they should.
    """
    file = parameters.lattice_filepath
    try:
        lattice = read_lattice(file) if file else generate_lattice(LatticeOptions())
    except LatticeError as error:
        raise ParameterError("lattice_filepath", f"names a file that cannot be used: {error}") from None
    if parameters.allow_reverse_expansion and not lattice.is_symmetric:
        raise ParameterError("allow_reverse_expansion", f"needs opposite headings, which '{file}' has not")
    return lattice
