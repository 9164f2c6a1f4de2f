"""Smac State Lattice planner: paths put together from the motions of a file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, group, parameter
from daidalos.navigation.contracts import GlobalPlanner, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import GoalOccupied, NoPath, StartOccupied
from daidalos.navigation.planners.cost_to_go import CostsToGoal
from daidalos.navigation.planners.goal_curves import stands_free
from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.lattice_motions import LatticeMotions
from daidalos.navigation.planners.lattice_search import LatticeSearch, LatticeSearchOptions
from daidalos.navigation.planners.path_smoothing import smoothed, smoothed_at_headings
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, Prices, prices, run_search
from daidalos.navigation.planners.smac_parameters import GoalHeadings, PathSmoothing
from daidalos.navigation.planners.state_lattice import LatticeError, StateLattice, read_lattice
from daidalos.navigation.planners.terminals import goal_cell, start_cell, words

TABLE_BINS = 72
"""Headings of the table of curves' lengths."""


@dataclass(frozen=True)
class SmacPlannerLatticeParameters(GoalHeadings):
    """Parameters of the planner, by their Nav2 names."""

    lattice_filepath: str = parameter(
        "", "File of the motions; those of a car that turns on 0.5 m, on cells of 0.05 m, where empty."
    )
    tolerance: float = parameter(
        0.25, "Distance to the goal within which another pose may take its place.", unit="m", minimum=0.0
    )
    allow_unknown: bool = parameter(True, "Whether paths may cross unknown cells.")
    max_iterations: int = parameter(1_000_000, "Poses that may be expanded; 0 or less for any number.")
    max_on_approach_iterations: int = parameter(
        1000, "Poses that are expanded within the tolerance before the nearest one is taken.", minimum=0
    )
    terminal_checking_interval: int = parameter(
        5000, "Expansions between two looks at the clock and for a cancellation.", minimum=1
    )
    max_planning_time: float = parameter(5.0, "Longest time of a search; 0 or less for any.", unit="s")
    allow_reverse_expansion: bool = parameter(False, "Whether motions are driven backwards as well.")
    reverse_penalty: float = parameter(2.0, "Factor of the cost of driving backwards.", minimum=1.0)
    change_penalty: float = parameter(0.05, "Added to the factor of a turn to the other side.", minimum=0.0)
    non_straight_penalty: float = parameter(1.05, "Factor of the cost of a turn.", minimum=1.0)
    cost_penalty: float = parameter(2.0, "Weight of the costs along the path beside its length.", minimum=0.0)
    rotation_penalty: float = parameter(
        5.0, "Cost of a turn in place to the next heading, in lengths of a cell.", minimum=0.0
    )
    retrospective_penalty: float = parameter(
        0.015,
        "What each step is cheaper by, so that turns come late and the search is quicker.",
        minimum=0.0,
        below=1.0,
    )
    use_quadratic_cost_penalty: bool = parameter(False, "Whether costs count by their squares.")
    analytic_expansion_ratio: float = parameter(
        3.5, "How much more often curves to the goal are tried as it gets near.", minimum=1.0
    )
    analytic_expansion_max_length: float = parameter(3.0, "Longest curve to the goal.", unit="m", above=0.0)
    analytic_expansion_max_cost: float = parameter(200.0, "Highest cost under a curve to the goal.", minimum=0.0)
    analytic_expansion_max_cost_override: bool = parameter(
        False, "Whether curves within a full turn of the goal may have any cost."
    )
    lookup_table_size: float = parameter(
        20.0, "Edge of the area in which the turning radius is estimated.", unit="m", above=0.0
    )
    cache_obstacle_heuristic: bool = parameter(
        False,
        "Whether estimates of the costs to a goal are kept for the next plan to it, though costs may have changed.",
    )
    downsample_obstacle_heuristic: bool = parameter(True, "Whether these estimates are over cells twice as large.")
    smooth_path: bool = parameter(True, "Whether the path is smoothed.")
    smoother: PathSmoothing = group(PathSmoothing)


class SmacPlannerLattice(GlobalPlanner):
    """Planner by A* over a state lattice, which is laid through the start.

    The robot's footprint touches nothing along the path, and the path keeps to the lattice's turning radius, smoothed
    or not. It ends at the goal, or within a cell and half of the angle between headings of it where no curve fits.
    """

    names = ("nav2_smac_planner::SmacPlannerLattice",)
    Parameters = SmacPlannerLatticeParameters
    parameters: SmacPlannerLatticeParameters

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._lattice = _lattice_of(self.parameters)
        self._table: tuple[Any, Prices] | None = None
        self._rest = self._kept_costs()

    def reconfigure(self, parameters: Any) -> None:
        """Implement `NavigationExtension.reconfigure`."""
        self._lattice = _lattice_of(parameters)
        super().reconfigure(parameters)
        self._rest = self._kept_costs()

    def _kept_costs(self) -> CostsToGoal:
        p = self.parameters
        return CostsToGoal(is_kept=p.cache_obstacle_heuristic, is_downsampled=p.downsample_obstacle_heuristic)

    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path; see `GlobalPlanner.create_plan`."""
        p = self.parameters
        first, last = start_cell(costmap, start), goal_cell(costmap, goal)
        price = prices(1.0, p.cost_penalty, quadratic=p.use_quadratic_cost_penalty, allow_unknown=p.allow_unknown)
        footprint = self.context.footprint
        polygon = np.empty((0, 2)) if footprint.circular else footprint.polygon / costmap.resolution
        begin, end = (
            np.array([*((pose[:2] - costmap.origin) / costmap.resolution - 0.5), pose[2]]) for pose in (start, goal)
        )
        if not stands_free(costmap.costs, price, polygon, *begin):
            raise StartOccupied(f"the robot at {words(start)} touches an obstacle, so that it is enclosed by it")
        goals = p.goals(end, self._lattice.headings.size)
        is_free = any(stands_free(costmap.costs, price, polygon, *one) for one in goals)
        if not is_free and p.tolerance < costmap.resolution:
            raise GoalOccupied(f"the robot does not fit at the goal {words(goal)}")
        reach = float(np.hypot(*polygon.T).max()) if polygon.size else 0.0
        motions = LatticeMotions(
            self._lattice, float(start[2]), costmap.resolution, reach, is_reverse_allowed=p.allow_reverse_expansion
        )
        options = self._options(costmap.resolution)
        factor = self._rest.factor
        rest = self._rest.compute(costmap, price, first, last, reach=options.reach, margin=4.0 * options.radius)
        search = LatticeSearch(costmap.costs, price, polygon, rest, factor, begin, goals, motions, options)
        state = EXHAUSTED
        if np.isfinite(rest[first[1] // factor, first[0] // factor]):
            state = run_search(
                search.advance,
                p.terminal_checking_interval,
                self.is_cancelled,
                max_iterations=p.max_iterations,
                max_planning_time=p.max_planning_time,
            )
        if state != FOUND:
            kind = NoPath if is_free else GoalOccupied
            raise kind(f"no way of the lattice leads to the goal {words(goal)} or within {p.tolerance} m of it")
        path = search.path()
        if p.smooth_path:
            smooth = smoothed_at_headings if options.is_holonomic else smoothed
            path = smooth(path, costmap.costs, price, polygon, options.radius, p.smoother, costmap.resolution)
        path[:, :2] = costmap.origin + (path[:, :2] + 0.5) * costmap.resolution
        path[:, 2] = np.remainder(path[:, 2] + np.pi, 2.0 * np.pi) - np.pi
        return path

    def _options(self, resolution: float) -> LatticeSearchOptions:
        p = self.parameters
        radius = max(self._lattice.turning_radius / resolution, 1.0)
        edge = 2 * math.ceil(0.5 * p.lookup_table_size / resolution) + 1
        key = (edge, radius, p.allow_reverse_expansion)
        if self._table is None or self._table[0] != key:
            self._table = key, np.zeros((edge, edge // 2 + 1, TABLE_BINS), dtype=np.float32)
        return LatticeSearchOptions(
            radius, p.allow_reverse_expansion, self._lattice.motion_model == "omni", p.reverse_penalty,
            p.change_penalty, p.non_straight_penalty, p.rotation_penalty, p.retrospective_penalty,
            p.analytic_expansion_ratio, p.analytic_expansion_max_length / resolution, p.analytic_expansion_max_cost,
            p.analytic_expansion_max_cost_override, p.coarse_search_resolution, p.tolerance / resolution,
            p.max_on_approach_iterations, any(one.length == 0.0 for one in self._lattice.primitives), self._table[1],
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
