"""`move_base` with ROS 1's parameters, on a map of two rooms that the test publishes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose
from nav_msgs.msg import OccupancyGrid, Path
from nav_msgs.srv import GetPlan
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty

from daidalos.common.errors import UserError
from daidalos.nodes.conversions import grid_message, path_array, pose_stamped, transform_stamped
from daidalos.nodes.move_base._parameters import MoveBaseParameters, recoveries
from daidalos.nodes.move_base.move_base import MoveBase
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(200)]


def common() -> dict[str, Any]:
    """Return what both costmaps have."""
    return {
        "robot_radius": 0.15,
        "obstacle_range": 3,
        "raytrace_range": 3.5,
        "inflation_radius": 0.3,
        "cost_scaling_factor": 5,
        "map_type": "costmap",
        "observation_sources": "scan",
        "scan": {"sensor_frame": "base_scan", "data_type": "LaserScan", "topic": "scan", "marking": True},
    }


PARAMETERS: dict[str, Any] = {
    "base_global_planner": "global_planner/GlobalPlanner",
    "base_local_planner": "teb_local_planner/TebLocalPlannerROS",
    "controller_frequency": 10,
    "planner_frequency": 0.5,
    "planner_patience": 1,
    "controller_patience": 3.0,
    "global_costmap": {
        **common(), "global_frame": "/map", "robot_base_frame": "/base_link", "update_frequency": 5, "static_map": True,
    },
    "local_costmap": {
        **common(), "global_frame": "odom", "robot_base_frame": "base_link", "update_frequency": 10,
        "publish_frequency": 5, "rolling_window": True, "width": 3, "height": 3, "resolution": 0.05,
    },
    "GlobalPlanner": {"allow_unknown": False, "default_tolerance": 0.1, "use_dijkstra": False, "neutral_cost": 66},
    "TebLocalPlannerROS": {
        "odom_topic": "odom", "max_vel_x": 0.5, "max_vel_theta": 1, "acc_lim_x": 1.5, "acc_lim_theta": 2.0,
        "xy_goal_tolerance": 0.15, "yaw_goal_tolerance": 0.2, "min_obstacle_dist": 0.2, "inflation_dist": 0.3,
        "footprint_model": {"type": "circular", "radius": 0.15},
    },
}  # fmt: skip


def rooms() -> OccupancyGrid:
    """Return a map of 6 m by 4 m from (-3, -2): a wall at x = 0 with a gap below, and a closed cell."""
    cells = np.zeros((80, 120), np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    cells[26:, 60] = 100
    cells[60:, 90] = cells[60, 90:] = 100
    return grid_message(cells, 0.05, (-3.0, -2.0), "map", time_message(0))


def pose(x: float, y: float, yaw: float = 0.0) -> PoseStamped:
    return pose_stamped((x, y, yaw), "map", time_message(0))


class Bench:
    """The node on a stage, with a robot at (-1.5, -1) whose scans see nothing near."""

    def __init__(self, stage: Stage) -> None:
        from tf2_msgs.msg import TFMessage

        self.stage = stage
        self.generator = np.random.default_rng(1)
        self.robot = stage.add_robot()
        self.robot.pose = np.array([-1.5, -1.0, 0.0])
        static = transform_stamped(np.zeros(3), "base_link", "base_scan", stage.stamp)
        stage.publish("/tf_static", TFMessage(transforms=[static]), LATCHED)
        self.scans = stage.node.create_publisher(LaserScan, "/scan", 10)
        stage.node.create_timer(0.1, self._scan)
        self.node = stage.add(MoveBase())
        stage.publish("/map", rooms(), LATCHED)

    def _scan(self) -> None:
        ranges = self.generator.normal(9.0, 0.01, 32).tolist()
        scan = LaserScan(angle_min=-3.1, angle_increment=0.2, range_min=0.1, range_max=10.0, ranges=ranges)
        scan.header.frame_id, scan.header.stamp = "base_scan", self.stage.stamp
        self.scans.publish(scan)

    def go(self, *place: float, feedback: Any = None) -> tuple[int, Any]:
        handle = self.stage.send(NavigateToPose, "move_base", feedback, pose=pose(*place))
        assert handle.accepted
        return self.stage.end(handle)


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage({"/move_base": PARAMETERS}))


def test_the_robot_drives_to_the_goal_of_the_action(bench: Bench) -> None:
    plans = bench.stage.collect(Path, "/move_base/GlobalPlanner/plan")
    locals_ = bench.stage.collect(Path, "/move_base/TebLocalPlannerROS/local_plan")
    costmaps = bench.stage.collect(OccupancyGrid, "/move_base/global_costmap/costmap", LATCHED)
    told: list[Any] = []
    status, result = bench.go(1.0, 0.5, 1.0, feedback=told.append)
    assert (status, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, "")
    assert np.hypot(*(bench.robot.pose[:2] - (1.0, 0.5))) < 0.2
    assert abs(bench.robot.pose[2] - 1.0) < 0.25
    assert bench.robot.is_standing
    assert max(abs(one[0]) for one in bench.robot.commands) > 0.35
    assert plans
    assert locals_
    assert costmaps[-1].info.width == 120
    distances = [one.feedback.distance_remaining for one in told]
    assert distances[-1] < 0.5 < max(distances) < 6.0


def test_the_robot_drives_to_the_goal_of_a_topic_and_another_takes_its_place(bench: Bench) -> None:
    results = bench.stage.collect(GoalStatus, "/move_base/result")
    current = bench.stage.collect(PoseStamped, "/move_base/current_goal", LATCHED)
    places = bench.stage.collect(PoseStamped, "/move_base/feedback")
    statuses = bench.stage.collect(GoalStatusArray, "/move_base/status", LATCHED)
    goals = bench.stage.node.create_publisher(PoseStamped, "/move_base_simple/goal", 10)
    goals.publish(pose(1.0, 0.5))
    bench.stage.step_until(lambda: bench.robot.pose[0] > -1.2)
    goals.publish(pose(-1.5, 0.5, 1.5))
    bench.stage.step_until(lambda: len(results) == 2)
    assert [one.status for one in results] == [GoalStatus.STATUS_ABORTED, GoalStatus.STATUS_SUCCEEDED]
    assert np.hypot(*(bench.robot.pose[:2] - (-1.5, 0.5))) < 0.2
    assert [(one.pose.position.x, one.pose.position.y) for one in current] == [(1.0, 0.5), (-1.5, 0.5)]
    assert places[-1].header.frame_id == "map"
    assert {one.status for one in statuses[-1].status_list} >= {GoalStatus.STATUS_SUCCEEDED}


def test_a_cancelled_goal_stops_the_robot(bench: Bench) -> None:
    results = bench.stage.collect(GoalStatus, "/move_base/result")
    bench.stage.node.create_publisher(PoseStamped, "/move_base/goal", 10).publish(pose(1.0, 0.5))
    bench.stage.step_until(lambda: not bench.robot.is_standing)
    bench.stage.publish("/move_base/cancel", GoalInfo())
    bench.stage.step_until(lambda: bool(results))
    assert results[0].status == GoalStatus.STATUS_CANCELED
    bench.stage.step_for(0.3)
    assert bench.robot.is_standing
    place = bench.robot.pose
    bench.stage.step_for(0.5)
    assert np.array_equal(bench.robot.pose, place)


def test_a_goal_that_cannot_be_reached_is_given_up_after_the_recoveries(bench: Bench) -> None:
    status, result = bench.go(2.2, 1.5)
    assert status == GoalStatus.STATUS_ABORTED
    assert "no plan: " in result.error_msg
    assert "4 recoveries were tried" in result.error_msg
    turned = sum(abs(one[2]) for one in bench.robot.commands) * 0.1
    assert turned > 6.0  # it looked around
    assert bench.robot.is_standing


def test_plans_for_others_and_costmaps_that_are_cleared(bench: Bench) -> None:
    bench.stage.step_for(0.5)
    made = bench.stage.call(GetPlan, "/move_base/make_plan", start=pose(-2.0, 0.0), goal=pose(1.5, 0.0))
    path = path_array(made.plan)
    assert path[0][:2] == pytest.approx([-2.0, 0.0], abs=0.05)
    assert path[-1][:2] == pytest.approx([1.5, 0.0], abs=0.05)
    assert not bench.stage.call(GetPlan, "/move_base/make_plan", start=pose(-2.0, 0.0), goal=pose(2.2, 1.5)).plan.poses
    bench.stage.call(Empty, "/move_base/clear_costmaps")
    assert bench.robot.is_standing


def behind_a_wall_that_has_gone(stage: Callable[[dict[str, Any]], Stage], **parameters: Any) -> Bench:
    """Return a robot that has seen a wall, a metre ahead, by a sensor that clears nothing."""
    forgetful = {
        name: {**PARAMETERS[name], "scan": {"topic": "scan", "clearing": False}}
        for name in ("global_costmap", "local_costmap")
    }
    bench = Bench(stage({"/move_base": {**PARAMETERS, **forgetful, **parameters}}))
    angles = -1.5 + 0.02 * np.arange(151)
    for _ in range(10):
        scan = LaserScan(angle_min=-1.5, angle_increment=0.02, range_min=0.1, range_max=10.0)
        scan.ranges = np.minimum(1.0 / np.cos(angles), 20.0).tolist()
        scan.header.frame_id, scan.header.stamp = "base_scan", bench.stage.stamp
        bench.scans.publish(scan)
        bench.stage.step()
    return bench


@pytest.mark.slow
def test_the_robot_recovers_where_an_obstacle_that_has_gone_stays_in_the_costmap(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    """The reset far from the robot makes way."""
    bench = behind_a_wall_that_has_gone(stage)
    told: list[Any] = []
    status, result = bench.go(1.0, -1.0, feedback=told.append)
    assert (status, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, "")
    assert told[-1].feedback.number_of_recoveries >= 1


@pytest.mark.slow
def test_the_robot_moves_slowly_at_first_after_it_has_cleared_what_is_around_it(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    bench = behind_a_wall_that_has_gone(
        stage,
        recovery_behaviors="[{'name': 'slow', 'type': 'move_slow_and_clear/MoveSlowAndClear'}]",
        slow={"clearing_distance": 4, "limited_trans_speed": 0.1, "limited_rot_speed": 0.45, "limited_distance": 0.4},
    )
    begun = len(bench.robot.commands)
    status, result = bench.go(1.0, -1.0)
    assert (status, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, "")
    speeds = np.array(bench.robot.commands[begun:])[:, 0]
    driven = np.cumsum(np.abs(speeds)) * 0.1
    assert np.abs(speeds[driven < 0.35]).max() <= 0.1 + 1e-6
    assert speeds[driven > 0.6].max() > 0.3


@pytest.mark.parametrize("value", [0, -1.0, True, "fast"])
def test_a_recovery_with_a_parameter_that_is_no_positive_number_is_refused(value: Any) -> None:
    text = "[{'name': 'slow', 'type': 'move_slow_and_clear/MoveSlowAndClear'}]"
    with pytest.raises(UserError, match=r"'slow.limited_distance' must be a positive number"):
        recoveries(MoveBaseParameters(recovery_behaviors=text), {"slow.limited_distance": value}, 0.2)
