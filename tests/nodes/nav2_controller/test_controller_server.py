"""The server that follows paths, with the test as its robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import TwistStamped
from nav2_msgs.action import FollowPath
from nav2_msgs.msg import Costmap, SpeedLimit
from nav_msgs.msg import Path
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.nodes.conversions import path_message
from daidalos.nodes.nav2_controller.controller_server import ControllerServer
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

COSTMAP = "/local_costmap/local_costmap"
PARAMETERS: dict[str, Any] = {
    "/controller_server": {
        "controller_plugins": ["FollowPath", "Other"],
        "FollowPath": {
            "plugin": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",
            "desired_linear_vel": 0.5,
        },
        "Other": {
            "plugin": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",
            "desired_linear_vel": 0.2,
        },
        "progress_checker": {"movement_time_allowance": 3.0},
    },
    COSTMAP: {
        "global_frame": "odom",
        "rolling_window": True,
        "width": 4.0,
        "height": 4.0,
        "update_frequency": 20.0,
        "publish_frequency": 20.0,
        "plugins": ["inflation_layer"],
    },
}


def changed(node: str, **values: Any) -> dict[str, Any]:
    """Return the parameters with other values for a node."""
    return {**PARAMETERS, node: {**PARAMETERS[node], **values}}


def straight(length: float, frame: str = "odom") -> Path:
    """Return a path along x."""
    along = np.arange(0.0, length + 0.025, 0.05)
    return path_message(np.stack([along, 0.0 * along, 0.0 * along], axis=1), frame, Path().header.stamp)


class Bench:
    """The server on a stage."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.robot = stage.add_robot()
        self.server = stage.add(ControllerServer())

    def start(self) -> Bench:
        """Bring the server up, and wait until its costmap is known."""
        costmaps = self.stage.collect(Costmap, f"{COSTMAP.rpartition('/')[0]}/costmap_raw", LATCHED)
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.stage.step_until(lambda: bool(costmaps))
        return self

    def send(self, path: Path, **goal: Any) -> Any:
        return self.stage.send(FollowPath, "follow_path", path=path, **goal)

    def drive(self, path: Path, **goal: Any) -> tuple[int, Any]:
        handle = self.send(path, **goal)
        assert handle.accepted
        return self.stage.end(handle)

    def drive_until_moving(self, path: Path, **goal: Any) -> Any:
        """Return the handle of a goal for which the robot drives."""
        handle = self.send(path, **goal)
        self.stage.step_until(lambda: not self.robot.is_standing)
        return handle


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage(PARAMETERS)).start()


@pytest.mark.slow
@pytest.mark.parametrize(("limit", "percentage", "fastest"), [(0.1, False, 0.1), (50.0, True, 0.25), (9.0, False, 0.5)])
def test_a_speed_limit_is_kept_until_it_is_removed(
    bench: Bench, limit: float, percentage: bool, fastest: float
) -> None:
    publisher = bench.stage.node.create_publisher(SpeedLimit, "speed_limit", 10)
    publisher.publish(SpeedLimit(speed_limit=limit, percentage=percentage))
    publisher.publish(SpeedLimit(speed_limit=math.nan))
    publisher.publish(SpeedLimit(speed_limit=-1.0))
    bench.stage.step_for(0.2)
    handle = bench.send(straight(1.5))
    bench.stage.step_for(1.0)
    assert max(command[0] for command in bench.robot.commands) == pytest.approx(fastest)
    publisher.publish(SpeedLimit())
    bench.stage.step_until(lambda: bench.robot.commands[-1][0] > 0.45)
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_path_is_driven_to_its_end(bench: Bench) -> None:
    feedback: list[Any] = []
    plans = bench.stage.collect(Path, "local_plan")
    handle = bench.stage.send(FollowPath, "follow_path", feedback.append, path=straight(1.0))
    status, result = bench.stage.end(handle)
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, 0, "")
    assert bench.robot.pose[:2] == pytest.approx([1.0, 0.0], abs=0.3)
    bench.stage.step_until(lambda: bench.robot.is_standing)
    distances = [message.feedback.distance_to_goal for message in feedback]
    assert distances == sorted(distances, reverse=True)
    assert distances[0] == pytest.approx(1.0, abs=0.1)
    assert max(message.feedback.speed for message in feedback) == pytest.approx(0.5, abs=0.01)
    assert plans
    assert plans[0].header.frame_id == "odom"


@pytest.mark.slow
def test_rollouts_are_shown(stage: Callable[[dict[str, Any]], Stage]) -> None:
    mppi = {
        "plugin": "nav2_mppi_controller::MPPIController",
        "visualize": True,
        "TrajectoryVisualizer": {"trajectory_step": 50},
        "TrajectoryValidator": {"plugin": "mppi::DefaultOptimalTrajectoryValidator", "collision_lookahead_time": 1.0},
    }
    bench = Bench(stage(changed("/controller_server", FollowPath=mppi))).start()
    markers = bench.stage.collect(MarkerArray, "trajectories")
    plans = bench.stage.collect(Path, "transformed_global_plan")
    best = bench.stage.collect(Path, "optimal_trajectory")
    bench.drive_until_moving(straight(1.5))
    bench.stage.step_for(0.3)
    (marker,) = markers[-1].markers
    assert (marker.header.frame_id, marker.type) == ("odom", Marker.LINE_LIST)
    assert len(marker.points) == len(marker.colors) == 20 * 18 * 2
    assert plans[-1].poses[-1].pose.position.x == pytest.approx(1.5)
    assert len(best[-1].poses) == 56


def test_a_path_handler_chooses_what_the_controller_sees(stage: Callable[[dict[str, Any]], Stage]) -> None:
    handler = {"plugin": "nav2_controller::FeasiblePathHandler", "prune_distance": 0.4}
    parameters = changed("/controller_server", path_handler_plugins=["PathHandler"], PathHandler=handler)
    bench = Bench(stage(parameters)).start()
    plans = bench.stage.collect(Path, "local_plan")
    bench.drive_until_moving(straight(1.5))
    bench.stage.step_until(lambda: bool(plans))
    first, *_, last = plans[-1].poses
    assert last.pose.position.x - first.pose.position.x == pytest.approx(0.4, abs=0.06)


def test_an_unknown_validator_fails_the_server(stage: Callable[[dict[str, Any]], Stage]) -> None:
    mppi = {"plugin": "nav2_mppi_controller::MPPIController", "TrajectoryValidator": {"plugin": "mppi::Default"}}
    bench = Bench(stage(changed("/controller_server", FollowPath=mppi)))
    assert bench.server.trigger_configure() != TransitionCallbackReturn.SUCCESS


@pytest.mark.slow
@pytest.mark.parametrize(("name", "speed"), [("", 0.5), ("FollowPath", 0.5), ("Other", 0.2)])
def test_the_goal_chooses_the_controller(bench: Bench, name: str, speed: float) -> None:
    status, _ = bench.drive(straight(1.0), controller_id=name)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert max(command[0] for command in bench.robot.commands) == pytest.approx(speed)


def test_a_path_in_another_frame_leads_elsewhere(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(PARAMETERS)).start()
    assert bench.drive(straight(1.0, "map"))[0] == GoalStatus.STATUS_SUCCEEDED
    assert bench.robot.pose[0] == pytest.approx(1.0, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("goal", "code", "reason"),
    [
        ({"path": Path()}, FollowPath.Result.INVALID_PATH, "at least one pose"),
        ({"path": straight(1.0, "nowhere")}, FollowPath.Result.TF_ERROR, "nowhere"),
        ({"path": straight(1.0), "controller_id": "None"}, FollowPath.Result.INVALID_CONTROLLER, "Other"),
        ({"path": straight(1.0), "goal_checker_id": "None"}, FollowPath.Result.INVALID_CONTROLLER, "goal_checker"),
        ({"path": straight(1.0), "progress_checker_id": "x"}, FollowPath.Result.INVALID_CONTROLLER, "progress"),
    ],
)
@pytest.mark.parametrize("moving", [False, True])
def test_a_goal_that_makes_no_sense_is_aborted_and_the_robot_stands(
    bench: Bench, goal: dict[str, Any], code: int, reason: str, moving: bool
) -> None:
    if moving:
        bench.drive_until_moving(straight(3.0))
    status, result = bench.stage.end(bench.send(**goal))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code)
    assert reason in result.error_msg
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.drive(straight(bench.robot.pose[0] + 1.0))[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_pose_that_is_not_finite_is_named(bench: Bench) -> None:
    path = straight(1.0)
    path.poses[3].pose.position.x = math.nan
    status, result = bench.drive(path)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.INVALID_PATH)
    assert "not finite" in result.error_msg


def test_a_cancelled_goal_stops_the_robot(bench: Bench) -> None:
    handle = bench.drive_until_moving(straight(3.0))
    bench.stage.result(handle.cancel_goal_async())
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_CANCELED
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.robot.pose[0] < 2.0


@pytest.mark.slow
def test_a_new_path_takes_over_without_a_stop(bench: Bench) -> None:
    first = bench.drive_until_moving(straight(3.0))
    del bench.robot.commands[:]
    second = bench.send(straight(2.0))
    status, result = bench.stage.end(first)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.NONE)
    assert "preempted" in result.error_msg
    assert all(command.any() for command in bench.robot.commands)
    assert bench.stage.end(second)[0] == GoalStatus.STATUS_SUCCEEDED
    assert bench.robot.pose[0] == pytest.approx(2.0, abs=0.3)


@pytest.mark.slow
def test_a_robot_that_does_not_move_makes_no_progress(bench: Bench) -> None:
    step = bench.robot.step
    bench.robot.step = lambda seconds, stamp: step(0.0, stamp)  # type: ignore[method-assign]
    began = bench.stage.now
    status, result = bench.drive(straight(1.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.FAILED_TO_MAKE_PROGRESS)
    assert "stuck" in result.error_msg
    assert bench.stage.now - began > 3.0


def test_a_transform_older_than_its_tolerance_is_not_used(bench: Bench) -> None:
    bench.robot.step = lambda seconds, stamp: None  # type: ignore[method-assign]
    status, result = bench.drive(straight(1.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.TF_ERROR)
    assert "s old, longer than transform_tolerance 0.3 s" in result.error_msg


def test_goals_are_rejected_while_it_is_not_active(bench: Bench) -> None:
    assert bench.server.trigger_deactivate() == TransitionCallbackReturn.SUCCESS
    assert not bench.send(straight(1.0)).accepted
    assert bench.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
    assert bench.drive(straight(1.0))[0] == GoalStatus.STATUS_SUCCEEDED


def test_deactivating_aborts_the_goal_and_stops_the_robot(bench: Bench) -> None:
    handle = bench.drive_until_moving(straight(3.0))
    bench.server.trigger_deactivate()
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.UNKNOWN)
    assert "deactivated" in result.error_msg
    bench.stage.step_until(lambda: bench.robot.is_standing)
    del bench.robot.commands[:]
    bench.stage.step_for(1.0)
    assert bench.robot.commands == []


@pytest.mark.slow
def test_parameters_of_plugins_change_while_it_is_active(bench: Bench) -> None:
    changed = [Parameter("FollowPath.desired_linear_vel", value=0.2), Parameter("failure_tolerance", value=0.1)]
    assert all(one.successful for one in bench.server.set_parameters(changed))
    assert bench.drive(straight(1.0))[0] == GoalStatus.STATUS_SUCCEEDED
    assert max(command[0] for command in bench.robot.commands) == pytest.approx(0.2)
    refused = bench.server.set_parameters([Parameter("FollowPath.desired_linear_vel", value=0.0)])[0]
    assert refused.reason == "parameter 'FollowPath.desired_linear_vel' must be above 0, got 0"


@pytest.mark.slow
def test_it_can_be_configured_again(bench: Bench) -> None:
    bench.server.trigger_deactivate()
    bench.server.set_parameters([Parameter("FollowPath.desired_linear_vel", value=0.3)])
    assert bench.server.trigger_cleanup() == TransitionCallbackReturn.SUCCESS
    assert bench.stage.node.count_publishers("cmd_vel") == 0
    assert bench.stage.node.count_publishers("/local_costmap/costmap") == 0
    bench.start()
    assert bench.drive(straight(1.0))[0] == GoalStatus.STATUS_SUCCEEDED
    assert max(command[0] for command in bench.robot.commands) == pytest.approx(0.3)


def test_shutdown_ends_it_for_good(bench: Bench) -> None:
    bench.drive_until_moving(straight(3.0))
    assert bench.server.trigger_shutdown() == TransitionCallbackReturn.SUCCESS
    assert bench.server.current_state.label == "finalized"
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.stage.node.count_publishers("cmd_vel") == 0


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        (changed("/controller_server", FollowPath={"plugin": "nav2_mppi_controller::MPPIControler"}), "MPPIController"),
        (changed("/controller_server", goal_checker={"plugin": "nav2_controller::Nothing"}), "Nothing"),
        (
            changed(COSTMAP, plugins=["voxel_layer"], voxel_layer={"plugin": "nav2_costmap_2d::BoxLayer"}),
            "BoxLayer",
        ),
    ],
)
def test_a_plugin_that_is_not_there_makes_configuring_fail(
    stage: Callable[[dict[str, Any]], Stage],
    capfd: pytest.CaptureFixture[str],
    parameters: dict[str, Any],
    reason: str,
) -> None:
    bench = Bench(stage(parameters))
    for _ in range(2):
        assert bench.server.trigger_configure() == TransitionCallbackReturn.FAILURE
        assert bench.server.current_state.label == "unconfigured"
        assert bench.stage.node.count_publishers("cmd_vel") == 0
    printed = capfd.readouterr().err
    assert reason in printed
    assert "Traceback" not in printed


def test_velocities_may_be_stamped(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(changed("/controller_server", enable_stamped_cmd_vel=True)))
    bench.start()
    commands = bench.stage.collect(TwistStamped, "cmd_vel")
    bench.send(straight(1.0))
    bench.stage.step_until(lambda: bool(commands))
    assert commands[0].header.frame_id == "base_link"
    assert commands[0].twist.linear.x > 0.0


def test_commands_come_at_the_frequency(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(changed("/controller_server", controller_frequency=5.0))).start()
    bench.drive_until_moving(straight(3.0))
    del bench.robot.commands[:]
    bench.stage.step_for(2.0)
    assert len(bench.robot.commands) == pytest.approx(10, abs=1)


@pytest.mark.slow
def test_without_a_transform_the_goal_ends_with_the_reason(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(changed(COSTMAP, robot_base_frame="chassis")))
    bench.server.trigger_configure()
    bench.server.trigger_activate()
    status, result = bench.drive(straight(1.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.TF_ERROR)
    assert "no transform from chassis to odom" in result.error_msg


class Laser:
    """A laser that sees nothing in its range, of which each step brings a scan."""

    def __init__(self, bench: Bench) -> None:
        self.delay = 0.0
        self.is_on = True
        self.last_place = 0.0
        self._stage, self._robot = bench.stage, bench.robot
        self._scans = bench.stage.node.create_publisher(LaserScan, "/scan", 10)
        self._move, bench.robot.step = bench.robot.step, self._step  # type: ignore[method-assign]

    def _step(self, seconds: float, stamp: Any) -> None:
        self._move(seconds, stamp)
        if self.is_on:
            scan = LaserScan(angle_max=6.2, angle_increment=0.1, range_max=10.0, ranges=[math.inf] * 63)
            scan.header.frame_id = "base_link"
            scan.header.stamp = time_message(round(1e9 * (self._stage.now - self.delay)))
            self._scans.publish(scan)
            self.last_place = float(self._robot.pose[0])


SEEING = changed(COSTMAP, plugins=["obstacle_layer", "inflation_layer"])


def test_the_robot_stops_when_scans_stop(stage: Callable[[dict[str, Any]], Stage]) -> None:
    """Half a second and one cycle later it stands, and waits before it gives up."""
    bench = Bench(stage({**SEEING, "/controller_server": {
        **PARAMETERS["/controller_server"], "costmap_update_timeout": 1.0}}))  # fmt: skip
    laser = Laser(bench)
    bench.start()
    handle = bench.drive_until_moving(straight(5.0))
    bench.stage.step_for(0.5)
    laser.is_on = False
    silent_since = bench.stage.now
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.stage.now - silent_since == pytest.approx(0.55, abs=0.1)
    assert bench.robot.pose[0] - laser.last_place < 0.3
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.CONTROLLER_TIMED_OUT)
    assert "'scan' is" in result.error_msg
    assert "expected_update_rate 0.5 s" in result.error_msg
    assert bench.stage.now - silent_since > 1.5
    assert bench.robot.pose[0] - laser.last_place < 0.3


@pytest.mark.slow
def test_the_robot_goes_on_when_scans_come_again(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({**SEEING, "/controller_server": {
        **PARAMETERS["/controller_server"], "costmap_update_timeout": 5.0}}))  # fmt: skip
    laser = Laser(bench)
    bench.start()
    handle = bench.drive_until_moving(straight(2.0))
    laser.is_on = False
    bench.stage.step_until(lambda: bench.robot.is_standing)
    bench.stage.step_for(1.0)
    laser.is_on = True
    assert bench.stage.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED
    assert bench.robot.pose[0] == pytest.approx(2.0, abs=0.3)


def test_late_scans_do_not_count(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage(SEEING))
    laser = Laser(bench)
    bench.start()
    handle = bench.drive_until_moving(straight(5.0))
    bench.stage.step_for(0.5)
    laser.delay = 1.0
    place = float(bench.robot.pose[0])
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.CONTROLLER_TIMED_OUT)
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.robot.pose[0] - place < 0.3


@pytest.mark.parametrize("lost", ["map", "odom"])
def test_the_robot_stops_when_nobody_says_where_it_is(bench: Bench, lost: str) -> None:
    """Neither localization, which places the path, nor odometry may be older than the tolerance."""
    handle = bench.drive_until_moving(straight(5.0, "map"))
    bench.stage.step_for(0.5)
    place = float(bench.robot.pose[0])
    if lost == "map":
        bench.robot.is_localized = False
    else:
        bench.robot._transforms.publish = lambda message: None  # type: ignore[method-assign]
    status, result = bench.stage.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, FollowPath.Result.TF_ERROR)
    assert "longer than transform_tolerance 0.3 s" in result.error_msg
    bench.stage.step_until(lambda: bench.robot.is_standing)
    assert bench.robot.pose[0] - place < 0.3
