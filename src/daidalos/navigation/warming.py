"""Compilation of every kernel of navigation ahead of its first use."""

from collections.abc import Iterator

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
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner
from daidalos.navigation.smoothers.simple_smoother import SimpleSmoother

OUTLINE = Footprint.of_corners(np.array([[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]))


def steps() -> Iterator[tuple[float, str]]:
    """Call every kernel with data of the types of a real robot; see `daidalos.common.kernels.warm_up`."""
    yield 0.0, "costmap"
    costmap = _costmap()
    yield 0.3, "planner"
    _plan(costmap)
    yield 0.6, "controller"
    _control(costmap)


def _costmap() -> Costmap:
    """Return a costmap of a map, a scan and inflation."""
    data = np.zeros((80, 80), dtype=np.int8)
    data[0] = 100
    static, obstacles = StaticLayer(), ObstacleLayer(None, NavigationContext(footprint=OUTLINE))
    static.set_map(OccupancyGrid(data, 0.05, (0.0, 0.0, 0.0)))
    scan = LaserScanData(np.array([1.0, np.inf, 1.0]), 0.0, 0.1, 0.1, 10.0)
    pose = np.array([1.0, 2.0, 0.0])
    obstacles.add_observation(Observation.from_scan(scan, pose, 0.0))
    voxels = VoxelLayer(None, NavigationContext(footprint=OUTLINE))
    voxels.add_observation(Observation.from_scan(scan, pose, 0.0))
    layered = LayeredCostmap(
        CostmapParameters(),
        [static, obstacles, voxels, InflationLayer(None, NavigationContext(footprint=Footprint.circle(0.2)))],
    )
    layered.update(pose, 0.0)
    return layered.costmap


def _plan(costmap: Costmap) -> None:
    start, goal, walled = (np.array([x, y, 0.0]) for x, y in ((1.0, 2.0), (3.0, 2.0), (1.0, 0.18)))
    planner = NavfnPlanner()
    path = planner.create_plan(costmap, start, goal)
    planner.create_plan(costmap, walled, goal)
    planner.create_plan(costmap, start, walled)
    SimpleSmoother().smooth(path, costmap)
    for kind in (ThetaStarPlanner, SmacPlanner2D):
        kind().create_plan(costmap, start, goal)
    for model in ("DUBIN", "REEDS_SHEPP"):
        driven = SmacPlannerHybridParameters(motion_model_for_search=model, lookup_table_size=1.0)
        SmacPlannerHybrid(driven, NavigationContext(footprint=OUTLINE)).create_plan(costmap, start, goal)


def _control(costmap: Costmap) -> None:
    """Run a controller with each of its critics to a far goal and to a near one."""
    pose, rest = np.array([1.0, 2.0, 0.0]), np.zeros(3)
    path = np.stack([np.linspace(1.0, 3.0, 41), np.full(41, 2.0), np.zeros(41)], axis=-1)
    outline = CostCritic(CostCriticParameters(consider_footprint=True))
    controller = MppiController(
        MppiParameters(batch_size=20),
        NavigationContext(footprint=OUTLINE),
        critics=(outline, ObstaclesCritic(), PathAlignLegacyCritic(), *MppiController().critics),
    )
    for distance in (2.0, 0.7):
        control = ControlInput(pose, rest, path, path[-1], distance, costmap)
        controller.compute_velocity_commands(control)
    FootprintCollisionChecker(costmap, OUTLINE).in_collision(pose)
    limits = DwbParameters(
        max_vel_x=0.3, max_speed_xy=0.3, max_vel_theta=1.0, acc_lim_x=2.5, acc_lim_theta=3.0, vx_samples=2,
        vtheta_samples=3, critics=("BaseObstacle", "ObstacleFootprint", "PathDist")
    )  # fmt: skip
    sampling = DwbController(limits, NavigationContext(footprint=OUTLINE))
    beside = ControlInput(pose, rest, path, path[-1], 2.0, costmap)
    sampling.compute_velocity_commands(beside)
    TebController(None, NavigationContext(footprint=OUTLINE)).compute_velocity_commands(beside)
