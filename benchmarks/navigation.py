"""How fast navigation is, and how well a robot drives: the time of the parts, an arena, BARN."""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.cli.daidalos.bench_barn import summarize
from daidalos.common.kernels import warm_up
from daidalos.navigation.contracts import ControlInput, NavigationContext
from daidalos.navigation.controllers.dwb_controller import DwbController, DwbParameters
from daidalos.navigation.controllers.mppi_controller import MppiController, MppiParameters
from daidalos.navigation.controllers.regulated_pure_pursuit_controller import RegulatedPurePursuitController
from daidalos.navigation.controllers.teb_controller import TebController, TebParameters
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import LayeredCostmap
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from daidalos.navigation.costmap.layers.obstacle_layer import Observation, ObstacleLayer
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners.navfn_planner import NavfnPlanner, NavfnPlannerParameters
from daidalos.navigation.planners.smac_planner_2d import SmacPlanner2D
from daidalos.navigation.planners.smac_planner_hybrid import SmacPlannerHybrid, SmacPlannerHybridParameters
from daidalos.navigation.planners.smac_planner_lattice import SmacPlannerLattice
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner
from daidalos.testing.barn import BarnPlan, cross, read_worlds
from daidalos.testing.fleet import run_here

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.navigation.closed_loop import free_pose, turtlebot
from tests.navigation.flat_world import FlatWorld, arena

DATA = Path(os.environ.get("DAIDALOS_SHARED_DATA", Path(__file__).parents[2] / "shared" / "data")) / "barn"
ROBOT = Footprint.circle(0.22)
WAFFLE = DwbParameters(
    max_vel_x=0.26,
    max_speed_xy=0.26,
    max_vel_theta=1.0,
    acc_lim_x=2.5,
    acc_lim_theta=3.2,
    decel_lim_x=-2.5,
    decel_lim_theta=-3.2,
    linear_granularity=0.05,
)
"""Limits of Nav2's default file of Humble."""


def run() -> dict[str, float | str]:
    """Measure everything; times are medians."""
    start = time.perf_counter()
    warm_up("daidalos.navigation")
    results: dict[str, float | str] = {"navigation.warm_up_s": time.perf_counter() - start}
    results |= measure_planner() | measure_planners() | measure_costmaps() | measure_controllers()
    results |= measure_arena("mppi") | measure_arena("rpp")
    return results | measure_barn(range(0, 100, 4))


def measure_planner() -> dict[str, float | str]:
    """From corner to corner of random rooms, so that nearly every cell is visited."""
    results: dict[str, float | str] = {}
    for name, height, width in (("32k", 160, 200), ("150k", 380, 395), ("250k", 500, 500), ("350k", 590, 593)):
        costmap = rooms(height, width)
        free = np.argwhere(costmap.costs == 0)
        start, goal = (np.array([*costmap.map_to_world(*cell[::-1]), 0.0]) for cell in (free[0], free[-1]))
        for kind, use_astar in (("", False), ("_astar", True)):
            planner = NavfnPlanner(NavfnPlannerParameters(use_astar=use_astar))
            milliseconds = median_ms(lambda _, p=planner, c=costmap, s=start, g=goal: p.create_plan(c, s, g))
            results[f"navigation.navfn{kind}_{name}_ms"] = milliseconds
        results[f"navigation.navfn_{name}_path_m"] = path_length(NavfnPlanner().create_plan(costmap, start, goal))
    return results


def measure_planners() -> dict[str, float | str]:
    """NavFn on a million cells, the others on 147,000 and on a path of 75 m; goals of 15, 20 and 60 ms."""
    results: dict[str, float | str] = {}
    hybrid = SmacPlannerHybrid(SmacPlannerHybridParameters(motion_model_for_search="REEDS_SHEPP"))
    for name, height, width, planner in (
        ("navfn_1m", 1000, 1000, NavfnPlanner()),
        ("theta_star_147k", 380, 387, ThetaStarPlanner()),
        ("smac_2d_147k", 380, 387, SmacPlanner2D()),
        ("smac_hybrid_dubins_147k", 380, 387, SmacPlannerHybrid()),
        ("smac_hybrid_reeds_shepp_147k", 380, 387, hybrid),
        ("smac_lattice_147k", 380, 387, SmacPlannerLattice()),
        ("smac_lattice_75m", 1000, 1100, SmacPlannerLattice()),
        ("smac_hybrid_dubins_75m", 1000, 1100, SmacPlannerHybrid()),
        ("smac_hybrid_reeds_shepp_75m", 1000, 1100, hybrid),
    ):
        costmap = rooms(height, width)
        free = np.argwhere(costmap.costs == 0)
        start, goal = (np.array([*costmap.map_to_world(*cell[::-1]), 0.0]) for cell in (free[0], free[-1]))
        milliseconds = median_ms(lambda _, p=planner, c=costmap, s=start, g=goal: p.create_plan(c, s, g), count=9)
        results[f"navigation.{name}_ms"] = milliseconds
        results[f"navigation.{name}_path_m"] = path_length(planner.create_plan(costmap, start, goal))
    return results


def measure_costmaps() -> dict[str, float | str]:
    """Inflation of a whole map, and updates of a robot's costmaps with a new scan of 820 beams each time."""
    bare = rooms(500, 500, inflated=False)
    inflation = InflationLayer(InflationLayerParameters(0.55, 4.0), NavigationContext(footprint=Footprint.circle(0.22)))
    world = arena()
    stack = turtlebot(world, [1.5, 1.5, 0.0], world)

    def update(costmap: LayeredCostmap, seen: Observation) -> None:
        stack.time += 0.2
        obstacles_of(costmap).add_observation(seen)
        costmap.update(stack.robot.pose, stack.time)

    def look() -> Observation:
        return Observation.from_scan(stack.robot.scan(), stack.robot.pose, stack.time)

    return {
        "navigation.inflation_250k_ms": median_ms(lambda c: inflation.update_costs(c, c.window), bare.copy),
        "navigation.local_costmap_update_ms": median_ms(lambda seen: update(stack.local_costmap, seen), look),
        "navigation.global_costmap_update_ms": median_ms(lambda seen: update(stack.global_costmap, seen), look),
        "navigation.rays_of_scan_ms": median_ms(lambda _: look()),
    }


def measure_controllers() -> dict[str, float | str]:
    """One cycle of each controller on a path through an inflated room."""
    costmap = rooms(60, 60, boxes=0)
    pose = np.array([*costmap.map_to_world(30, 30), 0.0])
    path = pose + np.stack([np.linspace(0.0, 1.2, 25), np.linspace(0.0, 0.3, 25), np.zeros(25)], axis=-1)
    control = ControlInput(pose, np.array([0.3, 0.0, 0.1]), path, path[-1], 3.0, costmap)
    context = NavigationContext(footprint=ROBOT)
    mppi, large, pursuit, window = (
        MppiController(None, context),
        MppiController(MppiParameters(batch_size=2000), context),
        RegulatedPurePursuitController(None, context),
        DwbController(WAFFLE, context),
    )
    band = TebController(TebParameters(min_obstacle_dist=0.2), context)
    return {
        "navigation.mppi_cycle_1000x56_ms": median_ms(lambda _: mppi.compute_velocity_commands(control), count=100),
        "navigation.mppi_cycle_2000x56_ms": median_ms(lambda _: large.compute_velocity_commands(control), count=100),
        "navigation.dwb_cycle_ms": median_ms(lambda _: window.compute_velocity_commands(control), count=100),
        "navigation.teb_cycle_ms": median_ms(lambda _: band.compute_velocity_commands(control), count=100),
        "navigation.pure_pursuit_cycle_ms": median_ms(lambda _: pursuit.compute_velocity_commands(control), count=100),
    }


def measure_arena(kind: str) -> dict[str, float | str]:
    """Random goals in an arena whose map lacks the furniture, with the default behaviour tree."""
    world = arena()
    walls = FlatWorld(world.segments[:32], world.circles[:0])
    generator = np.random.default_rng(11)
    stack = turtlebot(world, free_pose(world, generator), walls, 11, kind)
    begun = time.perf_counter()
    arrivals = [stack.drive_to(free_pose(world, generator)) for _ in range(25)]
    wall_time = time.perf_counter() - begun
    return {
        f"navigation.arena_{kind}_success": statistics.mean(a.reached for a in arrivals),
        f"navigation.arena_{kind}_contacts": float(sum(a.contact for a in arrivals)),
        f"navigation.arena_{kind}_mean_time_s": statistics.mean(a.time for a in arrivals),
        f"navigation.arena_{kind}_mean_speed_mps": sum(a.length for a in arrivals) / sum(a.time for a in arrivals),
        f"navigation.arena_{kind}_min_clearance_m": min(a.min_clearance for a in arrivals),
        f"navigation.arena_{kind}_largest_error_m": max(a.position_error for a in arrivals),
        f"navigation.arena_{kind}_largest_error_rad": max(a.yaw_error for a in arrivals),
        f"navigation.arena_{kind}_real_time_factor": sum(a.time for a in arrivals) / wall_time,
    }


def measure_barn(numbers: range) -> dict[str, float | str]:
    """Worlds of the BARN benchmark in lock-step, as `daidalos bench barn` tries them; the best score is 0.25."""
    file = DATA / "barn_000_099.npz"
    if not file.is_file():
        return {"navigation.barn": f"no worlds at {file}"}
    worlds, plan = read_worlds(file), BarnPlan(file)
    with tempfile.TemporaryDirectory() as name:
        chosen = [worlds[number] for number in numbers]
        records = list(run_here(chosen, lambda process, world: cross(process, world, plan, Path(name)), 1))
    summary = summarize(records)
    return {
        "navigation.barn_worlds": float(summary["worlds"]),
        "navigation.barn_reached_percent": 100.0 * summary["success_rate"],
        "navigation.barn_contacts": float(summary["contacts"]),
        "navigation.barn_score": summary["score"],
        "navigation.barn_strict_score": summary["strict_score"],
        "navigation.barn_mean_time_s": summary["mean_time_s"],
    }


def rooms(height: int, width: int, boxes: int | None = None, *, inflated: bool = True) -> Costmap:
    """Return a walled hall with random boxes at 5 cm."""
    generator = np.random.default_rng(1)
    costs = np.zeros((height, width), dtype=np.uint8)
    costs[0] = costs[-1] = 254
    costs[:, 0] = costs[:, -1] = 254
    for _ in range(height * width // 3000 if boxes is None else boxes):
        row, column = generator.integers(0, (height - 20, width - 20))
        tall, wide = generator.integers(2, 18, 2)
        costs[row : row + tall, column : column + wide] = 254
    costmap = Costmap(costs, 0.05, (0.0, 0.0))
    if inflated:
        InflationLayer(
            InflationLayerParameters(0.55, 4.0), NavigationContext(footprint=Footprint.circle(0.22))
        ).update_costs(costmap, costmap.window)
    return costmap


def obstacles_of(costmap: LayeredCostmap) -> ObstacleLayer:
    return next(layer for layer in costmap.layers if isinstance(layer, ObstacleLayer))


def median_ms(work: Callable[[Any], object], prepare: Callable[[], Any] = lambda: None, count: int = 30) -> float:
    """Median time of some work; what is prepared for it does not count."""
    times = []
    for _ in range(count + 2):
        prepared = prepare()
        begun = time.perf_counter()
        work(prepared)
        times.append(time.perf_counter() - begun)
    return 1e3 * statistics.median(times[2:])


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:<50} {value if isinstance(value, str) else format(value, '.4g')}")
