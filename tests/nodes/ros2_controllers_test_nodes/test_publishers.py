"""The publishers that send controllers their goals."""

import threading
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

from daidalos.nodes.ros2_controllers_test_nodes.publisher_forward_position_controller import ForwardPositionPublisher
from daidalos.nodes.ros2_controllers_test_nodes.publisher_joint_trajectory_controller import JointTrajectoryPublisher
from daidalos.nodes.runner import UserError
from ros.graph import graph, node, spinning  # noqa: F401

TIMEOUT_S = 20.0
JOINTS = ["shoulder", "elbow"]


def given(**values: Any) -> list[Parameter[Any]]:
    """Parameters of which `__` in a name stands for a dot, sent quickly."""
    return [
        Parameter(name.replace("__", "."), value=value)
        for name, value in {"wait_sec_between_publish": 0.02, **values}.items()
    ]


class Watch:
    """Keeps what comes on a topic, and lets a test wait for it."""

    def __init__(self, watcher: Node, kind: type, topic: str) -> None:
        self.messages: list[Any] = []
        self._changed = threading.Condition()
        watcher.create_subscription(kind, topic, self._keep, 10)

    def wait_for(self, condition: Callable[[list[Any]], bool]) -> None:
        with self._changed:
            assert self._changed.wait_for(lambda: condition(self.messages), TIMEOUT_S)

    def _keep(self, message: Any) -> None:
        with self._changed:
            self.messages.append(message)
            self._changed.notify()


def received(watcher: Node, publisher: Node, kind: type, topic: str, count: int) -> Sequence[Any]:
    """Return the first messages of a topic."""
    watch = Watch(watcher, kind, topic)
    with spinning(watcher, publisher):
        watch.wait_for(lambda messages: len(messages) >= count)
    return watch.messages[:count]


def test_positions_are_sent_in_turn(node: Node) -> None:  # noqa: F811
    parameters = given(publish_topic="/arm/commands", goal_names=["up", "down"], up=[1.0, 2.0], down=[0, -1])
    messages = received(
        node, ForwardPositionPublisher(parameter_overrides=parameters), Float64MultiArray, "/arm/commands", 3
    )
    assert [list(message.data) for message in messages] == [[1.0, 2.0], [0.0, -1.0], [1.0, 2.0]]


@pytest.mark.parametrize("wrong", [{}, {"up": "high"}])
def test_every_goal_needs_positions(graph: Context, wrong: dict[str, Any]) -> None:  # noqa: F811
    with pytest.raises(UserError, match="'up' must hold the positions"):
        ForwardPositionPublisher(parameter_overrides=given(goal_names=["up"], **wrong))


def test_trajectories_hold_what_fits_the_joints(node: Node) -> None:  # noqa: F811
    parameters = given(
        controller_name="arm",
        joints=JOINTS,
        goal_names=["up", "short", "fast"],
        up__positions=[1, 2],
        up__effort=[1.0],
        short__positions=[1.0],
        fast__velocities=[0.1, 0.2],
    )
    publisher = JointTrajectoryPublisher(parameter_overrides=parameters)
    messages = received(node, publisher, JointTrajectory, "/arm/joint_trajectory", 2)
    assert [message.joint_names for message in messages] == [JOINTS, JOINTS]
    points = [message.points[0] for message in messages]
    assert [(list(each.positions), list(each.velocities), list(each.effort)) for each in points] == [
        ([1.0, 2.0], [], []),
        ([], [0.1, 0.2], []),
    ]
    assert {each.time_from_start.sec for each in points} == {4}


@pytest.mark.parametrize(("elbow", "sent"), [(0.05, True), (0.2, False)])
def test_the_start_may_be_checked(node: Node, elbow: float, sent: bool) -> None:  # noqa: F811
    limits = {f"starting_point_limits__{joint}": [-0.1, 0.1] for joint in JOINTS}
    parameters = given(joints=JOINTS, goal_names=["up"], up__positions=[1.0, 2.0], check_starting_point=True, **limits)
    goals = Watch(node, JointTrajectory, "/position_trajectory_controller/joint_trajectory")
    logs = Watch(node, Log, "/rosout")

    def said(text: str) -> None:
        logs.wait_for(lambda messages: any(text in message.msg for message in messages))

    publisher = JointTrajectoryPublisher(parameter_overrides=parameters)
    states = node.create_publisher(JointState, "joint_states", 10)
    with spinning(node, publisher):
        said("nothing is heard of the joints")
        states.publish(JointState(name=["finger", *JOINTS], position=[9.0, 0.0, elbow]))
        if sent:
            goals.wait_for(bool)
        else:
            said("the joints started outside")
    assert bool(goals.messages) is sent


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({}, "'joints' must name"),
        ({"joints": JOINTS}, "none of the goals pos1, pos2"),
        (
            {"joints": JOINTS, "check_starting_point": True, "starting_point_limits__elbow": [0.0]},
            "'starting_point_limits.elbow' must hold two",
        ),
    ],
)
def test_what_is_missing_is_named(graph: Context, parameters: dict[str, Any], message: str) -> None:  # noqa: F811
    with pytest.raises(UserError, match=message):
        JointTrajectoryPublisher(parameter_overrides=given(**parameters))
