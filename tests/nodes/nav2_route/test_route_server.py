"""The server of routes, with the test as the robot."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from nav2_msgs.action import ComputeAndTrackRoute, ComputeRoute
from nav2_msgs.msg import EdgeCost, SpeedLimit
from nav2_msgs.srv import DynamicEdges, SetRouteGraph
from rclpy.lifecycle import TransitionCallbackReturn
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.nodes.conversions import path_array, pose_stamped
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message
from daidalos.nodes.nav2_route.route_server import RouteServer
from navigation.routes.graphs import square, write
from nodes.hostile_values import TEXTS, hostile_pose
from nodes.stepped import LATCHED, Stage

pytestmark = pytest.mark.timeout(300)

Result = ComputeAndTrackRoute.Result
SetStage = Callable[[dict[str, Any]], Stage]


class Bench:
    def __init__(self, set_stage: SetStage, folder: Path, /, *, graph: Any = None, **parameters: Any) -> None:
        self.file = write(folder / "graph.geojson", square(**graph or {}))
        self.folder = folder
        near = {"radius_to_achieve_node": 1.0, "boundary_radius_to_achieve_node": 0.3, "tracker_update_rate": 20.0}
        self.stage = set_stage({"/route_server": {"graph_filepath": str(self.file), **near, **parameters}})
        self.robot = self.stage.add_robot()
        self.server = self.stage.add(RouteServer())
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.stage.step_for(0.2)
        self.feedback: list[Any] = []

    def pose(self, x: float, y: float, yaw: float = 0.0, frame: str = "map") -> Any:
        return pose_stamped((x, y, yaw), frame, self.stage.stamp)

    def compute(self, **goal: Any) -> tuple[int, Any]:
        return self.stage.end(self.stage.send(ComputeRoute, "compute_route", **goal))

    def track(self, **goal: Any) -> Any:
        keep = lambda message: self.feedback.append(message.feedback)  # noqa: E731
        return self.stage.send(ComputeAndTrackRoute, "compute_and_track_route", keep, **goal)

    def drive(self, *points: tuple[float, float]) -> None:
        """Put the robot on points 0.2 m apart on lines from where it is."""
        for point in points:
            start, end = self.robot.pose[:2].copy(), np.array(point)
            for share in np.linspace(0.0, 1.0, max(2, int(np.hypot(*(end - start)) / 0.2))):
                self.robot.pose[:2] = start + share * (end - start)
                self.stage.step()


def edges_of(route: Any) -> list[int]:
    return [edge.edgeid for edge in route.edges]


def test_a_route_between_nodes_and_between_poses(stage: SetStage, tmp_path: Path) -> None:
    bench = Bench(stage, tmp_path)
    markers = bench.stage.collect(MarkerArray, "/route_graph", LATCHED)
    status, result = bench.compute(start_id=0, goal_id=2)
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, 0)
    assert [node.nodeid for node in result.route.nodes] == [0, 1, 2]
    assert result.route.route_cost == 8.0
    path = path_array(result.path)
    assert (path[0, :2].tolist(), path[-1, :2].tolist()) == ([0.0, 0.0], [4.0, 4.0])
    bench.robot.pose = np.array([1.0, 0.2, 0.0])
    bench.stage.step_for(0.2)
    _, result = bench.compute(use_poses=True, goal=bench.pose(4.2, 4.3))
    assert edges_of(result.route) == [11]  # the first edge is passed already
    _, result = bench.compute(
        use_poses=True, use_start=True, start=bench.pose(0, 3, frame="odom"), goal=bench.pose(3, 4)
    )
    assert edges_of(result.route) == []
    bench.stage.step_until(lambda: bool(markers))
    assert {one.ns for one in markers[0].markers} >= {"route_graph_nodes", "route_graph_edges"}


@pytest.mark.parametrize(
    ("goal", "code", "reason"),
    [
        ({"start_id": 0, "goal_id": 9}, Result.INDETERMINANT_NODES_ON_GRAPH, "the goal node 9 does not exist"),
        ({"start_id": 7, "goal_id": 0}, Result.INDETERMINANT_NODES_ON_GRAPH, "the start node 7 does not exist"),
        ({"use_poses": True, "goal": ("elsewhere", 1.0)}, Result.TF_ERROR, "elsewhere"),
        ({"use_poses": True, "goal": ("map", float("nan"))}, Result.INDETERMINANT_NODES_ON_GRAPH, "not finite"),
    ],
)
def test_an_impossible_request_is_aborted_with_the_reason(
    stage: SetStage, tmp_path: Path, goal: Any, code: int, reason: str
) -> None:
    bench = Bench(stage, tmp_path)
    if "goal" in goal:
        goal = {**goal, "goal": bench.pose(goal["goal"][1], 0.0, frame=goal["goal"][0])}
    for status, result in (bench.compute(**goal), bench.stage.end(bench.track(**goal))):
        assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code), result.error_msg
        assert reason in result.error_msg


def test_without_a_graph_one_is_asked_for_and_can_be_set(
    stage: SetStage, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage, tmp_path, graph_filepath="")
    _, result = bench.compute(start_id=0, goal_id=1)
    assert result.error_code == ComputeRoute.Result.NO_VALID_GRAPH
    assert "set_route_graph" in result.error_msg
    service = "/route_server/set_route_graph"
    (tmp_path / "broken.geojson").write_text('{\n"features": [\n{]')
    assert not bench.stage.call(SetRouteGraph, service, graph_filepath=str(tmp_path / "broken.geojson")).success
    assert "broken.geojson:3: is not valid JSON" in capfd.readouterr().err
    assert bench.stage.call(SetRouteGraph, service, graph_filepath=str(bench.file)).success
    assert bench.compute(start_id=0, goal_id=1)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"graph_filepath": "/none.geojson"}, "/none.geojson: cannot be read"),
        ({"operations": ["Stop"], "Stop": {"plugin": "nav2_route::AdjustSpedLimit"}}, "did you mean 'nav2_route::Adj"),
        ({"edge_cost_functions": ["A"], "A": {"plugin": "nav2_route::DistanceScorer", "weight": -1.0}}, "at least 0"),
    ],
)
def test_what_cannot_be_followed_fails_the_configuration(
    stage: SetStage, capfd: pytest.CaptureFixture[str], parameters: Any, message: str
) -> None:
    server = stage({"/route_server": parameters}).add(RouteServer())
    assert server.trigger_configure() == TransitionCallbackReturn.FAILURE
    (line,) = [line for line in capfd.readouterr().err.splitlines() if "cannot configure" in line]
    assert message in line


def test_a_robot_is_tracked_with_its_operations(stage: SetStage, tmp_path: Path) -> None:
    door = {"a": {"type": "OpenDoor", "trigger": "ON_ENTER", "metadata": {"service_name": "/door"}}}
    bench = Bench(
        stage, tmp_path, graph={"e11": {"operations": door, "metadata": {"speed_limit": 60}}},
        operations=["AdjustSpeedLimit", "OpenDoor"], OpenDoor={"plugin": "nav2_route::TriggerEvent"},
    )  # fmt: skip
    limits = bench.stage.collect(SpeedLimit, "/speed_limit")
    opened: list[bool] = []

    def open_door(request: Any, response: Any) -> Any:
        opened.append(True)
        response.success = True
        return response

    bench.stage.node.create_service(Trigger, "/door", open_door)
    handle = bench.track(start_id=0, goal_id=2)
    bench.stage.step_until(lambda: bool(bench.feedback))
    assert bench.feedback[0].rerouted
    bench.drive((4.0, 0.0), (4.0, 4.0))
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE)
    assert result.execution_duration.sec >= 1
    seen = [(one.last_node_id, one.next_node_id, one.current_edge_id) for one in bench.feedback[1:]]
    assert list(dict.fromkeys(seen)) == [(0, 1, 10), (1, 2, 11), (2, 0, 0)]
    assert any("OpenDoor" in one.operations_triggered for one in bench.feedback)
    assert opened == [True]
    assert [one.speed_limit for one in limits] == [100.0, 60.0]


@pytest.mark.slow
def test_a_blocked_edge_is_routed_around_and_a_closed_graph_aborts(stage: SetStage, tmp_path: Path) -> None:
    monitor = {"plugin": "nav2_route::CollisionMonitor", "costmap_topic": "/seen", "rate": 20.0}
    bench = Bench(
        stage, tmp_path, operations=["CollisionMonitor"], CollisionMonitor=monitor, aggregate_blocked_ids=True
    )
    costmap = Costmap.filled(120, 120, 0.05, (-1.0, -1.0))
    bench.stage.publish("/seen", costmap_message(costmap, "odom", bench.stage.stamp), LATCHED)
    handle = bench.track(start_id=0, goal_id=2)
    bench.stage.step_until(lambda: any(one.current_edge_id == 10 for one in bench.feedback))
    costmap.costs[:, 60] = 254  # at x = 2
    bench.stage.publish("/seen", costmap_message(costmap, "odom", bench.stage.stamp), LATCHED)
    bench.stage.step_until(lambda: edges_of(bench.feedback[-1].route) == [23, 22])
    bench.drive((0.0, 0.0), (0.0, 2.0), (0.0, 3.95), (1.0, 4.0))
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.NO_VALID_ROUTE)
    assert "closed: 10, 22" in result.error_msg


def test_services_close_edges_and_ask_for_another_route(stage: SetStage, tmp_path: Path) -> None:
    bench = Bench(stage, tmp_path)
    handle = bench.track(start_id=0, goal_id=2)
    bench.drive((1.0, 0.0))
    bench.stage.step_until(lambda: bool(bench.feedback) and bench.feedback[-1].current_edge_id == 10)
    adjust = {"closed_edges": [11], "adjust_edges": [EdgeCost(edgeid=20, cost=1.0)]}
    assert bench.stage.call(DynamicEdges, "/route_server/DynamicEdgesScorer/adjust_edges", **adjust).success
    assert bench.stage.call(Trigger, "/route_server/ReroutingService/reroute").success
    bench.stage.step_until(lambda: edges_of(bench.feedback[-1].route) == [23, 22])
    bench.stage.result(handle.cancel_goal_async())
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_CANCELED


def test_another_route_along_the_same_edge_goes_on_from_where_the_robot_is(stage: SetStage, tmp_path: Path) -> None:
    bench = Bench(stage, tmp_path)
    handle = bench.track(start_id=0, goal_id=2)
    bench.drive((1.5, 0.3))
    assert bench.stage.call(Trigger, "/route_server/ReroutingService/reroute").success
    bench.stage.step_until(lambda: sum(one.rerouted for one in bench.feedback) == 2)
    (again,) = [one for one in bench.feedback if one.rerouted][1:]
    assert (edges_of(again.route), again.current_edge_id, again.last_node_id) == ([11], 10, 0)
    assert path_array(again.path)[0, :2] == pytest.approx([1.5, 0.0], abs=1e-6)
    bench.drive((4.0, 0.0), (4.0, 4.0))
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
@pytest.mark.parametrize("answer", [None, False])
def test_an_operation_that_fails_aborts(stage: SetStage, tmp_path: Path, answer: bool | None) -> None:
    door = {"a": {"type": "OpenDoor", "trigger": "NODE", "metadata": {"service_name": "/door"}}}
    bench = Bench(
        stage, tmp_path, graph={"n0": {"operations": door}}, operations=["OpenDoor"],
        OpenDoor={"plugin": "nav2_route::TriggerEvent"},
    )  # fmt: skip
    if answer is not None:
        bench.stage.node.create_service(Trigger, "/door", lambda request, response: response)
    status, result = bench.stage.end(bench.track(start_id=0, goal_id=2))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.OPERATION_FAILED)
    assert result.error_msg == f"OpenDoor: the service /door {'failed' if answer is False else 'is not there'}"


def test_an_unknown_operation_and_a_late_transform_abort(stage: SetStage, tmp_path: Path) -> None:
    stop = {"a": {"type": "stop", "trigger": "NODE"}}
    bench = Bench(stage, tmp_path, graph={"n2": {"operations": stop}})
    handle = bench.track(start_id=1, goal_id=2)
    bench.stage.robot = None
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TF_ERROR)
    assert "longer than 1 s" in result.error_msg
    bench.stage.robot = bench.robot
    bench.robot.pose = np.array([4.0, 4.0, 0.0])
    bench.stage.step_for(0.2)
    status, result = bench.stage.end(bench.track(start_id=2, goal_id=2))
    assert result.error_code == Result.OPERATION_FAILED
    assert "the operation 'stop', which is not among" in result.error_msg


def test_another_goal_replaces_the_first(stage: SetStage, tmp_path: Path) -> None:
    bench = Bench(stage, tmp_path)
    first = bench.track(start_id=0, goal_id=2)
    second = bench.track(start_id=0, goal_id=1)
    status, result = bench.stage.end(first)
    assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "replaced by another goal")
    bench.drive((4.0, 0.0))
    assert bench.stage.end(second)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
def test_goals_and_requests_of_any_content_are_answered(stage: SetStage, tmp_path: Path) -> None:
    bench, source = Bench(stage, tmp_path), random.Random(1)
    for number in range(120):
        bench.stage.call(SetRouteGraph, "/route_server/set_route_graph", graph_filepath=source.choice(TEXTS))
        goal = {
            "start_id": source.randrange(2**16), "goal_id": source.randrange(2**16),
            "start": hostile_pose(source, bench.pose(0.0, 0.0)), "goal": hostile_pose(source, bench.pose(0.0, 0.0)),
            "use_start": source.random() < 0.5, "use_poses": source.random() < 0.7,
        }  # fmt: skip
        status, result = bench.compute(**goal)
        if status == GoalStatus.STATUS_SUCCEEDED:
            assert np.isfinite(path_array(result.path)).all(), (number, goal)
            assert goal["use_poses"], (number, goal)
        else:
            assert result.error_code != ComputeRoute.Result.NONE, (number, goal)
            assert 0 < len(result.error_msg) < 7000, (number, goal)
    status, result = bench.compute(start_id=0, goal_id=2)
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, 0)
