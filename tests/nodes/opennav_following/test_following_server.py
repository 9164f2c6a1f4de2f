"""The server that follows objects, with a robot and an object that the test plays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import PoseStamped
from rclpy.lifecycle import TransitionCallbackReturn
from rosidl_runtime_py.utilities import get_action
from tf2_msgs.msg import TFMessage

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.nodes.conversions import pose_stamped, transform_stamped
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message
from daidalos.nodes.opennav_following._following_server import FollowingServer
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(200)]

FollowObject: Any = get_action("nav2_msgs/action/FollowObject")
Result, Feedback = FollowObject.Result, FollowObject.Feedback
SetStage = Callable[[dict[str, Any]], Stage]


class Bench:
    """A robot at the origin, and an object 3 m ahead that may move at a velocity (x, y) [m/s]."""

    def __init__(self, set_stage: SetStage, **parameters: Any) -> None:
        values = {"controller_frequency": 20.0, "detection_timeout": 0.5, "max_retries": 0, **parameters}
        self.stage = set_stage({"/following_server": values})
        self.robot = self.stage.add_robot()
        self.server = self.stage.add(FollowingServer())
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.thing, self.velocity, self.is_seen = np.array([3.0, 0.0, 0.0]), np.zeros(2), True
        self.states: list[int] = []
        self._poses = self.stage.node.create_publisher(PoseStamped, "/person", 1)
        self._frames = self.stage.node.create_publisher(TFMessage, "/tf", 10)
        self.stage.node.create_timer(0.05, self._show)
        self.stage.step_for(0.3)

    def _show(self) -> None:
        self.thing[:2] += 0.05 * self.velocity
        if self.is_seen:
            self._poses.publish(pose_stamped(self.thing, "map", self.stage.stamp))
            self._frames.publish(TFMessage(transforms=[transform_stamped(self.thing, "odom", "dog", self.stage.stamp)]))

    def follow(self, **goal: Any) -> Any:
        goal = goal or {"pose_topic": "/person"}
        return self.stage.send(
            FollowObject, "follow_object", lambda one: self.states.append(one.feedback.state), **goal
        )

    def distance(self) -> float:
        return float(np.hypot(*(self.thing - self.robot.pose)[:2]))


@pytest.mark.parametrize("goal", [{"pose_topic": "/person"}, {"tracked_frame": "dog"}])
def test_an_object_is_followed_at_a_distance(stage: SetStage, goal: dict[str, str]) -> None:
    bench = Bench(stage, filter_coef=0.5)
    handle = bench.follow(**goal)
    bench.stage.step_until(lambda: Feedback.STOPPING in bench.states)
    assert bench.distance() == pytest.approx(1.0, abs=0.2)
    assert bench.robot.is_standing
    bench.velocity = np.array([0.1, 0.12])
    bench.stage.step_for(12.0)
    assert 0.7 < bench.distance() < 1.9
    ahead = math.atan2(*(bench.thing - bench.robot.pose)[1::-1])
    assert abs(math.remainder(bench.robot.pose[2] - ahead, 2.0 * math.pi)) < 0.6
    bench.stage.result(handle.cancel_goal_async())
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_CANCELED, Result.NONE)
    assert bench.robot.is_standing
    assert {Feedback.CONTROLLING, Feedback.STOPPING} <= set(bench.states)


def test_the_heading_of_the_object_may_count(stage: SetStage) -> None:
    bench = Bench(stage, skip_orientation=False, desired_distance=0.8, filter_coef=0.0)
    bench.thing[2] = 0.6
    bench.follow()
    bench.stage.step_until(lambda: Feedback.STOPPING in bench.states)
    expected = bench.thing[:2] - 0.8 * np.array([math.cos(0.6), math.sin(0.6)])
    assert bench.robot.pose[:2] == pytest.approx(expected, abs=0.2)
    assert bench.robot.pose[2] == pytest.approx(0.6, abs=0.2)


def test_the_goal_is_reached_when_the_object_stands_or_the_time_is_over(stage: SetStage) -> None:
    bench = Bench(stage, static_object_timeout=1.0)
    status, result = bench.stage.end(bench.follow())
    assert (status, result.error_code, result.num_retries) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, 0)
    assert bench.distance() == pytest.approx(1.0, abs=0.2)
    bench.thing[0] += 5.0
    begun = bench.stage.now
    status, result = bench.stage.end(bench.follow(pose_topic="/person", max_duration=Duration(sec=2)))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert bench.stage.now - begun == pytest.approx(2.0, abs=0.3)
    assert result.total_elapsed_time.sec == 2
    assert bench.robot.is_standing


def test_the_robot_stands_when_the_object_is_lost(stage: SetStage) -> None:
    bench = Bench(stage, max_retries=1)
    handle = bench.follow()
    bench.stage.step_until(lambda: not bench.robot.is_standing)
    bench.is_seen = False
    bench.stage.step_for(0.7)
    assert bench.robot.is_standing
    bench.is_seen = True
    bench.stage.step_until(lambda: not bench.robot.is_standing)  # one retry
    bench.is_seen = False
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.FAILED_TO_DETECT_OBJECT)
    assert result.num_retries == 2
    assert Feedback.RETRY in bench.states


def test_the_robot_turns_to_find_the_object(stage: SetStage) -> None:
    bench = Bench(stage, max_retries=1, search_by_rotating=True, search_angle=0.8)
    bench.is_seen = False
    handle = bench.follow()
    bench.stage.step_until(lambda: bench.robot.pose[2] > 0.6)
    bench.stage.step_until(lambda: bench.robot.pose[2] < -0.6)
    bench.is_seen = True
    bench.stage.step_until(lambda: Feedback.STOPPING in bench.states)
    bench.stage.result(handle.cancel_goal_async())
    assert bench.stage.end(handle)[1].num_retries == 1


def test_a_robot_that_is_no_longer_localized_stops(stage: SetStage) -> None:
    bench = Bench(stage, fixed_frame="map", data_timeout=0.3)
    handle = bench.follow()
    bench.stage.step_until(lambda: not bench.robot.is_standing)
    bench.robot.is_localized = False
    place = bench.robot.pose
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TF_ERROR)
    assert np.hypot(*(bench.robot.pose - place)[:2]) < 0.2


def test_obstacles_stop_the_robot_where_that_is_asked_for(stage: SetStage) -> None:
    bench = Bench(stage, controller={"use_collision_detection": True})
    costmap = Costmap.filled(120, 80, 0.05, (-1.0, -2.0))
    costmap.costs[:, 40:44] = 254  # at x = 1.0
    bench.stage.publish("/local_costmap/costmap_raw", costmap_message(costmap, "odom", bench.stage.stamp), LATCHED)
    status, result = bench.stage.end(bench.follow())
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.FAILED_TO_CONTROL)
    assert bench.robot.pose[0] < 1.0


def test_goals_without_an_object_are_refused_and_another_one_takes_the_place(stage: SetStage) -> None:
    bench = Bench(stage)
    assert not bench.follow(max_duration=Duration(sec=1)).accepted
    first = bench.follow()
    bench.stage.step_until(lambda: not bench.robot.is_standing)
    second = bench.follow(tracked_frame="dog")
    status, result = bench.stage.end(first)
    assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "replaced by another goal")
    assert bench.server.trigger_deactivate() == TransitionCallbackReturn.SUCCESS
    assert bench.stage.end(second)[0] == GoalStatus.STATUS_ABORTED
    bench.stage.step()
    assert bench.robot.is_standing
