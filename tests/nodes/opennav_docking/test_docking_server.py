"""The server that docks and undocks, with a robot that the test plays."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from nav2_msgs.action import DockRobot, NavigateToPose, UndockRobot
from nav2_msgs.srv import ReloadDockDatabase
from rclpy.action import ActionServer
from rclpy.lifecycle import TransitionCallbackReturn
from sensor_msgs.msg import BatteryState

from daidalos.common.pose2 import wrap
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.nodes.conversions import pose2_of, pose_stamped
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message
from daidalos.nodes.opennav_docking._docking_server import DockingServer
from nodes.hostile_values import TEXTS, hostile_pose
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

Result = DockRobot.Result
Feedback = DockRobot.Feedback
SetStage = Callable[[dict[str, Any]], Stage]
PLAIN: dict[str, Any] = {"plugin": "opennav_docking::SimpleChargingDock", "use_battery_status": False}
SEEN: dict[str, Any] = {
    **PLAIN, "use_external_detection_pose": True, "external_detection_rotation_pitch": 0.0,
    "external_detection_rotation_roll": 0.0, "external_detection_translation_x": 0.0,
}  # fmt: skip
HOME = np.array([2.0, 0.5, 0.4])


class Bench:
    def __init__(self, set_stage: SetStage, dock: dict[str, Any] = PLAIN, /, **parameters: Any) -> None:
        controller = {"use_collision_detection": False, **parameters.pop("controller", {})}
        home = {"type": "simple", "frame": "map", "pose": HOME.tolist()}
        values = {
            "dock_plugins": ["simple"], "simple": dock, "docks": ["home"], "home": home, "controller": controller,
            "controller_frequency": 20.0, "initial_perception_timeout": 1.0, "max_retries": 0, **parameters,
        }  # fmt: skip
        self.stage = set_stage({"/docking_server": values})
        self.robot = self.stage.add_robot()
        self.server = self.stage.add(DockingServer())
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.stage.step_for(0.2)
        self.states: list[int] = []
        self.staged: list[np.ndarray] = []
        self.marker: np.ndarray | None = None

    def navigate(self) -> None:
        """Serve ``navigate_to_pose`` by putting the robot where it is asked to be."""

        async def drive(goal: Any) -> Any:
            self.robot.pose = pose2_of(goal.request.pose.pose)
            self.staged.append(self.robot.pose)
            goal.succeed()
            return NavigateToPose.Result()

        ActionServer(self.stage.node, NavigateToPose, "navigate_to_pose", drive)

    def send(self, **goal: Any) -> Any:
        goal = goal or {"dock_id": "home", "navigate_to_staging_pose": False}
        return self.stage.send(DockRobot, "dock_robot", lambda one: self.states.append(one.feedback.state), **goal)

    def step_until(self, condition: Callable[[], bool]) -> None:
        """Step, with a marker that is seen, until a condition holds."""
        topic = self.stage.node.create_publisher(
            type(pose_stamped(HOME, "", self.stage.stamp)), "detected_dock_pose", 1
        )

        def show() -> bool:
            if self.marker is not None:
                topic.publish(pose_stamped(self.marker, "odom", self.stage.stamp))
            return condition()

        self.stage.step_until(show)

    def end(self, handle: Any) -> tuple[int, Any]:
        answer = handle.get_result_async()
        self.step_until(answer.done)
        assert self.robot.is_standing
        return answer.result().status, answer.result().result


@pytest.mark.slow
def test_a_robot_stages_docks_and_undocks(stage: SetStage) -> None:
    bench = Bench(stage)
    bench.navigate()
    status, result = bench.end(bench.send(dock_id="home"))
    assert (status, result.success, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, True, Result.NONE)
    staging = HOME + np.array([-0.7 * math.cos(0.4), -0.7 * math.sin(0.4), 0.0])
    assert bench.staged[0] == pytest.approx(staging)
    assert np.hypot(*(bench.robot.pose - HOME)[:2]) < 0.05
    assert abs(wrap(bench.robot.pose[2] - HOME[2])) < 0.05
    states = [Feedback.NAV_TO_STAGING_POSE, Feedback.INITIAL_PERCEPTION, Feedback.CONTROLLING]
    assert list(dict.fromkeys(bench.states)) == states
    docked = len(bench.robot.commands)
    assert bench.end(bench.send(dock_id="home"))[1].success  # already there
    assert not any(command.any() for command in bench.robot.commands[docked:])
    status, result = bench.end(bench.stage.send(UndockRobot, "undock_robot", max_undocking_time=20.0))
    assert (status, result.success) == (GoalStatus.STATUS_SUCCEEDED, True)
    assert bench.robot.pose == pytest.approx(staging, abs=0.1)
    assert bench.end(bench.stage.send(UndockRobot, "undock_robot"))[1].success  # in no dock


@pytest.mark.slow
@pytest.mark.parametrize("rotate", [False, True])
def test_backward_docks(stage: SetStage, rotate: bool) -> None:
    dock = {**PLAIN, "plugin": "opennav_docking::SimpleNonChargingDock", "dock_direction": "backward"}
    dock |= {"rotate_to_dock": rotate, "staging_yaw_offset": 0.0 if rotate else math.pi}
    del dock["use_battery_status"]
    bench = Bench(stage, dock)
    bench.robot.pose = HOME + np.array([-0.7 * math.cos(0.4), -0.7 * math.sin(0.4), 0.0 if rotate else math.pi])
    assert bench.end(bench.send())[1].success
    assert np.hypot(*(bench.robot.pose - HOME)[:2]) < 0.05
    assert abs(wrap(bench.robot.pose[2] - HOME[2] - math.pi)) < 0.1
    status, result = bench.end(bench.stage.send(UndockRobot, "undock_robot", max_undocking_time=30.0))
    assert (status, result.success) == (GoalStatus.STATUS_SUCCEEDED, True), result.error_msg
    assert np.hypot(*(bench.robot.pose - HOME)[:2]) == pytest.approx(0.7, abs=0.1)
    assert abs(wrap(bench.robot.pose[2] - HOME[2] - (0.0 if rotate else math.pi))) < 0.1


@pytest.mark.slow
def test_a_dock_that_is_seen_elsewhere_is_docked_at_where_it_is_seen(stage: SetStage) -> None:
    bench = Bench(stage, {**SEEN, "filter_coef": 0.5})
    bench.robot.pose = np.array([1.3, 0.3, 0.2])
    bench.marker = HOME + np.array([0.1, -0.1, 0.1])
    assert bench.end(bench.send())[1].success
    assert np.hypot(*(bench.robot.pose - bench.marker)[:2]) < 0.06


@pytest.mark.slow
@pytest.mark.parametrize("how", ["never", "stops", "jumps"])
def test_a_dock_that_is_not_seen_stops_the_robot(stage: SetStage, how: str) -> None:
    bench = Bench(stage, SEEN)
    bench.robot.pose = np.array([0.0, 0.0, 0.2])
    bench.marker = None if how == "never" else HOME
    handle = bench.send()
    if how != "never":
        bench.step_until(lambda: bench.robot.pose[0] > 0.5)
        bench.marker = None if how == "stops" else HOME + np.array([2.0, 0.0, 0.0])
        place = bench.robot.pose
    status, result = bench.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.FAILED_TO_DETECT_DOCK)
    if how == "never":
        assert not any(command.any() for command in bench.robot.commands)
        assert "no pose has come" in result.error_msg
    else:
        assert np.hypot(*(bench.robot.pose - place)[:2]) < 0.35
        assert ("jumped by 2" in result.error_msg) == (how == "jumps")


@pytest.mark.slow
def test_a_dock_that_is_lost_is_tried_again_from_the_staging_pose(stage: SetStage) -> None:
    bench = Bench(stage, SEEN, max_retries=1)
    bench.robot.pose = np.array([1.0, 0.2, 0.3])
    bench.marker = HOME
    handle = bench.send()
    bench.step_until(lambda: bench.robot.pose[0] > 1.6)
    bench.marker = None
    bench.step_until(lambda: bench.states[-1] == Feedback.RETRY)
    bench.marker = HOME
    status, result = bench.end(handle)
    assert (status, result.success, result.num_retries) == (GoalStatus.STATUS_SUCCEEDED, True, 1)
    assert np.hypot(*(bench.robot.pose - HOME)[:2]) < 0.06


@pytest.mark.slow
@pytest.mark.parametrize(
    ("parameters", "goal", "code", "reason"),
    [
        ({}, {"dock_id": "hom"}, Result.DOCK_NOT_IN_DB, "there is no dock 'hom'; did you mean 'home'?"),
        ({}, {"use_dock_id": False, "dock_type": "big"}, Result.DOCK_NOT_VALID, "type 'big', which is not among"),
        ({}, {"dock_id": "home"}, Result.FAILED_TO_STAGE, "navigate_to_pose is not served"),
        ({"home": {"type": "simple", "frame": "hall", "pose": [0.0, 0.0, 0.0]}}, {"dock_id": "home"}, Result.UNKNOWN,
         "hall"),
        ({"dock_approach_timeout": 0.5}, {}, Result.FAILED_TO_CONTROL, "not reached in time"),
        ({"controller": {"use_collision_detection": True}}, {}, Result.FAILED_TO_CONTROL, "there is no costmap on"),
    ],
)  # fmt: skip
def test_a_goal_that_fails_is_aborted_with_the_reason(
    stage: SetStage, parameters: Any, goal: Any, code: int, reason: str
) -> None:
    bench = Bench(stage, PLAIN, **parameters)
    status, result = bench.end(bench.send(**goal))
    assert (status, result.error_code, result.success) == (GoalStatus.STATUS_ABORTED, code, False), result.error_msg
    assert reason in result.error_msg


@pytest.mark.slow
def test_obstacles_and_late_data_stop_the_robot(stage: SetStage) -> None:
    bench = Bench(stage, PLAIN, controller={"use_collision_detection": True}, data_timeout=5.0)
    costmap = Costmap.filled(120, 120, 0.05, (-3.0, -3.0))
    costmap.costs[:, 82] = 254  # at x = 1.1
    bench.stage.publish("/local_costmap/costmap_raw", costmap_message(costmap, "odom", bench.stage.stamp), LATCHED)
    status, result = bench.end(bench.send())
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.FAILED_TO_CONTROL)
    assert "obstacle on the way" in result.error_msg
    bench.stage.step_for(5.5)
    assert "s old, longer than 5 s" in bench.end(bench.send())[1].error_msg


def test_a_late_transform_stops_the_robot(stage: SetStage) -> None:
    bench = Bench(stage)
    handle = bench.send()
    bench.step_until(lambda: bench.robot.pose[0] > 0.1)
    bench.stage.robot = None
    status, result = bench.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.UNKNOWN)
    assert "longer than 1 s" in result.error_msg


@pytest.mark.slow
def test_a_charger_that_does_not_charge_and_one_that_does(stage: SetStage) -> None:
    bench = Bench(stage, {"plugin": "opennav_docking::SimpleChargingDock"}, wait_charge_timeout=0.5)
    bench.robot.pose = HOME - np.array([0.4, 0.15, 0.0])
    status, result = bench.end(bench.send())
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.FAILED_TO_CHARGE)
    bench.robot.pose = HOME - np.array([0.4, 0.15, 0.0])
    handle = bench.send()
    bench.step_until(lambda: Feedback.WAIT_FOR_CHARGE in bench.states[-1:])
    bench.stage.publish("/battery_state", BatteryState(current=2.0))
    assert bench.end(handle)[1].success


def test_cancelling_and_other_goals_stop_the_robot(stage: SetStage) -> None:
    bench = Bench(stage)
    handle = bench.send()
    bench.step_until(lambda: bench.robot.pose[0] > 0.1)
    bench.stage.result(handle.cancel_goal_async())
    assert bench.end(handle)[0] == GoalStatus.STATUS_CANCELED
    first = bench.send()
    bench.step_until(lambda: not bench.robot.is_standing)
    second = bench.stage.send(UndockRobot, "undock_robot", dock_type="simple")
    status, result = bench.stage.end(first)
    assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "replaced by another goal")
    assert bench.end(second)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
def test_docks_of_another_file_are_used(stage: SetStage, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bench = Bench(stage)
    service, file = "/docking_server/reload_database", tmp_path / "docks.yaml"
    file.write_text("docks: {east: {type: simple, pose: [1.0, 0.0, 0.0]}}")
    assert bench.stage.call(ReloadDockDatabase, service, filepath=str(file)).success
    assert bench.end(bench.send(dock_id="east", navigate_to_staging_pose=False))[1].success
    file.write_text("docks: {east: {type: simpel, pose: [1.0, 0.0, 0.0]}}")
    assert not bench.stage.call(ReloadDockDatabase, service, filepath=str(file)).success
    assert "did you mean 'simple'" in capfd.readouterr().err


def test_an_unknown_type_fails_the_configuration(stage: SetStage, capfd: pytest.CaptureFixture[str]) -> None:
    dock = {"plugin": "opennav_docking::SimpleChargerDock"}
    server = stage({"/docking_server": {"dock_plugins": ["dock"], "dock": dock}}).add(DockingServer())
    assert server.trigger_configure() == TransitionCallbackReturn.FAILURE
    assert "did you mean 'opennav_docking::SimpleChargingDock'" in capfd.readouterr().err


@pytest.mark.slow
def test_goals_and_requests_of_any_content_are_answered_and_move_nothing(stage: SetStage) -> None:
    bench, source = Bench(stage), random.Random(1)
    for number in range(60):
        bench.stage.call(ReloadDockDatabase, "/docking_server/reload_database", filepath=source.choice(TEXTS))
        goal = {
            "use_dock_id": source.random() < 0.3, "dock_id": source.choice(TEXTS), "dock_type": source.choice(TEXTS),
            "dock_pose": hostile_pose(source, pose_stamped(HOME, "map", bench.stage.stamp)),
            "max_staging_time": source.choice((math.nan, math.inf, -1.0, 0.0)),
            "navigate_to_staging_pose": source.random() < 0.5,
        }  # fmt: skip
        status, result = bench.end(bench.send(**goal))
        assert (status, result.success) == (GoalStatus.STATUS_ABORTED, False), (number, goal)
        assert 0 < len(result.error_msg) < 7000, (number, goal)
        time = source.choice((math.nan, math.inf, -1.0))
        bench.end(bench.stage.send(UndockRobot, "undock_robot", dock_type="none", max_undocking_time=time))
        assert np.isfinite(np.array(bench.robot.commands or [[0.0]])).all()
    assert bench.robot.pose == pytest.approx(np.zeros(3))
    assert bench.end(bench.send())[1].success
