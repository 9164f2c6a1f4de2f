"""The server of behaviours, with the test as its robot."""

from __future__ import annotations

import gc
import threading
from collections.abc import Iterator

import numpy as np
import pytest
import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, Point32, Polygon, PolygonStamped, TransformStamped, Twist
from nav2_msgs.action import DriveOnHeading, Wait
from nav2_msgs.msg import Costmap
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from tf2_ros import StaticTransformBroadcaster

from daidalos.nodes.nav2_behaviors.behavior_server import BehaviorServer

TIMEOUT_S = 20.0


@pytest.fixture
def executor(domain: int) -> Iterator[SingleThreadedExecutor]:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    executor = SingleThreadedExecutor(context=context)
    nodes = [BehaviorServer(context=context), Node("robot", context=context)]
    for node in nodes:
        executor.add_node(node)
    nodes[0].trigger_configure()
    nodes[0].trigger_activate()
    yield executor
    for node in nodes:
        node.destroy_node()
    rclpy.shutdown(context=context)


def be_somewhere(robot: Node, obstacle: tuple[float, float] | None = None) -> None:
    """Publish where the robot is, and the costmap around it with at most one obstacle."""
    transform = TransformStamped(child_frame_id="base_link")
    transform.header.frame_id = "odom"
    transform.transform.rotation.w = 1.0
    robot.broadcaster = StaticTransformBroadcaster(robot)
    robot.broadcaster.sendTransform(transform)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    costs = np.zeros((40, 40), dtype=np.uint8)
    if obstacle is not None:
        costs[int((obstacle[1] + 2.0) / 0.1), int((obstacle[0] + 2.0) / 0.1)] = 254
    costmap = Costmap(data=costs.tobytes())
    costmap.header.frame_id = "odom"
    costmap.metadata.size_x = costmap.metadata.size_y = 40
    costmap.metadata.resolution = 0.1
    costmap.metadata.origin.position.x = costmap.metadata.origin.position.y = -2.0
    robot.create_publisher(Costmap, "local_costmap/costmap_raw", latched).publish(costmap)


@pytest.mark.slow
def test_a_goal_waits_for_the_first_costmap(executor: SingleThreadedExecutor) -> None:
    robot = executor.get_nodes()[1]
    client = ActionClient(robot, Wait, "wait")
    assert client.wait_for_server(TIMEOUT_S)
    sent = client.send_goal_async(Wait.Goal(time=Duration(nanosec=1)))
    executor.spin_until_future_complete(sent, TIMEOUT_S)
    ended = sent.result().get_result_async()
    executor.spin_until_future_complete(ended, 0.3)
    assert not ended.done()
    be_somewhere(robot)
    executor.spin_until_future_complete(ended, TIMEOUT_S)
    assert ended.result().status == GoalStatus.STATUS_SUCCEEDED


def test_a_goal_that_waits_can_be_cancelled(executor: SingleThreadedExecutor) -> None:
    robot = executor.get_nodes()[1]
    client = ActionClient(robot, DriveOnHeading, "drive_on_heading")
    assert client.wait_for_server(TIMEOUT_S)
    sent = client.send_goal_async(DriveOnHeading.Goal())
    executor.spin_until_future_complete(sent, TIMEOUT_S)
    executor.spin_until_future_complete(sent.result().cancel_goal_async(), TIMEOUT_S)
    ended = sent.result().get_result_async()
    executor.spin_until_future_complete(ended, 5.0)
    assert ended.done()
    assert ended.result().status == GoalStatus.STATUS_CANCELED


def test_deactivating_aborts_a_goal(executor: SingleThreadedExecutor) -> None:
    server, robot = executor.get_nodes()
    client = ActionClient(robot, DriveOnHeading, "drive_on_heading")
    assert client.wait_for_server(TIMEOUT_S)
    sent = client.send_goal_async(DriveOnHeading.Goal())
    executor.spin_until_future_complete(sent, TIMEOUT_S)
    server.trigger_deactivate()
    ended = sent.result().get_result_async()
    executor.spin_until_future_complete(ended, TIMEOUT_S)
    assert ended.result().status == GoalStatus.STATUS_ABORTED
    assert "deactivated" in ended.result().result.error_msg
    refused = client.send_goal_async(DriveOnHeading.Goal())
    executor.spin_until_future_complete(refused, TIMEOUT_S)
    assert not refused.result().accepted


@pytest.mark.slow
@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_ctrl_c_during_a_behaviour_stops_the_robot_and_prints_nothing(
    executor: SingleThreadedExecutor, capfd: pytest.CaptureFixture[str]
) -> None:
    server, robot = executor.get_nodes()
    be_somewhere(robot)
    speeds: list[float] = []
    moving, stopped = Future(), threading.Event()

    def receive(message: Twist) -> None:
        speeds.append(message.linear.x)
        if message.linear.x and not moving.done():
            moving.set_result(None)
        elif moving.done() and not message.linear.x:
            stopped.set()

    robot.create_subscription(Twist, "cmd_vel", receive, 10)
    client = ActionClient(robot, DriveOnHeading, "drive_on_heading")
    assert client.wait_for_server(TIMEOUT_S)
    client.send_goal_async(DriveOnHeading.Goal(target=Point(x=1.0), speed=0.1, time_allowance=Duration(sec=60)))
    executor.spin_until_future_complete(moving, TIMEOUT_S)
    assert moving.done()
    server.context.shutdown_by_signal()
    executor.remove_node(robot)
    server.destroy_node()
    gc.collect()
    assert "Traceback" not in capfd.readouterr().err
    while (taken := taken_by(robot)) is not None:
        receive(taken)
    assert stopped.is_set()
    assert speeds[-1] == 0.0


def taken_by(robot: Node) -> Twist | None:
    """Return the next velocity that waits for the robot; its executor has ended with the context."""
    (subscription,) = [one for one in robot.subscriptions if one.topic_name == "/cmd_vel"]
    taken = subscription.handle.take_message(Twist, False)
    return taken and taken[0]


def test_it_can_be_configured_again(executor: SingleThreadedExecutor) -> None:
    server, robot = executor.get_nodes()
    server.trigger_deactivate()
    assert server.trigger_cleanup() == TransitionCallbackReturn.SUCCESS
    assert robot.count_publishers("cmd_vel") == 0
    assert server.trigger_configure() == TransitionCallbackReturn.SUCCESS
    assert server.trigger_activate() == TransitionCallbackReturn.SUCCESS
    be_somewhere(robot)
    client = ActionClient(robot, Wait, "wait")
    assert client.wait_for_server(TIMEOUT_S)
    sent = client.send_goal_async(Wait.Goal(time=Duration(nanosec=1)))
    executor.spin_until_future_complete(sent, TIMEOUT_S)
    ended = sent.result().get_result_async()
    executor.spin_until_future_complete(ended, TIMEOUT_S)
    assert ended.result().status == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.usefixtures("compiled")
def test_the_published_footprint_is_checked_for_collisions(executor: SingleThreadedExecutor) -> None:
    server, robot = executor.get_nodes()
    be_somewhere(robot, obstacle=(0.65, 0.55))  # beside the way of the circle that is assumed at first
    corners = [(0.2, 0.7), (-0.2, 0.7), (-0.2, -0.7), (0.2, -0.7)]
    outline = PolygonStamped(polygon=Polygon(points=[Point32(x=x, y=y) for x, y in corners]))
    outline.header.frame_id = "odom"
    publisher = robot.create_publisher(PolygonStamped, "local_costmap/published_footprint", 1)
    timer = robot.create_timer(0.05, lambda: publisher.publish(outline))
    taken = Future()
    timer_of_check = robot.create_timer(
        0.05,
        lambda: (
            taken.set_result(None) if len(server._surroundings.footprint.polygon) == 4 and not taken.done() else None
        ),
    )
    executor.spin_until_future_complete(taken, TIMEOUT_S)
    for one in (timer, timer_of_check):
        robot.destroy_timer(one)
    client = ActionClient(robot, DriveOnHeading, "drive_on_heading")
    assert client.wait_for_server(TIMEOUT_S)
    goal = DriveOnHeading.Goal(speed=0.5, time_allowance=Duration(sec=5))
    goal.target.x = 1.0
    sent = client.send_goal_async(goal)
    executor.spin_until_future_complete(sent, TIMEOUT_S)
    ended = sent.result().get_result_async()
    executor.spin_until_future_complete(ended, TIMEOUT_S)
    result = ended.result()
    assert (result.status, result.result.error_code) == (
        GoalStatus.STATUS_ABORTED,
        DriveOnHeading.Result.COLLISION_AHEAD,
    )


def test_topics_by_their_former_names_are_listened_to() -> None:
    """Humble's parameter file calls the topics of the costmap otherwise."""
    rclpy.init(args=["--ros-args", "-p", "costmap_topic:=/seen", "-p", "footprint_topic:=/outline"])
    server = BehaviorServer()
    try:
        assert server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert {"/seen", "/outline"} <= {one.topic_name for one in server.subscriptions}
    finally:
        server.destroy_node()
        rclpy.try_shutdown()
