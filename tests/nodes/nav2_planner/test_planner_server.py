"""The server that plans paths, over a map that the test publishes."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
from nav2_msgs.msg import Costmap
from nav2_msgs.srv import IsPathValid
from nav_msgs.msg import Path
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter

from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.state_lattice import lattice_document
from daidalos.nodes.conversions import grid_message, path_array, pose_stamped
from daidalos.nodes.nav2_planner.planner_server import PlannerServer
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

Result = ComputePathToPose.Result
COSTMAP = "/global_costmap/global_costmap"
PARAMETERS: dict[str, Any] = {
    "/planner_server": {
        "planner_plugins": ["GridBased", "Strict"],
        "GridBased": {"plugin": "nav2_navfn_planner::NavfnPlanner", "tolerance": 0.25},
        "Strict": {"plugin": "nav2_navfn_planner/NavfnPlanner", "tolerance": 0.0, "allow_unknown": False},
    },
    COSTMAP: {
        "update_frequency": 20.0,
        "publish_frequency": 20.0,
        "robot_radius": 0.1,
        "track_unknown_space": True,
        "plugins": ["static_layer", "inflation_layer"],
        "inflation_layer": {"inflation_radius": 0.3},
    },
}


def changed(node: str, **values: Any) -> dict[str, Any]:
    """Return the parameters with other values for a node."""
    return {**PARAMETERS, node: {**PARAMETERS[node], **values}}


def room() -> Any:
    """Return a map of 6 m by 4 m from (-3, -2): a wall at x = 0 with a gap below, a closed cell, an unknown corner."""
    cells = np.zeros((80, 120), np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    cells[20:, 60] = 100
    cells[60:, 90] = cells[60, 90:] = 100
    cells[1:20, 1:20] = -1
    return grid_message(cells, 0.05, (-3.0, -2.0), "map", time_message(0))


def pose(x: float, y: float, frame: str = "map", yaw: float = 0.0) -> PoseStamped:
    return pose_stamped((x, y, yaw), frame, time_message(0))


class Bench:
    """The server on a stage, with a robot at (-1.5, 1)."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.robot = stage.add_robot()
        self.robot.pose = np.array([-1.5, 1.0, 0.0])
        self.server = stage.add(PlannerServer())

    def start(self, grid: Any | None = None) -> Bench:
        """Bring the server up; with a map, wait until the costmap is known."""
        costmaps = self.stage.collect(Costmap, "/global_costmap/costmap_raw", LATCHED)
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        if grid is not None:
            self.stage.publish("/map", grid, LATCHED)
            self.stage.step_until(lambda: bool(costmaps) and costmaps[-1].metadata.size_x == grid.info.width)
        return self

    def plan(self, **goal: Any) -> tuple[int, Any]:
        handle = self.stage.send(ComputePathToPose, "compute_path_to_pose", **goal)
        assert handle.accepted
        return self.stage.end(handle)


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage(PARAMETERS)).start(room())


@pytest.mark.slow
def test_a_path_leads_from_the_robot_through_the_gap(bench: Bench) -> None:
    published = bench.stage.collect(Path, "plan")
    status, result = bench.plan(goal=pose(1.5, 0.0, yaw=1.0))
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, "")
    path = path_array(result.path)
    assert path[0][:2] == pytest.approx([-1.5, 1.0], abs=0.05)
    assert path[-1] == pytest.approx([1.5, 0.0, 1.0], abs=0.05)
    crossing = path[np.argmin(np.abs(path[:, 0]))]
    assert crossing[1] < -1.0
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    assert steps.max() < 0.1
    assert 4.0 < steps.sum() < 6.0
    assert result.path.header.frame_id == "map"
    assert {one.header.frame_id for one in result.path.poses} == {"map"}
    assert result.planning_time.sec == 0
    assert result.planning_time.nanosec > 0
    bench.stage.step_until(lambda: bool(published))
    assert published == [result.path]


def test_paths_over_a_state_lattice_of_a_file(stage: Callable[[dict[str, Any]], Stage], tmp_path: FilePath) -> None:
    file = tmp_path / "lattice.json"
    lattice = generate_lattice(LatticeOptions("diff", 0.2))
    file.write_text(json.dumps(lattice_document(lattice, {}, "2026-01-01")))
    given = {"plugin": "nav2_smac_planner/SmacPlannerLattice", "lattice_filepath": str(file), "rotation_penalty": 2.0}
    bench = Bench(stage(changed("/planner_server", planner_plugins=["Lattice"], Lattice=given))).start(room())
    status, result = bench.plan(goal=pose(1.5, 0.0, yaw=1.0), planner_id="Lattice")
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, "")
    path = path_array(result.path)
    assert path[0] == pytest.approx([-1.5, 1.0, 0.0], abs=1e-6)
    assert path[-1] == pytest.approx([1.5, 0.0, 1.0], abs=1e-6)
    assert path[np.argmin(np.abs(path[:, 0]))][1] < -1.0


def test_a_file_of_a_lattice_that_is_not_there_fails_the_transition(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    given = {"plugin": "nav2_smac_planner::SmacPlannerLattice", "lattice_filepath": "/no/lattice.json"}
    made = stage(changed("/planner_server", planner_plugins=["Lattice"], Lattice=given)).add(PlannerServer())
    assert made.trigger_configure() == TransitionCallbackReturn.FAILURE
    made.destroy_node()
    printed = capfd.readouterr().err
    assert "'lattice_filepath' names a file that cannot be used: /no/lattice.json: cannot be read: No such" in printed
    assert "Traceback" not in printed


def test_a_path_leads_through_poses(bench: Bench) -> None:
    goals = [pose(-2.0, 0.0), pose(1.5, 0.0), pose(1.5, -1.0, yaw=1.0)]
    handle = bench.stage.send(ComputePathThroughPoses, "compute_path_through_poses", goals=goals)
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE), result.error_msg
    path = path_array(result.path)
    assert path[0][:2] == pytest.approx([-1.5, 1.0], abs=0.05)
    assert path[-1] == pytest.approx([1.5, -1.0, 1.0], abs=0.05)
    for goal in goals:
        at = goal.pose.position
        assert np.hypot(path[:, 0] - at.x, path[:, 1] - at.y).min() < 0.05
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max() < 0.1


@pytest.mark.parametrize(
    ("goals", "code"),
    [
        ([], ComputePathThroughPoses.Result.NO_VIAPOINTS_GIVEN),
        ([pose(1.5, 0.0), pose(2.2, 1.5)], ComputePathThroughPoses.Result.NO_VALID_PATH),
    ],
)
def test_poses_without_a_path_are_aborted_with_the_reason(bench: Bench, goals: list[Any], code: int) -> None:
    handle = bench.stage.send(ComputePathThroughPoses, "compute_path_through_poses", goals=goals)
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code)


def test_a_path_is_valid_unless_an_obstacle_is_on_what_is_left_of_it(bench: Bench) -> None:
    def ask(*places: tuple[float, float], **more: Any) -> Any:
        path = Path(poses=[pose(x, y) for x, y in places])
        path.header.frame_id = "map"
        return bench.stage.call(IsPathValid, "is_path_valid", path=path, max_cost=254, **more)

    assert ask((-1.5, 1.0), (-1.5, 0.0)).is_valid
    blocked = ask((-1.5, 1.0), (0.02, 1.0), (0.5, 1.0))
    assert (blocked.is_valid, list(blocked.invalid_pose_indices)) == (False, [1])
    assert ask((0.02, 1.0), (-1.5, 1.0), (-1.5, 0.0)).is_valid  # the obstacle lies behind the robot
    assert ask((-1.5, 1.0), (-2.7, -1.7)).is_valid
    assert not ask((-1.5, 1.0), (-2.7, -1.7), consider_unknown_as_obstacle=True).is_valid
    assert not ask().is_valid


def test_a_start_may_be_given(bench: Bench) -> None:
    status, result = bench.plan(goal=pose(-2.0, 1.0), start=pose(-0.5, 1.0), use_start=True)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert path_array(result.path)[0][:2] == pytest.approx([-0.5, 1.0], abs=0.05)


def test_a_goal_may_be_in_another_frame(bench: Bench) -> None:
    status, result = bench.plan(goal=pose(0.5, -0.5, "base_link"))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert path_array(result.path)[-1][:2] == pytest.approx([-1.0, 0.5], abs=0.05)
    assert bench.plan(goal=pose(-1.0, 0.5, ""))[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize(
    ("goal", "code", "reason"),
    [
        ({"goal": pose(10.0, 0.0)}, Result.GOAL_OUTSIDE_MAP, "(10.00, 0.00)"),
        ({"goal": pose(math.nan, 0.0)}, Result.GOAL_OUTSIDE_MAP, "nan"),
        ({"goal": pose(0.0, 1.0)}, Result.GOAL_OCCUPIED, "obstacle"),
        ({"goal": pose(2.2, 1.5)}, Result.NO_VALID_PATH, "cut it off"),
        ({"goal": pose(-2.5, -1.5), "planner_id": "Strict"}, Result.GOAL_OCCUPIED, "unknown space"),
        ({"goal": pose(1.0, 0.0), "planner_id": "Grid"}, Result.INVALID_PLANNER, "GridBased, Strict"),
        ({"goal": pose(1.0, 0.0, "nowhere")}, Result.TF_ERROR, "nowhere"),
        ({"goal": pose(1.0, 0.0), "start": pose(0.0, 9.0), "use_start": True}, Result.START_OUTSIDE_MAP, "9.00"),
        ({"goal": pose(1.0, 0.0), "start": pose(0.0, 0.0, "x"), "use_start": True}, Result.TF_ERROR, "'x'|\"x\"| x"),
    ],
)
def test_a_goal_without_a_path_is_aborted_with_the_reason(
    bench: Bench, goal: dict[str, Any], code: int, reason: str
) -> None:
    status, result = bench.plan(**goal)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code), result.error_msg
    assert any(word in result.error_msg for word in reason.split("|"))
    assert result.path.poses == []
    assert bench.plan(goal=pose(1.5, 0.0))[0] == GoalStatus.STATUS_SUCCEEDED


def test_slow_planning_is_warned_of(bench: Bench, capfd: pytest.CaptureFixture[str]) -> None:
    assert bench.server.set_parameters([Parameter("expected_planner_frequency", value=1e7)])[0].successful
    assert bench.plan(goal=pose(1.5, 0.0))[0] == GoalStatus.STATUS_SUCCEEDED
    assert "longer than expected_planner_frequency 1e+07 Hz allows" in capfd.readouterr().err


def test_unknown_space_is_crossed_where_the_planner_may(bench: Bench) -> None:
    assert bench.plan(goal=pose(-2.5, -1.5), planner_id="GridBased")[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
@pytest.mark.parametrize("missing", ["map", "transform"])
def test_without_map_or_transform_the_goal_ends_with_the_reason(
    stage: Callable[[dict[str, Any]], Stage], missing: str
) -> None:
    bench = Bench(stage(changed("/planner_server", costmap_update_timeout=2.0)))
    if missing == "transform":
        bench.robot.is_localized = False
        bench.stage.step_for(0.5)
    bench.start()
    began = bench.stage.now
    status, result = bench.plan(goal=pose(1.0, 0.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TF_ERROR)
    assert f"there is no {missing}" in result.error_msg
    assert bench.stage.now - began > 2.0


def test_a_goal_that_waits_for_the_map_is_carried_out_when_it_comes(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(changed("/planner_server", costmap_update_timeout=1e6))).start()
    handle = bench.stage.send(ComputePathToPose, "compute_path_to_pose", goal=pose(1.5, 0.0))
    bench.stage.publish("/map", room(), LATCHED)
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize("how", ["cancel", "deactivate"])
def test_a_goal_that_waits_can_be_ended(stage: Callable[[dict[str, Any]], Stage], how: str) -> None:
    bench = Bench(stage(changed("/planner_server", costmap_update_timeout=1e6))).start()
    handle = bench.stage.send(ComputePathToPose, "compute_path_to_pose", goal=pose(1.5, 0.0))
    if how == "cancel":
        bench.stage.result(handle.cancel_goal_async())
        bench.stage.publish("/map", room(), LATCHED)
        assert bench.stage.end(handle)[0] == GoalStatus.STATUS_CANCELED
    else:
        bench.server.trigger_deactivate()
        status, result = bench.stage.end(handle)
        assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.UNKNOWN)
        assert "deactivated" in result.error_msg


def test_goals_are_rejected_while_it_is_not_active(bench: Bench) -> None:
    bench.server.trigger_deactivate()
    handle = bench.stage.send(ComputePathToPose, "compute_path_to_pose", goal=pose(1.5, 0.0))
    assert not handle.accepted


def test_it_can_be_configured_again(bench: Bench) -> None:
    bench.server.trigger_deactivate()
    assert bench.server.trigger_cleanup() == TransitionCallbackReturn.SUCCESS
    assert bench.stage.node.count_publishers("plan") == 0
    assert bench.stage.node.count_subscribers("/map") == 0
    bench.start(room())
    assert bench.plan(goal=pose(1.5, 0.0))[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        (changed("/planner_server", Strict={"plugin": "nav2_navfn_planner::NavFn"}), "NavfnPlanner"),
        (
            changed(COSTMAP, plugins=["voxel_layer"], voxel_layer={"plugin": "nav2_costmap_2d::BoxLayer"}),
            "BoxLayer",
        ),
        (
            changed(
                COSTMAP,
                plugins=["obstacle_layer"],
                obstacle_layer={"observation_sources": "depth", "depth": {"data_type": "PointCloud3"}},
            ),
            "PointCloud3",
        ),
    ],
)
def test_what_is_not_there_makes_configuring_fail(
    stage: Callable[[dict[str, Any]], Stage],
    capfd: pytest.CaptureFixture[str],
    parameters: dict[str, Any],
    reason: str,
) -> None:
    bench = Bench(stage(parameters))
    for _ in range(2):
        assert bench.server.trigger_configure() == TransitionCallbackReturn.FAILURE
        assert bench.server.current_state.label == "unconfigured"
        assert bench.stage.node.count_publishers("plan") == 0
        assert bench.stage.node.count_publishers("/global_costmap/costmap") == 0
    printed = capfd.readouterr().err
    assert reason in printed
    assert "Traceback" not in printed
