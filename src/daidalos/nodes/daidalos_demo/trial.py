"""`trial`: sends the demonstration's robot to goals across the arena and reports the results."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.parameter import Parameter
from tf2_ros import Buffer, TransformListener

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.description.footprint import Footprint, footprint
from daidalos.mapping.grid import OccupancyGrid
from daidalos.nodes.conversions import grid_array, pose2_of
from daidalos.nodes.daidalos_demo._measuring import TruthRecorder
from daidalos.nodes.daidalos_demo._robot import Robot
from daidalos.nodes.packages import package_share
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run_program

_CLEARANCE_M = 0.45
_LIDAR_HEIGHT_M = 0.18
_RASTER_M = 0.05
_SETTLE_S = 1.0
_GOAL_LIMIT_S = 180.0
_MAP_LIMIT_S = 15.0

Say = Callable[[str], None]


@dataclass(frozen=True)
class GoalReport:
    """Result of one goal: errors against ground truth in metres and radians, times in simulated seconds."""

    goal: tuple[float, float, float]
    reached: bool
    position_error_m: float
    yaw_error_rad: float
    time_s: float
    path_length_m: float
    reason: str = ""


@dataclass(frozen=True)
class MapReport:
    """Map: cell size, size in cells, and agreement with the true walls (ratios from 0 to 1)."""

    resolution_m: float
    width: int
    height: int
    walls_found: float
    walls_true: float


@dataclass(frozen=True)
class TrialReport:
    """Result of the test drive."""

    goals: list[GoalReport]
    contacts: int
    contact_names: list[str]
    map: MapReport | None
    localization_rmse_m: float
    real_time_factor: float

    @property
    def passed(self) -> bool:
        """Whether all goals were reached without collision."""
        return bool(self.goals) and all(goal.reached for goal in self.goals) and not self.contacts


@dataclass(frozen=True)
class TrialParameters(Parameters):
    """Parameters of ``trial``."""

    seed: int = parameter(0, "Seed of the choice of goals.")
    goals: int = parameter(3, "Number of goals.", minimum=0)
    world: str = parameter("", "SDF file that is simulated; by default the arena of turtlebot3_gazebo.")
    robot: str = parameter("waffle", "Name of the robot in the world.")


class Trial(Node):
    """Test drive to a sequence of goals.

    Parameters
    ----------
    say : callable
        Called with a line for each step.
    **kwargs
        Of `Node`.
    """

    def __init__(self, say: Say = lambda line: None, **kwargs: Any) -> None:
        overrides = [*kwargs.pop("parameter_overrides", []), Parameter("use_sim_time", value=True)]
        super().__init__("trial", parameter_overrides=overrides, **kwargs)
        from gazebo_msgs.msg import PerformanceMetrics

        self._say = say
        by_default = {"world": f"{package_share('turtlebot3_gazebo')}/worlds/arena.world"}
        self._settings = declare(self, TrialParameters, defaults=by_default)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._truth = TruthRecorder(self, self._buffer, self._settings.robot, "map", "base_footprint")
        self._robot = Robot(self)
        self._factors: list[float] = []
        self.create_subscription(PerformanceMetrics, "/performance_metrics", self._on_metrics, 10)

    def _on_metrics(self, message: Any) -> None:
        if message.real_time_factor > 0.0:
            self._factors.append(message.real_time_factor)

    async def run(self) -> TrialReport:
        """Carry the trial out; to be run as a task of the node's executor."""
        plan = _plan_of(self._settings.world)
        self._say("waiting for the robot, its map and the navigator")
        await self._robot.until_ready(lambda: self._truth.pose is not None)
        self._say("looking around")
        await self._robot.look_around()
        self._factors.clear()
        reports = []
        for number, goal in enumerate(choose_goals(plan, self._settings.goals, self._settings.seed), 1):
            self._say(f"goal {number} of {self._settings.goals}: ({goal[0]:.2f}, {goal[1]:.2f}, {goal[2]:.2f} rad)")
            reports.append(await self._drive(goal))
        contacts = self._truth.contacts
        return TrialReport(
            reports,
            len(contacts),
            contacts,
            self._map_report(plan),
            self._truth.localization_rmse,
            float(np.mean(self._factors)) if self._factors else math.nan,
        )

    async def _drive(self, goal: Any) -> GoalReport:
        await self._robot.until_mapped(goal[0], goal[1], _MAP_LIMIT_S)
        begun, travelled = self._truth.now_s, self._truth.travelled
        reached, reason = await self._robot.drive(goal, _GOAL_LIMIT_S)
        ended, path_length = self._truth.now_s, self._truth.travelled - travelled
        await self._robot.pause(_SETTLE_S)
        x, y, yaw = (float(value) for value in goal)
        pose = self._truth.pose
        report = GoalReport(
            (x, y, yaw),
            reached,
            float(np.hypot(pose[0] - x, pose[1] - y)),
            abs(float(wrap(pose[2] - yaw))),
            ended - begun,
            path_length,
            reason,
        )
        self._say(
            f"  {'reached' if reached else 'not reached: ' + reason} after {report.time_s:.1f} s and "
            f"{report.path_length_m:.2f} m, {100 * report.position_error_m:.1f} cm and "
            f"{report.yaw_error_rad:.3f} rad off"
        )
        return report

    def _map_report(self, plan: Footprint) -> MapReport | None:
        from daidalos.mapping.evaluation import compare_with_truth

        if self._robot.map is None:
            return None
        info = self._robot.map.info
        x, y, yaw = (float(value) for value in pose2_of(info.origin))
        grid = OccupancyGrid(grid_array(self._robot.map), info.resolution, (x, y, yaw))
        walls = plan.visible_walls(0.0, 0.0)
        truth = OccupancyGrid(np.where(walls, 100, 0).astype(np.int8), plan.resolution, (*plan.origin, 0.0))
        agreement = compare_with_truth(grid, truth, within=2)
        resolution = round(info.resolution, 6)
        return MapReport(resolution, info.width, info.height, agreement.walls_found, agreement.walls_true)


def _plan_of(world: str) -> Footprint:
    from daidalos.description.sdf import load

    return footprint(load(Path(world), package_share), _LIDAR_HEIGHT_M, _RASTER_M)


def choose_goals(plan: Footprint, count: int, seed: int) -> list[Any]:
    """Choose poses that are spread over the free space around the origin.

    Parameters
    ----------
    plan : Footprint
        The world.
    count : int
        How many.
    seed : int
        Chooses the first one and the headings; each further one is about as far as possible from the others.

    Returns
    -------
    list of arrays (3,)
        (x, y, yaw) with a clearance for the robot.
    """
    from scipy import ndimage

    distance = ndimage.distance_transform_edt(~plan.occupied) * plan.resolution
    rows, columns = np.nonzero(plan.reachable(0.0, 0.0) & (distance >= _CLEARANCE_M))
    places = np.stack([columns, rows], axis=-1) * plan.resolution + plan.origin + 0.5 * plan.resolution
    random = np.random.default_rng(seed)
    taken = [np.zeros(2)]
    goals = []
    for _ in range(count):
        nearest = np.min([np.hypot(*(places - other).T) for other in taken], axis=0)
        far = np.flatnonzero(nearest >= 0.7 * nearest.max())
        place = places[random.choice(far)]
        taken.append(place)
        goals.append(np.array([*place, random.uniform(-math.pi, math.pi)]))
    return goals


def main() -> int:
    """Run a trial against a demonstration that is already up, and print its report as JSON."""
    passed = False

    def body() -> None:
        nonlocal passed
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        rclpy.init()
        node = Trial(say=lambda line: print(line, file=sys.stderr))
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        task = executor.create_task(node.run)
        executor.spin_until_future_complete(task)
        report = task.result()
        passed = report.passed
        print(json.dumps(asdict(report)))
        node.destroy_node()

    return run_program(body, interrupted=130) or int(not passed)
