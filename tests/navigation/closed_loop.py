"""A robot in a flat world that drives to goals with the library alone, from scans to velocities."""

import math
from dataclasses import dataclass, field

import numpy as np
from py_trees.common import Status

from daidalos.common.pose2 import wrap
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.behaviors.back_up import BackUp, BackUpCommand
from daidalos.navigation.behaviors.spin import Spin, SpinCommand
from daidalos.navigation.behaviors.wait import Wait, WaitCommand
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.follow_path import FollowPath
from daidalos.navigation.controllers.goal_checkers.simple_goal_checker import (
    SimpleGoalChecker,
    SimpleGoalCheckerParameters,
)
from daidalos.navigation.controllers.graceful_controller import GracefulController
from daidalos.navigation.controllers.mppi.critics.cost_critic import CostCritic, CostCriticParameters
from daidalos.navigation.controllers.mppi_controller import MppiController, MppiParameters
from daidalos.navigation.controllers.progress_checkers.simple_progress_checker import SimpleProgressChecker
from daidalos.navigation.controllers.regulated_pure_pursuit_controller import RegulatedPurePursuitController
from daidalos.navigation.controllers.rotation_shim_controller import RotationShimController
from daidalos.navigation.controllers.teb_controller import TebController, TebParameters
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from daidalos.navigation.costmap.layers.obstacle_layer import (
    ObservationSource,
    ObstacleLayer,
    ObstacleLayerParameters,
)
from daidalos.navigation.costmap.layers.static_layer import StaticLayer
from daidalos.navigation.costmap.observation import Observation
from daidalos.navigation.errors import BehaviorError, ControllerError, PlannerError
from daidalos.navigation.planners.navfn_planner import NavfnPlanner
from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.services import Outcome

from .flat_world import FlatRobot

PERIOD = 0.05
LATENCY = 0.02
JACKAL = np.array([[0.254, 0.215], [0.254, -0.215], [-0.254, -0.215], [-0.254, 0.215]])


@dataclass
class Arrival:
    """How a drive to a goal ended."""

    reached: bool
    contact: bool
    time: float
    length: float
    position_error: float
    yaw_error: float
    min_clearance: float
    error: str
    commands: np.ndarray = field(repr=False)


class Ended:
    """A task that ended when it was started."""

    def __init__(self, outcome):
        self.outcome = outcome

    def poll(self):
        return self.outcome

    def update(self, goal):
        raise AssertionError("a task that has ended is not updated")

    def halt(self):
        raise AssertionError("a task that has ended is not halted")


class Motion:
    """A task that gives a velocity each cycle: following a path, or a behaviour."""

    def __init__(self, stack, step, replan=None):
        self.stack, self.step, self.replan = stack, step, replan
        self.outcome = None
        stack.motion = self

    def cycle(self):
        """Velocity for the next cycle."""
        try:
            done = self.step()
        except (ControllerError, BehaviorError) as error:
            self.outcome = Outcome(False, {}, error.code, str(error))
            return np.zeros(3)
        if done.done:
            self.outcome = Outcome(True)
        return done.velocity

    def poll(self):
        return self.outcome

    def update(self, goal):
        self.replan(goal["path"])

    def halt(self):
        self.stack.motion = None


class Stack:
    """Everything between a scan and a velocity, bound to a robot by direct calls."""

    def __init__(
        self, robot, footprint, controller, global_costmap, local_costmap, xy_tolerance=0.1, yaw_tolerance=0.1
    ):
        self.robot, self.footprint = robot, footprint
        self.global_costmap, self.local_costmap = global_costmap, local_costmap
        self.planner = NavfnPlanner()
        checker = SimpleGoalChecker(SimpleGoalCheckerParameters(xy_tolerance, yaw_tolerance))
        self.follow = FollowPath(controller, checker, SimpleProgressChecker(), failure_tolerance=1.0)
        self.motion = None
        self.time = 0.0
        self.cycles = 0
        self.started = []

    def now(self):
        return self.time

    def latest(self, topic, kind, *, latched=False):
        return None

    def start(self, node, goal):
        self.started.append(node.__name__)
        return getattr(self, f"_{node.__name__}")(goal)

    def drive_to(self, goal, limit=120.0, stop_within=0.0):
        """Drive to a goal with the default tree; `stop_within` ends the drive at a distance from it."""
        blackboard = Blackboard()
        blackboard.set("goal", np.asarray(goal, dtype=float))
        tree = BehaviorTree.load(DEFAULT_TREE, self, blackboard)
        robot, begun, travelled = self.robot, self.time, self.robot.travelled
        robot.min_clearance, robot.contact = math.inf, False
        status, commands, pending = Status.RUNNING, [], np.zeros(3)
        while status == Status.RUNNING and self.time - begun < limit and not robot.contact:
            self._sense()
            status = tree.tick()
            command = self.motion.cycle() if self.motion is not None else np.zeros(3)
            commands.append(command)
            robot.drive(pending, LATENCY)
            robot.drive(command, PERIOD - LATENCY)
            pending = command
            self.time += PERIOD
            self.cycles += 1
            if math.hypot(*(robot.pose - goal)[:2]) < stop_within:
                status = Status.SUCCESS
        tree.halt()
        self.motion = None
        robot.drive(np.zeros(3), 0.5)
        away = robot.pose - goal
        return Arrival(
            status == Status.SUCCESS and not robot.contact,
            robot.contact,
            self.time - begun,
            robot.travelled - travelled,
            math.hypot(away[0], away[1]),
            abs(float(wrap(away[2]))),
            robot.min_clearance,
            blackboard.get("follow_path_error_msg") or blackboard.get("compute_path_error_msg") or "",
            np.array(commands).reshape(-1, 3),
        )

    def _sense(self):
        """Scan at 5 Hz for the local costmap, at 1 Hz for the global one."""
        pose = self.robot.pose
        if self.cycles % 4 == 0:
            seen = Observation.from_scan(self.robot.scan(), pose, self.time)
            _obstacles(self.local_costmap).add_observation(seen)
            self.local_costmap.update(pose, self.time)
            if self.cycles % 20 == 0:
                _obstacles(self.global_costmap).add_observation(seen)
                self.global_costmap.update(pose, self.time)

    def _ComputePathToPose(self, goal):
        try:
            path = self.planner.create_plan(self.global_costmap.costmap, self.robot.pose, goal["goal"])
        except PlannerError as error:
            return Ended(Outcome(False, {}, error.code, str(error)))
        return Ended(Outcome(True, {"path": path}))

    def _FollowPath(self, goal):
        self.follow.start(goal["path"])
        cost = self.local_costmap.circumscribed_cost(self.footprint)

        def step():
            robot, costmap = self.robot, self.local_costmap.costmap
            return self.follow.step(robot.pose, robot.velocity, costmap, self.time, circumscribed_cost=cost)

        return Motion(self, step, self.follow.replan)

    def _Spin(self, goal):
        command = SpinCommand(goal["spin_dist"], goal["time_allowance"])
        return self._behave(Spin(None, NavigationContext(footprint=self.footprint, frequency=1.0 / PERIOD)), command)

    def _BackUp(self, goal):
        command = BackUpCommand(goal["backup_dist"], goal["backup_speed"], goal["time_allowance"])
        return self._behave(BackUp(None, NavigationContext(footprint=self.footprint, frequency=1.0 / PERIOD)), command)

    def _Wait(self, goal):
        return self._behave(
            Wait(None, NavigationContext(footprint=self.footprint, frequency=10.0)), WaitCommand(goal["wait_duration"])
        )

    def _ClearEntireCostmap(self, goal):
        costmap = self.global_costmap if "global" in goal["service_name"] else self.local_costmap
        costmap.clear_entirely()
        return Ended(Outcome(True))

    def _behave(self, behavior, command):
        behavior.start(command, self.robot.pose, self.time)

        def step():
            robot, costmap = self.robot, self.local_costmap.costmap
            return behavior.step(robot.pose, robot.velocity, costmap, self.time)

        return Motion(self, step)


def turtlebot(world, pose, known, seed=0, kind="mppi"):
    """A TurtleBot3 waffle, as a disc of 0.22 m, whose map of the arena is the world `known`."""
    footprint = Footprint.circle(0.22)
    robot = FlatRobot(world, np.array(pose, dtype=float), seed=seed)
    occupancy = OccupancyGrid(known.rasterised(0.05, (-0.5, -0.5), (140, 180)), 0.05, (-0.5, -0.5, 0.0))
    static = StaticLayer()
    static.set_map(occupancy)
    sources = ObstacleLayerParameters(sources={"scan": ObservationSource(2.5, 0.0, 3.0, 0.0)})
    inflation = InflationLayerParameters(0.55, 4.0)
    everywhere = LayeredCostmap(
        CostmapParameters(track_unknown_space=True),
        [
            static,
            ObstacleLayer(sources, NavigationContext(footprint=footprint)),
            InflationLayer(inflation, NavigationContext(footprint=Footprint.circle(0.22))),
        ],
    )
    around = LayeredCostmap(
        CostmapParameters(3.0, 3.0, 0.05, rolling_window=True),
        [
            ObstacleLayer(sources, NavigationContext(footprint=footprint, track_unknown_space=False)),
            InflationLayer(inflation, NavigationContext(footprint=Footprint.circle(0.22))),
        ],
    )
    mppi = MppiController(None, NavigationContext(footprint=footprint, seed=seed))
    controller = {
        "mppi": mppi,
        "shim": RotationShimController(None, NavigationContext(footprint=footprint), primary=mppi),
        "graceful": GracefulController(None, NavigationContext(footprint=footprint)),
        "teb": TebController(
            TebParameters(
                max_vel_theta=1.0,
                acc_lim_x=2.5,
                acc_lim_theta=3.2,
                footprint_type="circular",
                footprint_radius=0.22,
                min_obstacle_dist=0.1,
                inflation_dist=0.4,
            ),
            NavigationContext(footprint=footprint),
        ),
        "rpp": RegulatedPurePursuitController(None, NavigationContext(footprint=footprint)),
    }[kind]
    return Stack(robot, footprint, controller, everywhere, around)


def jackal(world, pose, seed=0):
    """The robot of the BARN benchmark: a box of 0.51 x 0.43 m, 2 m/s, a lidar of 270 degrees, no map."""
    footprint = Footprint.of_corners(JACKAL)
    robot = FlatRobot(
        world,
        np.array(pose, dtype=float),
        radius=footprint.circumscribed_radius,
        outline=JACKAL,
        max_speed=2.0,
        max_turn=3.0,
        max_accel=8.0,
        max_turn_accel=20.0,
        beams=720,
        field_of_view=1.5 * math.pi,
        max_range=30.0,
        sensor_pose=(0.12, 0.0, 0.0),
        seed=seed,
    )
    sources = ObstacleLayerParameters(sources={"scan": ObservationSource(10.0, 0.0, 10.0, 0.0)})
    inflation = InflationLayerParameters(0.6, 4.0)

    def layers():
        obstacles = ObstacleLayer(sources, NavigationContext(footprint=footprint, track_unknown_space=False))
        return [obstacles, InflationLayer(inflation, NavigationContext(footprint=footprint))]

    everywhere = LayeredCostmap(CostmapParameters(9.0, 18.0, 0.05, origin_x=-6.5, origin_y=-1.0), layers())
    around = LayeredCostmap(CostmapParameters(8.0, 8.0, 0.05, rolling_window=True), layers())
    parameters = MppiParameters(
        vx_max=2.0,
        wz_max=2.5,
        ax_max=6.0,
        ax_min=-6.0,
        az_max=12.0,
        vx_std=0.4,
        wz_std=0.8,
        prune_distance=3.0,
    )
    outline = CostCritic(CostCriticParameters(consider_footprint=True))
    critics = (outline, *(critic for critic in MppiController().critics if not isinstance(critic, CostCritic)))
    controller = MppiController(parameters, NavigationContext(footprint=footprint, seed=seed), critics=critics)
    return Stack(robot, footprint, controller, everywhere, around, 0.9, math.pi)


def free_pose(world, generator, clearance=0.3):
    """A random pose in the arena that the robot can stand at."""
    inside = [(5.6, 0.9, 0.6, 0.4), (6.9, 4.4, 0.5, 0.5), (0.9, 4.2, 0.4, 0.7)]
    while True:
        x, y = generator.uniform((0.4, 0.4), (7.6, 5.6))
        if any(a < x < a + w and b < y < b + h for a, b, w, h in inside):
            continue
        if world.clearance((x, y)) > clearance:
            return np.array([x, y, generator.uniform(-math.pi, math.pi)])


def _obstacles(costmap):
    return next(layer for layer in costmap.layers if isinstance(layer, ObstacleLayer))
