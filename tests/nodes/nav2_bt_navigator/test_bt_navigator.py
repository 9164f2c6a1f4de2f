"""The navigator, with the test as planner, controller and robot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import (
    ComputePathThroughPoses,
    ComputePathToPose,
    ComputeRoute,
    FollowPath,
    NavigateThroughPoses,
    NavigateToPose,
)
from rclpy.action import ActionServer, CancelResponse
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.task import Future
from std_msgs.msg import String

from daidalos.nodes.conversions import path_message, pose2_of, pose_stamped
from daidalos.nodes.nav2_bt_navigator.bt_navigator import BtNavigator
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

TREE = """
<root main_tree_to_execute="MainTree">
  <BehaviorTree ID="MainTree">
    <Sequence>
      <ComputePathToPose goal="{goal}" path="{path}" planner_id="GridBased"
        error_code_id="{compute_path_error_code}" error_msg="{compute_path_error_msg}"/>
      <FollowPath path="{path}" controller_id="FollowPath"
        error_code_id="{follow_path_error_code}" error_msg="{follow_path_error_msg}"/>
    </Sequence>
  </BehaviorTree>
</root>
"""


def pose(x: float, y: float = 0.0, frame: str = "map") -> PoseStamped:
    return pose_stamped((x, y, 0.0), frame, time_message(0))


class PlayedServer:
    """An action server whose goals end when and as the test says.

    Attributes
    ----------
    handles : list
        The handles of its goals.
    """

    def __init__(self, stage: Stage, action: Any, name: str) -> None:
        self.handles: list[Any] = []
        self._ends: list[Future] = []
        self._action = action
        ActionServer(stage.node, action, name, self._execute, cancel_callback=self._on_cancel)

    async def _execute(self, handle: Any) -> Any:
        self.handles.append(handle)
        self._ends.append(Future())
        verdict, result = await self._ends[-1]
        getattr(handle, verdict)()
        return result

    def _on_cancel(self, handle: Any) -> CancelResponse:
        self._ends[self.handles.index(handle)].set_result(("canceled", self._action.Result()))
        return CancelResponse.ACCEPT

    def end(self, verdict: str = "succeed", **result: Any) -> None:
        """End the latest goal."""
        self._ends[-1].set_result((verdict, self._action.Result(**result)))


class Bench:
    """The navigator on a stage."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.robot = stage.add_robot()
        self.navigator = stage.add(BtNavigator())
        self.planner = PlayedServer(stage, ComputePathToPose, "compute_path_to_pose")
        self.controller = PlayedServer(stage, FollowPath, "follow_path")

    def start(self) -> Bench:
        assert self.navigator.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.navigator.trigger_activate() == TransitionCallbackReturn.SUCCESS
        return self

    def send(self, goal: PoseStamped, feedback: Callable[[Any], None] | None = None, tree: str = "") -> Any:
        self.stage.step()
        return self.stage.send(NavigateToPose, "navigate_to_pose", feedback, pose=goal, behavior_tree=tree)

    def plan(self, x: float) -> None:
        """Answer the next goal of the planner with a path along x."""
        count = len(self.controller.handles)
        self.stage.step_until(lambda: bool(self.planner.handles) and self.planner.handles[-1].is_active)
        path = np.stack([np.linspace(0.0, x, 11), np.zeros(11), np.zeros(11)], axis=1)
        self.planner.end(path=path_message(path, "map", self.stage.stamp))
        self.stage.step_until(lambda: len(self.controller.handles) > count)
        self.stage.step()  # the navigator learns that its goal was accepted

    def drive(self, goal: PoseStamped, **more: Any) -> Any:
        """Return the handle of a goal for which the controller is at work."""
        handle = self.send(goal, **more)
        assert handle.accepted
        self.plan(goal.pose.position.x)
        return handle


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """The file of a tree that plans once and follows."""
    file = tmp_path / "tree.xml"
    file.write_text(TREE)
    return file


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage], tree: Path) -> Bench:
    return Bench(stage({"/bt_navigator": {"default_nav_to_pose_bt_xml": str(tree)}})).start()


def test_a_goal_is_planned_to_and_followed(bench: Bench) -> None:
    feedback: list[Any] = []
    handle = bench.drive(pose(2.0), feedback=feedback.append)
    assert bench.planner.handles[0].request.goal == pose(2.0)
    assert bench.planner.handles[0].request.planner_id == "GridBased"
    assert len(bench.controller.handles[0].request.path.poses) == 11
    bench.robot.pose = np.array([0.5, 0.0, 0.0])
    bench.stage.step_for(1.0)
    latest = feedback[-1].feedback
    assert pose2_of(latest.current_pose.pose) == pytest.approx([0.5, 0.0, 0.0])
    assert latest.current_pose.header.frame_id == "map"
    assert latest.distance_remaining == pytest.approx(1.5, abs=0.11)
    assert (latest.navigation_time.sec, latest.number_of_recoveries) == (1, 0)
    bench.controller.end()
    status, result = bench.stage.end(handle)
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, 0, "")


def test_the_default_tree_replans_while_it_drives(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({})).start()
    handle = bench.drive(pose(2.0))
    bench.stage.step_until(lambda: len(bench.planner.handles) > 1)
    bench.planner.end(path=path_message(np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), "map", bench.stage.stamp))
    bench.stage.step_until(lambda: len(bench.controller.handles) > 1)
    bench.controller.end()
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
def test_several_poses_are_driven_through(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({})).start()
    planner = PlayedServer(bench.stage, ComputePathThroughPoses, "compute_path_through_poses")
    feedback: list[Any] = []
    bench.stage.step()
    poses = [pose(0.5), pose(1.0), pose(2.0)]
    handle = bench.stage.send(NavigateThroughPoses, "navigate_through_poses", feedback.append, poses=poses)
    assert handle.accepted
    path = path_message(np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), "map", bench.stage.stamp)
    bench.stage.step_until(lambda: bool(planner.handles))
    assert list(planner.handles[0].request.goals) == poses[1:]  # the first is within 0.7 m
    assert not bench.send(pose(9.0)).accepted  # another navigator is busy
    planner.end(path=path)
    bench.stage.step_until(lambda: bool(bench.controller.handles))
    bench.robot.pose = np.array([0.9, 0.0, 0.0])
    bench.stage.step_until(lambda: len(planner.handles) > 1)
    assert list(planner.handles[1].request.goals) == poses[2:]
    planner.end(path=path_message(np.array([[0.9, 0.0, 0.0], [2.0, 0.0, 0.0]]), "map", bench.stage.stamp))
    bench.stage.step_until(lambda: feedback[-1].feedback.number_of_poses_remaining == 1)
    bench.stage.step_until(lambda: len(bench.controller.handles) > 1)
    bench.controller.end()
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


def test_no_poses_are_rejected(bench: Bench) -> None:
    assert not bench.stage.send(NavigateThroughPoses, "navigate_through_poses").accepted


def test_a_tree_cancels_the_controller_and_takes_the_chosen_one(
    stage: Callable[[dict[str, Any]], Stage], tmp_path: Path
) -> None:
    file = tmp_path / "cancel.xml"
    file.write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="T"><Sequence>'
        '<ControllerSelector default_controller="A" selected_controller="{c}"/>'
        '<ComputePathToPose goal="{goal}" path="{path}"/>'
        '<ReactiveFallback><Sequence><TimeExpired seconds="1"/><CancelControl/></Sequence>'
        '<FollowPath path="{path}" controller_id="{c}"/></ReactiveFallback></Sequence></BehaviorTree></root>'
    )
    bench = Bench(stage({"/bt_navigator": {"default_nav_to_pose_bt_xml": str(file)}})).start()
    assert bench.stage.end(bench.drive(pose(2.0)))[0] == GoalStatus.STATUS_SUCCEEDED
    assert bench.controller.handles[0].request.controller_id == "A"
    bench.stage.publish("controller_selector", String(data="B"), LATCHED)
    bench.stage.step_for(0.2)
    bench.drive(pose(2.0))
    assert bench.controller.handles[1].request.controller_id == "B"


@pytest.mark.slow
def test_a_goal_may_name_its_tree(stage: Callable[[dict[str, Any]], Stage], tree: Path) -> None:
    bench = Bench(stage({})).start()
    bench.drive(pose(2.0), tree=str(tree))
    bench.stage.step_for(3.0)
    assert len(bench.planner.handles) == 1


def test_a_clicked_pose_is_a_goal(bench: Bench) -> None:
    bench.stage.publish("goal_pose", pose(3.0))
    bench.plan(3.0)
    assert bench.planner.handles[0].request.goal == pose(3.0)


def test_a_pose_that_is_clicked_too_early_is_driven_to_when_it_is_active(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    bench = Bench(stage({}))
    bench.navigator.trigger_configure()
    bench.stage.publish("goal_pose", pose(3.0))
    bench.stage.step_for(0.5)
    assert bench.planner.handles == []
    bench.navigator.trigger_activate()
    bench.plan(3.0)
    assert len(bench.planner.handles) == 1


def test_goals_are_rejected_while_it_is_not_active(bench: Bench) -> None:
    bench.navigator.trigger_deactivate()
    assert not bench.send(pose(1.0)).accepted


def test_a_goal_in_an_unknown_frame_is_rejected(bench: Bench, capfd: pytest.CaptureFixture[str]) -> None:
    assert not bench.send(pose(1.0, frame="nowhere")).accepted
    assert "the frame 'nowhere' is not known" in capfd.readouterr().err
    assert bench.send(pose(1.0, frame="odom")).accepted


def test_cancelling_halts_the_tree(bench: Bench) -> None:
    handle = bench.drive(pose(2.0))
    bench.stage.result(handle.cancel_goal_async())
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_CANCELED
    following = bench.controller.handles[0]
    bench.stage.step_until(lambda: following.status == GoalStatus.STATUS_CANCELED)


def test_a_new_goal_replaces_the_one_that_is_driven_to(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({})).start()
    first = bench.drive(pose(2.0))
    second = bench.send(pose(-1.0))
    status, result = bench.stage.end(first)
    assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "replaced by another goal")
    bench.stage.step_until(lambda: bench.planner.handles[-1].request.goal == pose(-1.0))
    bench.plan(-1.0)
    third = bench.send(pose(4.0))
    assert bench.stage.end(second)[0] == GoalStatus.STATUS_ABORTED
    bench.stage.step_until(lambda: bench.planner.handles[-1].request.goal == pose(4.0))
    bench.plan(4.0)
    bench.controller.end()
    assert bench.stage.end(third)[0] == GoalStatus.STATUS_SUCCEEDED
    bench.drive(pose(1.0))


def test_the_last_of_several_goals_can_be_cancelled(bench: Bench) -> None:
    bench.drive(pose(2.0))
    second = bench.send(pose(-1.0))
    bench.stage.result(second.cancel_goal_async())
    assert bench.stage.end(second)[0] == GoalStatus.STATUS_CANCELED
    bench.drive(pose(1.0))


@pytest.mark.parametrize(
    ("server", "code", "message"),
    [
        ("planner", ComputePathToPose.Result.NO_VALID_PATH, "no way leads there"),
        ("controller", FollowPath.Result.FAILED_TO_MAKE_PROGRESS, "the robot is stuck"),
    ],
)
def test_the_reason_of_a_failure_comes_through(bench: Bench, server: str, code: int, message: str) -> None:
    handle = bench.send(pose(2.0))
    if server == "controller":
        bench.plan(2.0)
    played = getattr(bench, server)
    bench.stage.step_until(lambda: bool(played.handles))
    played.end("abort", error_code=code, error_msg=message)
    status, result = bench.stage.end(handle)
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_ABORTED, code, message)


def test_an_error_of_a_route_is_reported_by_the_prefix_of_its_name(
    stage: Callable[[dict[str, Any]], Stage], tmp_path: Path
) -> None:
    """The route server, played by the test, has no graph; Kilted's parameters have prefixes of names."""
    file = tmp_path / "route.xml"
    node = '<ComputeRoute goal_id="1" error_code_id="{dock_route_error_code}" error_msg="{dock_route_error_msg}"/>'
    file.write_text(TREE[: TREE.index("<Sequence>")] + node + TREE[TREE.index("</Sequence>") + 11 :])
    prefixes = ["dock_route", "compute_route"]
    parameters = {"default_nav_to_pose_bt_xml": str(file), "error_code_name_prefixes": prefixes}
    test = stage({"/bt_navigator": parameters})
    test.add_robot()

    async def abort(goal: Any) -> Any:
        goal.abort()
        return ComputeRoute.Result(error_code=ComputeRoute.Result.NO_VALID_GRAPH, error_msg="there is no graph")

    ActionServer(test.node, ComputeRoute, "compute_route", abort)
    for name in prefixes:
        file.write_text(file.read_text().replace("dock_route", name))
        navigator = test.add(BtNavigator())
        navigator.trigger_configure()
        navigator.trigger_activate()
        status, result = test.end(test.send(NavigateToPose, "navigate_to_pose", pose=pose(1.0)))
        assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "there is no graph")
        assert result.error_code == ComputeRoute.Result.NO_VALID_GRAPH
        navigator.trigger_deactivate()
        navigator.trigger_cleanup()


def test_scripts_see_the_number_of_an_error_and_their_own_errors_are_the_reason(bench: Bench, tmp_path: Path) -> None:
    number = ComputePathToPose.Result.NO_VALID_PATH
    follow = f'<FollowPath _skipIf="compute_path_error_code == {number} &amp;&amp; speed &gt; 1" path="{{path}}"'
    text = TREE.replace("<Sequence>", "<Fallback>").replace("</Sequence>", "</Fallback>")
    file = tmp_path / "scripts.xml"
    file.write_text(text.replace('<FollowPath path="{path}"', follow))
    handle = bench.send(pose(2.0), tree=str(file))
    bench.stage.step_until(lambda: bool(bench.planner.handles))
    bench.planner.end("abort", error_code=number, error_msg="no way leads there")
    status, result = bench.stage.end(handle)
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_msg.startswith(f"{file}:7: ")
    assert result.error_msg.endswith("there is no entry 'speed' on the blackboard")
    assert not bench.controller.handles


def test_a_server_that_is_not_there_is_named(stage: Callable[[dict[str, Any]], Stage], tree: Path) -> None:
    test = stage({"/bt_navigator": {"default_nav_to_pose_bt_xml": str(tree)}})
    navigator = test.add(BtNavigator())
    navigator.trigger_configure()
    navigator.trigger_activate()
    status, result = test.end(test.send(NavigateToPose, "navigate_to_pose", pose=pose(1.0)))
    assert status == GoalStatus.STATUS_ABORTED
    assert "compute_path_to_pose is not served" in result.error_msg


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (None, "cannot be read"),
        ("<root", "tree2.xml"),
        (TREE.replace("FollowPath path", "FolowPath path"), "FollowPath"),
    ],
)
@pytest.mark.parametrize("default", [True, False])
def test_a_faulty_tree_is_named(
    stage: Callable[[dict[str, Any]], Stage],
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
    text: str | None,
    reason: str,
    default: bool,
) -> None:
    file = tmp_path / "tree2.xml"
    if text is not None:
        file.write_text(text)
    bench = Bench(stage({"/bt_navigator": {"default_nav_to_pose_bt_xml": str(file) if default else ""}}))
    if default:
        assert bench.navigator.trigger_configure() == TransitionCallbackReturn.FAILURE
        assert bench.navigator.current_state.label == "unconfigured"
        message = capfd.readouterr().err
    else:
        status, result = bench.stage.end(bench.start().send(pose(1.0), tree=str(file)))
        assert status == GoalStatus.STATUS_ABORTED
        message = result.error_msg
    assert reason in message
    assert "Traceback" not in message


def test_deactivating_aborts_the_goal_and_halts_the_tree(bench: Bench) -> None:
    handle = bench.drive(pose(2.0))
    bench.navigator.trigger_deactivate()
    status, result = bench.stage.end(handle)
    assert status == GoalStatus.STATUS_ABORTED
    assert "deactivated" in result.error_msg
    following = bench.controller.handles[0]
    bench.stage.step_until(lambda: following.status == GoalStatus.STATUS_CANCELED)


def test_it_can_be_configured_again(bench: Bench) -> None:
    bench.drive(pose(2.0))
    bench.navigator.trigger_deactivate()
    assert bench.navigator.trigger_cleanup() == TransitionCallbackReturn.SUCCESS
    assert bench.stage.node.count_subscribers("goal_pose") == 0
    bench.start()
    handle = bench.drive(pose(1.0))
    bench.controller.end()
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


def test_shutdown_ends_it_for_good(bench: Bench) -> None:
    bench.drive(pose(2.0))
    assert bench.navigator.trigger_shutdown() == TransitionCallbackReturn.SUCCESS
    following = bench.controller.handles[0]
    bench.stage.step_until(lambda: following.status == GoalStatus.STATUS_CANCELED)
    assert bench.stage.node.count_subscribers("goal_pose") == 0
