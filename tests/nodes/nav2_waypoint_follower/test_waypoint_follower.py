"""The server that follows waypoints, with the test as the navigator."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from cv_bridge import CvBridge
from geographic_msgs.msg import GeoPose
from geometry_msgs.msg import Point
from nav2_msgs.action import FollowGPSWaypoints, FollowWaypoints, NavigateToPose
from PIL import Image as pillow
from rclpy.action import ActionServer, CancelResponse
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.task import Future
from robot_localization.srv import FromLL
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


@pytest.mark.parametrize(("encoding", "mode"), [("rgb8", "RGB"), ("bgr8", "RGB"), ("mono8", "L")])
def test_a_photo_is_saved(stage: Callable[[dict[str, Any]], Stage], tmp_path: Path, encoding: str, mode: str) -> None:
    folder = tmp_path / "new" / "photos"
    task = {"plugin": "nav2_waypoint_follower::PhotoAtWaypoint", "image_topic": "/camera", "save_dir": str(folder)}
    bench = Bench(stage({"/waypoint_follower": {"waypoint_task_executor_plugin": "photo", "photo": task}}))
    pixels = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)
    pixels = pixels[..., 0] if mode == "L" else pixels
    bench.stage.publish("/camera", CvBridge().cv2_to_imgmsg(np.ascontiguousarray(pixels), encoding))
    bench.stage.step()
    assert bench.follow(1.0, 2.0)[0] == GoalStatus.STATUS_SUCCEEDED
    first, second = sorted(folder.iterdir())
    assert first.name.startswith("0_1")
    assert (second.name[:2], second.suffix) == ("1_", ".png")
    with pillow.open(first) as image:
        assert image.mode == mode
        assert np.array_equal(np.asarray(image), pixels[..., ::-1] if encoding == "bgr8" else pixels)


def test_without_an_image_the_task_fails(stage: Callable[[dict[str, Any]], Stage], tmp_path: Path) -> None:
    task = {"plugin": "nav2_waypoint_follower::PhotoAtWaypoint", "save_dir": str(tmp_path)}
    bench = Bench(stage({"/waypoint_follower": {"waypoint_task_executor_plugin": "photo", "photo": task}}))
    status, result = bench.follow(1.0)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TASK_EXECUTOR_FAILED)


def _places(*latitudes: float) -> list[GeoPose]:
    places = [GeoPose() for _ in latitudes]
    for place, latitude in zip(places, latitudes, strict=True):
        place.position.latitude = latitude
    return places


def test_places_on_the_earth_are_visited(bench: Bench) -> None:
    def convert(request: Any, response: Any) -> Any:
        response.map_point = Point(x=request.ll_point.latitude - 45.0)
        return response

    bench.stage.node.create_service(FromLL, "/fromLL", convert)
    feedback: list[int] = []
    handle = bench.stage.send(
        FollowGPSWaypoints, "follow_gps_waypoints",
        lambda message: feedback.append(message.feedback.current_waypoint), gps_poses=_places(46.0, 47.0, 44.0),
    )  # fmt: skip
    status, result = bench.stage.end(handle)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert bench.navigator.reached == [1.0, 2.0]
    assert feedback == [0, 1, 2]
    assert [(one.index, one.error_code, one.goal.header.frame_id) for one in result.missed_waypoints] == [
        (2, 9001, "map")
    ]


@pytest.mark.parametrize(("is_served", "words"), [(False, "/fromLL is not served"), (True, "knows no place")])
def test_places_that_cannot_be_converted_abort_the_goal(bench: Bench, is_served: bool, words: str) -> None:
    if is_served:
        bench.stage.node.create_service(
            FromLL, "/fromLL", lambda request, response: FromLL.Response(map_point=Point(x=math.nan))
        )
        bench.stage.step_for(0.5)
    handle = bench.stage.send(FollowGPSWaypoints, "follow_gps_waypoints", gps_poses=_places(46.0))
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowGPSWaypoints.Result.UNKNOWN)
    assert words in result.error_msg
