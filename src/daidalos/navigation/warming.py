"""Compilation of the kernels of navigation ahead of their first use, those of each plugin by themselves."""

from collections.abc import Callable, Collection, Iterator

import numpy as np

from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import ControlInput, NavigationContext
from daidalos.navigation.controllers.dwb_controller import DwbController, DwbParameters
from daidalos.navigation.controllers.mppi.critics.cost_critic import CostCritic, CostCriticParameters
from daidalos.navigation.controllers.mppi.critics.obstacles_critic import ObstaclesCritic
from daidalos.navigation.controllers.mppi.critics.path_align_legacy_critic import PathAlignLegacyCritic
from daidalos.navigation.controllers.mppi_controller import MppiController, MppiParameters
from daidalos.navigation.controllers.teb_controller import TebController
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer
from daidalos.navigation.costmap.layers.obstacle_layer import ObstacleLayer
from daidalos.navigation.costmap.layers.static_layer import StaticLayer
from daidalos.navigation.costmap.layers.voxel_layer import VoxelLayer
from daidalos.navigation.costmap.observation import Observation
from daidalos.navigation.planners.navfn_planner import NavfnPlanner
from daidalos.navigation.planners.smac_planner_2d import SmacPlanner2D
from daidalos.navigation.planners.smac_planner_hybrid import SmacPlannerHybrid, SmacPlannerHybridParameters
from daidalos.navigation.planners.smac_planner_lattice import SmacPlannerLattice, SmacPlannerLatticeParameters
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner
from daidalos.navigation.smoothers.simple_smoother import SimpleSmoother

OUTLINE = Footprint.of_corners(np.array([[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]))
POSE, GOAL = np.array([1.0, 2.0, 0.0]), np.array([3.0, 2.0, 0.0])
WALLED = np.array([1.0, 0.18, 0.0])
SCAN = LaserScanData(np.array([1.0, np.inf, 1.0]), 0.0, 0.1, 0.1, 10.0)


def steps(users: Collection[type] | None = None) -> Iterator[tuple[float, str]]:
    """Call kernels with data of the types of a real robot; see `daidalos.common.kernels.warm_up`.

    Parameters
    ----------
    users
        Classes of layers, planners, controllers and smoothers, whose kernels follow those of every costmap.
    """
    parts = [kind for kind in _PARTS if users is None or any(issubclass(user, kind) for user in users)]
    yield 0.0, "costmap"
    costmap = _costmap()
    for done, kind in enumerate(parts, 1):
        yield done / (1 + len(parts)), kind.__name__
        _PARTS[kind](costmap)


def _costmap() -> Costmap:
    """Return a costmap of a map, a scan and inflation."""
    data = np.zeros((80, 80), dtype=np.int8)
    data[0] = 100
    static, obstacles = StaticLayer(), ObstacleLayer(None, NavigationContext(footprint=OUTLINE))
    static.set_map(OccupancyGrid(data, 0.05, (0.0, 0.0, 0.0)))
    obstacles.add_observation(Observation.from_scan(SCAN, POSE, 0.0))
    layers = [static, obstacles, InflationLayer(None, NavigationContext(footprint=Footprint.circle(0.2)))]
    layered = LayeredCostmap(CostmapParameters(), layers)
    layered.update(POSE, 0.0)
    FootprintCollisionChecker(layered.costmap, OUTLINE).in_collision(POSE)
    return layered.costmap


def _mark_voxels(costmap: Costmap) -> None:
    voxels = VoxelLayer(None, NavigationContext(footprint=OUTLINE))
    voxels.add_observation(Observation.from_scan(SCAN, POSE, 0.0))
    LayeredCostmap(CostmapParameters(), [voxels]).update(POSE, 0.0)


def _plan_around(costmap: Costmap) -> None:
    """Plan with NavFn, also from and to a place within an obstacle."""
    planner = NavfnPlanner()
    for start, goal in ((POSE, GOAL), (WALLED, GOAL), (POSE, WALLED)):
        planner.create_plan(costmap, start, goal)


def _plan_with_curves(costmap: Costmap) -> None:
    for model in ("DUBIN", "REEDS_SHEPP"):
        driven = SmacPlannerHybridParameters(motion_model_for_search=model, lookup_table_size=1.0)
        planner = SmacPlannerHybrid(driven, NavigationContext(footprint=OUTLINE))
        planner.create_plan(costmap, POSE, GOAL)


def _plan_over_lattice(costmap: Costmap) -> None:
    driven = SmacPlannerLatticeParameters(lookup_table_size=1.0)
    SmacPlannerLattice(driven, NavigationContext(footprint=OUTLINE)).create_plan(costmap, POSE, GOAL)


def _follow_with_mppi(costmap: Costmap) -> None:
    """Run the controller with each of its critics to a far goal and to a near one."""
    outline = CostCritic(CostCriticParameters(consider_footprint=True))
    controller = MppiController(
        MppiParameters(batch_size=20),
        NavigationContext(footprint=OUTLINE),
        critics=(outline, ObstaclesCritic(), PathAlignLegacyCritic(), *MppiController().critics),
    )
    for distance in (2.0, 0.7):
        controller.compute_velocity_commands(_along_path(costmap, distance))


def _follow_with_dwb(costmap: Costmap) -> None:
    limits = DwbParameters(
        max_vel_x=0.3, max_speed_xy=0.3, max_vel_theta=1.0, acc_lim_x=2.5, acc_lim_theta=3.0, vx_samples=2,
        vtheta_samples=3, critics=("BaseObstacle", "ObstacleFootprint", "PathDist")
    )  # fmt: skip
    DwbController(limits, NavigationContext(footprint=OUTLINE)).compute_velocity_commands(_along_path(costmap))


def _follow_with_teb(costmap: Costmap) -> None:
    controller = TebController(None, NavigationContext(footprint=OUTLINE))
    controller.compute_velocity_commands(_along_path(costmap))


def _along_path(costmap: Costmap, distance: float = 2.0) -> ControlInput:
    path = np.stack([np.linspace(1.0, 3.0, 41), np.full(41, 2.0), np.zeros(41)], axis=-1)
    return ControlInput(POSE, np.zeros(3), path, path[-1], distance, costmap)


def _smooth(costmap: Costmap) -> None:
    SimpleSmoother().smooth(_along_path(costmap).path, costmap)


_PARTS: dict[type, Callable[[Costmap], object]] = {
    VoxelLayer: _mark_voxels,
    NavfnPlanner: _plan_around,
    ThetaStarPlanner: lambda costmap: ThetaStarPlanner().create_plan(costmap, POSE, GOAL),
    SmacPlanner2D: lambda costmap: SmacPlanner2D().create_plan(costmap, POSE, GOAL),
    SmacPlannerHybrid: _plan_with_curves,
    SmacPlannerLattice: _plan_over_lattice,
    MppiController: _follow_with_mppi,
    DwbController: _follow_with_dwb,
    TebController: _follow_with_teb,
    SimpleSmoother: _smooth,
}
"""What calls the kernels of each plugin, in a costmap of 4 m by 4 m."""
