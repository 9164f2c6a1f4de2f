"""A navigator beside servers that the test plays."""

import threading

import pytest
import rclpy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import (
    ComputeAndTrackRoute,
    ComputePathToPose,
    ComputeRoute,
    DockRobot,
    FollowWaypoints,
    NavigateToPose,
    Spin,
)
from nav2_msgs.srv import ClearEntireCostmap, GetCostmap, LoadMap, ManageLifecycleNodes
from nav2_simple_commander.robot_navigator import BasicNavigator, RunningTask, TaskResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile


def pose(x=0.0):
    stamped = PoseStamped()
    stamped.header.frame_id, stamped.pose.position.x = "map", x
    return stamped


class Servers:
    """Nav2 as a test plays it: every goal is kept, and ends when and as the test says."""

    def __init__(self):
        self.node = rclpy.create_node("nav2")
        self.goals, self.may_end, self.verdict = [], threading.Event(), "succeed"
        self.accepts = True
        self.group = ReentrantCallbackGroup()

    def serve(self, kind, name, result=None, feedback=()):
        def execute(goal_handle):
            self.goals.append(goal_handle.request)
            for one in feedback:
                goal_handle.publish_feedback(one)
            while not self.may_end.wait(0.01):
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    return kind.Result()
            getattr(goal_handle, self.verdict)()
            return result or kind.Result()

        return ActionServer(
            self.node,
            kind,
            name,
            execute,
            callback_group=self.group,
            goal_callback=lambda goal: GoalResponse.ACCEPT if self.accepts else GoalResponse.REJECT,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def answer(self, kind, name, function=lambda request, response: response):
        requests = []

        def callback(request, response):
            requests.append(request)
            return function(request, response)

        self.node.create_service(kind, name, callback, callback_group=self.group)
        return requests


@pytest.fixture
def servers(graph):
    servers = Servers()
    executor = MultiThreadedExecutor(4)
    executor.add_node(servers.node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield servers
    servers.may_end.set()
    executor.shutdown()
    thread.join()


@pytest.fixture
def navigator(servers):
    navigator = BasicNavigator()
    yield navigator
    navigator.destroyNode()


def finish(navigator, task=RunningTask.NONE):
    for _ in range(100):
        if navigator.isTaskComplete(task):
            return
    pytest.fail("the task does not end")


def test_a_goal_that_is_reached(servers, navigator):
    feedback = [NavigateToPose.Feedback(distance_remaining=3.0), NavigateToPose.Feedback(distance_remaining=1.0)]
    servers.serve(NavigateToPose, "navigate_to_pose", feedback=feedback)
    assert navigator.isTaskComplete()
    assert navigator.getResult() is TaskResult.UNKNOWN
    assert navigator.goToPose(pose(4.0), behavior_tree="tree.xml") is RunningTask.NAVIGATE_TO_POSE
    while navigator.getFeedback() is None or navigator.getFeedback().distance_remaining != 1.0:
        assert not navigator.isTaskComplete()
    servers.may_end.set()
    finish(navigator)
    assert navigator.getResult() is TaskResult.SUCCEEDED
    assert (servers.goals[0].pose, servers.goals[0].behavior_tree) == (pose(4.0), "tree.xml")


def test_a_goal_that_fails(servers, navigator):
    servers.verdict = "abort"
    servers.may_end.set()
    servers.serve(NavigateToPose, "navigate_to_pose", NavigateToPose.Result(error_code=205, error_msg="no way"))
    assert navigator.goToPose(pose())
    finish(navigator)
    assert navigator.getResult() is TaskResult.FAILED
    assert navigator.getTaskError() == (205, "no way")
    navigator.clearPreviousState()
    assert (navigator.getResult(), navigator.getTaskError()) == (TaskResult.UNKNOWN, (0, ""))


def test_a_goal_that_is_cancelled(servers, navigator):
    servers.serve(Spin, "spin")
    assert navigator.spin(spin_dist=3, time_allowance=1.5) is RunningTask.SPIN
    assert not navigator.isTaskComplete()
    navigator.cancelTask()
    finish(navigator)
    assert navigator.getResult() is TaskResult.CANCELED
    assert (servers.goals[0].target_yaw, servers.goals[0].time_allowance.nanosec) == (3.0, 500_000_000)


def test_a_goal_that_is_rejected(servers, navigator):
    servers.accepts = False
    servers.serve(FollowWaypoints, "follow_waypoints")
    assert navigator.followWaypoints([pose(1.0), pose(2.0)]) is None
    assert navigator.getTaskError()[1] == "follow_waypoints request was rejected!"
    assert navigator.isTaskComplete()


def test_docks_by_name_and_by_place(servers, navigator):
    servers.may_end.set()
    servers.serve(DockRobot, "dock_robot")
    assert navigator.dockRobotByID("home", nav_to_dock=False) is RunningTask.DOCK_ROBOT
    finish(navigator)
    assert navigator.dockRobotByPose(pose(2.0), "charger")
    finish(navigator)
    by_name, by_place = servers.goals
    assert (by_name.use_dock_id, by_name.dock_id, by_name.navigate_to_staging_pose) == (True, "home", False)
    assert (by_place.use_dock_id, by_place.dock_pose, by_place.dock_type) == (False, pose(2.0), "charger")


def test_plans(servers, navigator):
    result = ComputePathToPose.Result()
    result.path.poses = [pose(1.0), pose(2.0)]
    servers.may_end.set()
    servers.serve(ComputePathToPose, "compute_path_to_pose", result)
    path = navigator.getPath(pose(), pose(2.0), planner_id="GridBased", use_start=True)
    assert path.poses == [pose(1.0), pose(2.0)]
    assert (servers.goals[0].planner_id, servers.goals[0].use_start) == ("GridBased", True)
    servers.verdict = "abort"
    assert navigator.getPath(pose(), pose(2.0)) is None
    assert navigator.getResult() is TaskResult.FAILED


def test_routes_by_poses_and_by_numbers(servers, navigator):
    servers.may_end.set()
    servers.serve(ComputeRoute, "compute_route")
    assert len(navigator.getRoute(pose(1.0), pose(2.0), use_start=True)) == 2
    assert len(navigator.getRoute(3, 5)) == 2
    by_pose, by_number = servers.goals
    assert (by_pose.use_poses, by_pose.use_start, by_pose.goal) == (True, True, pose(2.0))
    assert (by_number.use_poses, by_number.start_id, by_number.goal_id) == (False, 3, 5)
    with pytest.raises(TypeError, match="both poses, or both numbers"):
        navigator.getRoute(3, pose())


def test_a_route_is_tracked_beside_another_task(servers, navigator):
    told = [ComputeAndTrackRoute.Feedback(last_node_id=number) for number in (1, 2)]
    servers.serve(ComputeAndTrackRoute, "compute_and_track_route", feedback=told)
    servers.serve(NavigateToPose, "navigate_to_pose")
    route = navigator.getAndTrackRoute(1, 4)
    assert navigator.goToPose(pose())
    seen = []
    while len(seen) < 2:
        assert not navigator.isTaskComplete(task=route)
        feedback = navigator.getFeedback(task=route)
        seen += [] if feedback is None else [feedback.last_node_id]
    assert seen == [1, 2]
    assert navigator.getFeedback(task=route) is None
    servers.may_end.set()
    finish(navigator, route)
    finish(navigator)


def test_services(servers, navigator):
    cleared = [
        servers.answer(ClearEntireCostmap, f"{name}_costmap/clear_entirely_{name}_costmap")
        for name in ("local", "global")
    ]
    navigator.clearAllCostmaps()
    assert [len(requests) for requests in cleared] == [1, 1]

    def costmap(request, response):
        response.map.metadata.size_x = 7
        return response

    servers.answer(GetCostmap, "global_costmap/get_costmap", costmap)
    assert navigator.getGlobalCostmap().metadata.size_x == 7

    def load(request, response):
        response.result = 0 if request.map_url == "good.yaml" else LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST
        return response

    servers.answer(LoadMap, "map_server/load_map", load)
    assert navigator.changeMap("good.yaml")
    assert not navigator.changeMap("bad.yaml")
    assert navigator.getTaskError()[0] == LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST

    managed = servers.answer(ManageLifecycleNodes, "lifecycle_manager_navigation/manage_nodes")
    navigator.lifecycleStartup()
    navigator.lifecycleShutdown()
    assert [request.command for request in managed] == [
        ManageLifecycleNodes.Request.STARTUP,
        ManageLifecycleNodes.Request.SHUTDOWN,
    ]


def test_waiting_until_navigation_is_active(servers, navigator):
    def state(request, response):
        response.current_state.label = "active"
        return response

    asked = [servers.answer(GetState, f"{name}/get_state", state) for name in ("amcl", "bt_navigator")]
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    located = servers.node.create_publisher(PoseWithCovarianceStamped, "amcl_pose", latched)
    told = []

    def locate(message):
        told.append(message)
        located.publish(message)

    servers.node.create_subscription(PoseWithCovarianceStamped, "initialpose", locate, 10)
    navigator.setInitialPose(pose(3.0))
    navigator.waitUntilNav2Active()
    assert all(asked)
    assert (told[0].pose.pose, told[0].header.frame_id) == (pose(3.0).pose, "map")
    asked[0].clear()
    navigator.waitUntilNav2Active(localizer="robot_localization")
    assert not asked[0]
