"""The target of a trajectory is published before the controller gets it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import PointStamped
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from rclpy.time import Time
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from daidalos.nodes.daidalos_lighting.trajectory_target import TrajectoryTarget
from daidalos.nodes.qos import LATCHED

LEAD = 0.3
ARM = """<robot name="arm"><link name="base"/><link name="upper"/><link name="tool0"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<origin xyz="0 0 0.5"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="reach" type="prismatic"><parent link="upper"/><child link="tool0"/><axis xyz="1 0 0"/>
<origin xyz="0.2 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""


class Bench:
    """The node between a client and a controller that records what it gets."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.events = list[tuple[str, float]]()
        self.targets = list[PointStamped]()
        self.goals = list[Any]()
        self.accepts, self.is_held = True, False
        self.between = TrajectoryTarget(parameter_overrides=[Parameter("lead", value=LEAD)])
        group = ReentrantCallbackGroup()
        name = "joint_trajectory_controller/follow_joint_trajectory"
        self.controller = ActionServer(
            node, FollowJointTrajectory, name, self._execute, callback_group=group,
            goal_callback=lambda goal: GoalResponse.ACCEPT if self.accepts else GoalResponse.REJECT,
            cancel_callback=self._cancel,
        )  # fmt: skip
        node.create_subscription(PointStamped, "target", self._hear, LATCHED)
        self.description = node.create_publisher(String, "robot_description", LATCHED)
        self.client = ActionClient(node, FollowJointTrajectory, "trajectory_target/follow_joint_trajectory")
        self.held = Future()
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._executor.add_node(self.between)

    def _hear(self, message: PointStamped) -> None:
        self.targets.append(message)
        self.events.append(("target", time.monotonic()))

    async def _execute(self, handle: Any) -> Any:
        self.events.append(("moves", time.monotonic()))
        self.goals.append(handle.request)
        if self.is_held:
            await self.held
        if handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.succeed()
        return FollowJointTrajectory.Result(error_string="done")

    def _cancel(self, handle: Any) -> CancelResponse:
        self.held.set_result(None)
        return CancelResponse.ACCEPT

    def until(self, holds: Callable[[], bool]) -> None:
        """Spin until a condition holds."""
        end = time.monotonic() + 20.0
        while not holds():
            assert time.monotonic() < end
            self._executor.spin_once(timeout_sec=0.02)

    def ready(self) -> None:
        """Wait until the node knows the arm and the controller."""
        self.description.publish(String(data=ARM))
        self.until(lambda: self.between._problem(goal()) == "" and self.client.server_is_ready())

    def send(self, one: Any) -> Any:
        """Send a goal, and return its handle."""
        sent = self.client.send_goal_async(one)
        self.until(sent.done)
        return sent.result()

    def result(self, handle: Any) -> tuple[int, str]:
        """Return status and words of a goal's result."""
        waiting = handle.get_result_async()
        self.until(waiting.done)
        return waiting.result().status, waiting.result().result.error_string


def goal(turn: float = math.pi / 2, reach: float = 0.3, **changes: Any) -> Any:
    trajectory = JointTrajectory(joint_names=["reach", "turn"])
    trajectory.points = [JointTrajectoryPoint(positions=[0.0, 0.0]), JointTrajectoryPoint(positions=[reach, turn])]
    for name, value in changes.items():
        setattr(trajectory, name, value)
    return FollowJointTrajectory.Goal(trajectory=trajectory)


@pytest.fixture
def bench(node: Node) -> Iterator[Bench]:
    one = Bench(node)
    yield one
    one.controller.destroy()
    one.client.destroy()
    one.between.destroy_node()


@pytest.mark.slow
def test_the_target_is_seen_before_the_arm_moves(bench: Bench) -> None:
    bench.ready()
    handle = bench.send(goal())
    assert handle.accepted
    assert bench.result(handle) == (GoalStatus.STATUS_SUCCEEDED, "done")
    assert [name for name, _ in bench.events] == ["target", "moves"]
    assert bench.events[1][1] - bench.events[0][1] > 0.9 * LEAD
    place = bench.targets[0].point
    assert bench.targets[0].header.frame_id == "base"
    assert (place.x, place.y, place.z) == pytest.approx((0.0, 0.5, 0.5), abs=1e-9)
    assert bench.goals[0].trajectory.points == goal().trajectory.points
    stamp = bench.node.get_clock().now().nanoseconds + int(5e9)
    later = goal()
    later.trajectory.header.stamp = Time(nanoseconds=stamp).to_msg()
    start = time.monotonic()
    bench.result(bench.send(later))  # begins late enough by itself
    assert bench.goals[1].trajectory.header.stamp == later.trajectory.header.stamp
    assert bench.events[3][1] - start < 5.0
    early = goal()
    early.trajectory.header.stamp = bench.node.get_clock().now().to_msg()
    bench.result(bench.send(early))  # begins when the lead is over
    shift = Time.from_msg(bench.goals[2].trajectory.header.stamp) - Time.from_msg(early.trajectory.header.stamp)
    assert shift.nanoseconds * 1e-9 > 0.9 * LEAD


@pytest.mark.slow
def test_what_is_cancelled_or_replaced_while_it_waits_does_not_move(bench: Bench) -> None:
    bench.ready()
    first = bench.send(goal())
    second = bench.send(goal(turn=0.0))
    assert bench.result(first)[0] == GoalStatus.STATUS_ABORTED
    cancelling = second.cancel_goal_async()
    bench.until(cancelling.done)
    assert bench.result(second)[0] == GoalStatus.STATUS_CANCELED
    assert bench.goals == []
    bench.is_held = True
    third = bench.send(goal())
    bench.until(lambda: bool(bench.goals))
    cancelling = third.cancel_goal_async()
    bench.until(cancelling.done)
    assert bench.result(third)[0] == GoalStatus.STATUS_CANCELED  # the controller was told, too


@pytest.mark.slow
def test_what_cannot_be_shown_is_refused(bench: Bench) -> None:
    bench.until(bench.client.server_is_ready)
    assert not bench.send(goal()).accepted  # the arm is not known yet
    bench.description.publish(String(data="<robot"))
    bench.ready()
    nothing = goal(points=[])
    short = goal(joint_names=["reach"])
    for one in (goal(turn=math.nan), nothing, short, goal(joint_names=["reach", "turm"]), goal(joint_names=[])):
        assert not bench.send(one).accepted
    assert bench.targets == []
    bench.accepts = False
    status, words = bench.result(bench.send(goal()))
    assert status == GoalStatus.STATUS_ABORTED
    assert "refuses" in words
