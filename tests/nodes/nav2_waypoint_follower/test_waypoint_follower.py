"""The server that follows waypoints, with the test as the navigator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from nav2_msgs.action import FollowWaypoints, NavigateToPose
from rclpy.action import ActionServer, CancelResponse
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.task import Future
from std_msgs.msg import Empty

from daidalos.nodes.conversions import pose_stamped
from daidalos.nodes.nav2_waypoint_follower.waypoint_follower import WaypointFollower
from daidalos.samples.fields import time_message
from nodes.stepped import Stage

pytestmark = pytest.mark.timeout(300)

Result = FollowWaypoints.Result
WAIT = {"wait_at_waypoint": {"plugin": "nav2_waypoint_follower::WaitAtWaypoint", "waypoint_pause_duration": 200}}


class Navigator:
    """A navigator that reaches poses at once, fails for those with a negative x, and drives on for x above 10."""

    def __init__(self, stage: Stage) -> None:
        self.reached: list[float] = []
        self.cancelled = 0
        self._server = ActionServer(
            stage.node, NavigateToPose, "navigate_to_pose", self._drive, cancel_callback=self._cancel
        )
        self._never = Future()

    def _cancel(self, goal: Any) -> CancelResponse:
        self.cancelled += 1
        self._never.set_result(None)
        return CancelResponse.ACCEPT

    async def _drive(self, goal: Any) -> Any:
        x = goal.request.pose.pose.position.x
        if x > 10.0:
            await self._never
            goal.canceled()
            return NavigateToPose.Result()
        if x < 0.0:
            goal.abort()
            return NavigateToPose.Result(error_code=9001, error_msg="there is no way")
        self.reached.append(x)
        goal.succeed()
        return NavigateToPose.Result()


class Bench:
    def __init__(self, stage: Stage, *, has_navigator: bool = True) -> None:
        self.stage = stage
        self.navigator = Navigator(stage) if has_navigator else None
        self.server = stage.add(WaypointFollower())
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.feedback: list[int] = []
        stage.step()

    def send(self, *places: float, **goal: Any) -> Any:
        poses = [pose_stamped((x, 0.0, 0.0), "map", time_message(0)) for x in places]
        return self.stage.send(
            FollowWaypoints, "follow_waypoints",
            lambda message: self.feedback.append(message.feedback.current_waypoint), poses=poses, **goal,
        )  # fmt: skip

    def follow(self, *places: float, **goal: Any) -> tuple[int, Any]:
        return self.stage.end(self.send(*places, **goal))


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage({"/waypoint_follower": {"stop_on_failure": False, **WAIT}}))


def test_waypoints_are_visited_in_order_with_a_pause_at_each(bench: Bench) -> None:
    begun = bench.stage.now
    status, result = bench.follow(1.0, 2.0, 3.0, goal_index=1, number_of_loops=1)
    assert (status, result.error_code, result.missed_waypoints) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, [])
    assert bench.navigator.reached == [2.0, 3.0, 1.0, 2.0, 3.0]
    assert bench.feedback == [1, 2, 0, 1, 2]
    assert bench.stage.now - begun > 5 * 0.2


def test_missed_waypoints_are_reported(bench: Bench) -> None:
    status, result = bench.follow(1.0, -2.0, 3.0)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert [(one.index, one.error_code) for one in result.missed_waypoints] == [(1, 9001)]
    assert bench.navigator.reached == [1.0, 3.0]


def test_a_missed_waypoint_may_end_the_goal(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({"/waypoint_follower": WAIT}))
    status, result = bench.follow(1.0, -2.0, 3.0)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, 9001)
    assert [one.index for one in result.missed_waypoints] == [1]
    assert bench.navigator.reached == [1.0]


def test_cancelling_takes_the_navigators_goal_back(bench: Bench) -> None:
    handle = bench.send(1.0, 11.0, 3.0)
    bench.stage.step_until(lambda: bench.feedback == [0, 1])
    bench.stage.step_for(0.5)
    bench.stage.result(handle.cancel_goal_async())
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_CANCELED
    bench.stage.step_until(lambda: bench.navigator.cancelled == 1)
    assert bench.navigator.reached == [1.0]


@pytest.mark.parametrize(("places", "goal"), [((), {}), ((1.0,), {"goal_index": 1})])
def test_goals_without_waypoints_are_rejected(bench: Bench, places: Any, goal: dict[str, Any]) -> None:
    assert not bench.send(*places, **goal).accepted


def test_without_a_navigator_all_waypoints_are_missed(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({"/waypoint_follower": {"stop_on_failure": False}}), has_navigator=False)
    assert [one.index for one in bench.follow(1.0, 2.0)[1].missed_waypoints] == [0, 1]


@pytest.mark.parametrize("answers", [True, False])
def test_an_input_is_waited_for(stage: Callable[[dict[str, Any]], Stage], answers: bool) -> None:
    task = {"plugin": "nav2_waypoint_follower::InputAtWaypoint", "timeout": 1.0, "input_topic": "/go_on"}
    bench = Bench(stage({"/waypoint_follower": {"waypoint_task_executor_plugin": "input", "input": task}}))
    handle = bench.send(1.0)
    bench.stage.step_until(lambda: bench.navigator.reached == [1.0])
    bench.stage.step_for(0.3)
    if answers:
        bench.stage.publish("/go_on", Empty())
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (
        (GoalStatus.STATUS_SUCCEEDED, Result.NONE)
        if answers
        else (GoalStatus.STATUS_ABORTED, Result.TASK_EXECUTOR_FAILED)
    )
