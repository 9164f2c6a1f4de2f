"""Actions and services behind the leaves of a behavior tree."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.arrays import Array
from daidalos.common.pose2 import compose
from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.services import ErrorCode, Outcome, Task
from daidalos.nodes.action_results import error_name
from daidalos.nodes.conversions import pose2_of, pose2_of_transform, pose_stamped, velocity_of
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import duration_message

_SUCCEEDED = 4


class GraphServices:
    """What a tree asks of a robot, through a node; see `daidalos.navigation.trees.services.Services`.

    Parameters
    ----------
    node : Node
        The navigator.
    buffer : Buffer
        Its transforms.
    frames : tuple of str
        The frame of goals, and that of the robot's base.
    odom_topic : str
        Topic of the odometry.
    """

    def __init__(self, node: Node, buffer: Buffer, frames: tuple[str, str], odom_topic: str) -> None:
        self._node = node
        self._buffer = buffer
        self._frame, self._base = frames
        self._odom_topic = odom_topic
        self._actions: dict[str, ActionClient] = {}
        self._clients: dict[str, Any] = {}
        self._latest: dict[str, Any] = {}

    def now(self) -> float:
        """Time of the node's clock [s]."""
        return self._node.get_clock().now().nanoseconds * 1e-9

    def _pose_of(self, target: str, source: str) -> tuple[Array, Any] | None:
        try:
            found = self._buffer.lookup_transform(target or self._frame, source or self._base, Time())
        except TransformException:
            return None
        return pose2_of_transform(found.transform), found.header.stamp

    def robot_pose(self, frame: str = "", base: str = "") -> Array | None:
        """Return the latest pose (x, y, yaw) of the robot, None where it is not known."""
        found = self._pose_of(frame, base)
        return None if found is None else found[0]

    def robot_pose_stamped(self, frame: str = "", base: str = "") -> Any | None:
        """Return the same as a ``geometry_msgs/msg/PoseStamped``."""
        found = self._pose_of(frame, base)
        return None if found is None else pose_stamped(found[0], frame or self._frame, found[1])

    def pose_in(self, pose: Any, frame: str = "") -> Array | None:
        """Return a stamped pose as (x, y, yaw) in a frame, None where it cannot be transformed."""
        target, source = frame or self._frame, pose.header.frame_id or self._frame
        if target == source:
            return pose2_of(pose.pose)
        found = self._pose_of(target, source)
        return None if found is None else compose(found[0], pose2_of(pose.pose))

    def can_transform(self, target: str, source: str) -> bool:
        """Return whether there is a transform between two frames."""
        return bool(self._buffer.can_transform(target, source, Time()))

    def velocity(self) -> Array | None:
        """Return the robot's velocity (x, y, yaw) by its odometry, None where there is none."""
        odometry = self.latest(self._odom_topic, "nav_msgs/msg/Odometry")
        return None if odometry is None else velocity_of(odometry.twist.twist)

    def latest(self, topic: str, kind: str, *, latched: bool = False) -> Any | None:
        """Return the last message of a topic, None until one has come; see `Services.latest`."""
        from rosidl_runtime_py.utilities import get_message

        if topic not in self._latest:
            self._latest[topic] = None
            qos = LATCHED if latched else QoSProfile(depth=10)
            self._node.create_subscription(get_message(kind), topic, partial(self._latest.__setitem__, topic), qos)
        return self._latest[topic]

    def start(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        """Start what a leaf asks for."""
        return self._call(node, goal) if "/srv/" in node.INTERFACE else self._send(node, goal)

    def _send(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        from rosidl_runtime_py.utilities import get_action

        server = goal.get("server_name") or node.SERVER
        if server not in self._actions:
            self._actions[server] = ActionClient(self._node, get_action(node.INTERFACE), server)
        return _ActionTask(self._actions[server], node, server, goal)

    def _call(self, node: type[ActionNode], goal: Mapping[str, Any]) -> Task:
        from rosidl_runtime_py.utilities import get_service

        kind = get_service(node.INTERFACE)
        name = node.service(goal)
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, name)
        client = self._clients[name]
        if not client.service_is_ready():
            return _Failed(f"the service {name} is not there")
        return _ServiceTask(client.call_async(_filled(kind.Request(), node.goal(goal))), node)


def _filled(message: Any, fields: Mapping[str, Any]) -> Any:
    """Set the fields that a message has, such as ``target.x``, and return it; durations are given in seconds."""
    for path, value in fields.items():
        *parents, name = path.split(".")
        owner = message
        for parent in parents:
            owner = getattr(owner, parent, None)
        if hasattr(owner, name):
            is_duration = hasattr(getattr(owner, name), "nanosec") and isinstance(value, int | float)
            setattr(owner, name, duration_message(value) if is_duration else value)
    return message


class _Failed:
    """Task that could not be started."""

    def __init__(self, reason: str) -> None:
        self._reason = reason

    def poll(self) -> Outcome:
        """Return the failure."""
        return Outcome(False, error_code="UNKNOWN", error_msg=self._reason)

    def feedback(self) -> Mapping[str, Any]:
        """Return nothing: there is none."""
        return {}

    def update(self, goal: Mapping[str, Any]) -> None:
        """Do nothing."""

    def halt(self) -> None:
        """Do nothing."""


class _ServiceTask:
    """Call of a service."""

    def __init__(self, future: Any, node: type[ActionNode]) -> None:
        self._future = future
        self._node = node

    def poll(self) -> Outcome | None:
        """Return whether the answer means success, once it has come."""
        if not self._future.done():
            return None
        response = self._future.result()
        is_success = self._node.is_success(response)
        return Outcome(is_success, self._node.outputs(response) if is_success else {})

    def feedback(self) -> Mapping[str, Any]:
        """Return nothing: there is none."""
        return {}

    def update(self, goal: Mapping[str, Any]) -> None:
        """Do nothing: a call cannot be changed."""

    def halt(self) -> None:
        """Do not wait for the answer."""
        self._future.cancel()


class _ActionTask:
    """Goal of an action; a new goal replaces it when the leaf's inputs change."""

    def __init__(self, client: ActionClient, node: type[ActionNode], server: str, inputs: Mapping[str, Any]) -> None:
        self._client = client
        self._node = node
        self._server = server
        self._handle: Any = None
        self._result: Any = None
        self._feedback: Any = None
        self._failure = ""
        self._generation = 0
        self._send(inputs)

    def _send(self, inputs: Mapping[str, Any]) -> None:
        self._generation += 1
        if not self._client.server_is_ready():
            self._failure = f"the action {self._server} is not served"
            return
        generation = self._generation
        goal = _filled(self._client.action_type.Goal(), self._node.goal(inputs))
        future = self._client.send_goal_async(goal, partial(self._on_feedback, generation))
        future.add_done_callback(lambda sent: self._on_sent(sent.result(), generation))

    def _on_sent(self, handle: Any, generation: int) -> None:
        if generation != self._generation:
            handle.cancel_goal_async()  # halted, or replaced, before the server answered
            return
        if not handle.accepted:
            self._failure = f"the goal was rejected by {self._server}"
            return
        self._handle = handle
        handle.get_result_async().add_done_callback(lambda answer: self._on_result(answer.result(), generation))

    def _on_feedback(self, generation: int, message: Any) -> None:
        if generation == self._generation:
            self._feedback = message.feedback

    def _on_result(self, answer: Any, generation: int) -> None:
        if generation == self._generation:
            self._result = answer

    def poll(self) -> Outcome | None:
        """Return how the goal ended, None while it goes on."""
        if self._failure:
            unknown = ErrorCode("UNKNOWN", getattr(self._client.action_type.Result, "UNKNOWN", 0))
            return Outcome(False, error_code=unknown, error_msg=self._failure)
        if self._result is None:
            return None
        result = self._result.result
        if self._result.status == _SUCCEEDED:
            return Outcome(True, self._node.outputs(result))
        has_code = hasattr(result, "error_code")
        code = ErrorCode(error_name(result), int(result.error_code)) if has_code else "UNKNOWN"
        return Outcome(False, error_code=code, error_msg=getattr(result, "error_msg", ""))

    def feedback(self) -> Mapping[str, Any]:
        """Return the latest feedback for output ports, once."""
        latest, self._feedback = self._feedback, None
        return {} if latest is None else self._node.outputs(latest)

    def update(self, goal: Mapping[str, Any]) -> None:
        """Send another goal, which the server takes up where it is."""
        self._handle = None
        self._send(goal)

    def halt(self) -> None:
        """Cancel the goal."""
        self._generation += 1
        if self._handle is not None and self._result is None:
            self._handle.cancel_goal_async()
