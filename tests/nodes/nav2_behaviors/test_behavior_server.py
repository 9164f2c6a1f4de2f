"""The server of behaviours, with the test as its robot."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import TransformStamped
from nav2_msgs.action import DriveOnHeading, Wait
from nav2_msgs.msg import Costmap
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
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


def be_somewhere(robot: Node) -> None:
    """Say where the robot is, and that nothing is around it."""
    transform = TransformStamped(child_frame_id="base_link")
    transform.header.frame_id = "odom"
    transform.transform.rotation.w = 1.0
    robot.broadcaster = StaticTransformBroadcaster(robot)
    robot.broadcaster.sendTransform(transform)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    costmap = Costmap(data=bytes(40 * 40))
    costmap.header.frame_id = "odom"
    costmap.metadata.size_x = costmap.metadata.size_y = 40
    costmap.metadata.resolution = 0.1
    costmap.metadata.origin.position.x = costmap.metadata.origin.position.y = -2.0
    robot.create_publisher(Costmap, "local_costmap/costmap_raw", latched).publish(costmap)


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
