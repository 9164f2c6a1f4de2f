"""Behaviours between transforms and the blackboard."""

from __future__ import annotations

from typing import Any

import py_trees
from geometry_msgs.msg import TransformStamped
from py_trees.common import Access, ClearingPolicy, Status
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.time import Time
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener

from py_trees_ros.publishers import node_of


class FromBlackboard(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Behaviour that sends a transform of the blackboard: SUCCESS, or FAILURE without one.

    Parameters
    ----------
    name
        Name of the behaviour.
    variable_name
        The variable, a `geometry_msgs/msg/Transform`.
    target_frame, source_frame
        Frames: the transform is that of the source frame in the target frame.
    static
        Whether it is sent as a static one.
    qos_profile, static_qos_profile
        Qualities of service.
    """

    def __init__(
        self,
        name: str,
        variable_name: str,
        target_frame: str,
        source_frame: str,
        static: bool,
        qos_profile: QoSProfile,
        static_qos_profile: QoSProfile | None = None,
    ) -> None:
        super().__init__(name=name)
        self.blackboard = self.attach_blackboard_client(name)
        self.blackboard.register_key(key=variable_name, access=Access.READ)
        self.variable_name = variable_name
        self.target_frame = target_frame
        self.source_frame = source_frame
        self.static = static
        self.qos_profile = qos_profile
        self.static_qos_profile = static_qos_profile
        self.node: Node | None = None
        self.broadcaster: Any = None

    def setup(self, **kwargs: Any) -> None:
        """Create the broadcaster on the given ``node``."""
        self.node = node_of(self, kwargs)
        if not self.static:
            self.broadcaster = TransformBroadcaster(self.node, qos=self.qos_profile)
        elif self.static_qos_profile is None:
            self.broadcaster = StaticTransformBroadcaster(self.node)
        else:
            self.broadcaster = StaticTransformBroadcaster(self.node, qos=self.static_qos_profile)

    def update(self) -> Status:
        """Send the transform."""
        assert self.node is not None
        try:
            transform = self.blackboard.get(self.variable_name)
        except KeyError:
            transform = None
        if transform is None:
            self.feedback_message = f"no transform to send [{self.variable_name}]"
            return Status.FAILURE
        stamped = TransformStamped(transform=transform, child_frame_id=self.source_frame)
        stamped.header.stamp = self.node.get_clock().now().to_msg()
        stamped.header.frame_id = self.target_frame
        self.broadcaster.sendTransform(stamped)
        self.feedback_message = "transform sent"
        return Status.SUCCESS


class ToBlackboard(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Behaviour that stores the latest transform between two frames: SUCCESS, or RUNNING while it is not known.

    Parameters
    ----------
    name
        Name of the behaviour.
    variable_name
        The variable, a `geometry_msgs/msg/TransformStamped`.
    target_frame, source_frame
        Frames; see `tf2_ros.Buffer.lookup_transform`.
    qos_profile, static_qos_profile
        Qualities of service.
    clearing_policy
        When to set the variable to None: ON_INITIALISE or NEVER; raises TypeError for another one.
    """

    def __init__(
        self,
        name: str,
        variable_name: str,
        target_frame: str,
        source_frame: str,
        qos_profile: QoSProfile,
        static_qos_profile: QoSProfile | None = None,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        if clearing_policy == ClearingPolicy.ON_SUCCESS:
            raise TypeError("ON_SUCCESS is not a valid policy for transforms.ToBlackboard")
        super().__init__(name=name)
        self.blackboard = self.attach_blackboard_client(name)
        self.blackboard.register_key(key=variable_name, access=Access.WRITE)
        self.blackboard.set(variable_name, None)
        self.variable_name = variable_name
        self.target_frame = target_frame
        self.source_frame = source_frame
        self.qos_profile = qos_profile
        self.static_qos_profile = static_qos_profile
        self.clearing_policy = clearing_policy
        self.buffer = Buffer()
        self.listener: TransformListener | None = None
        self.node: Node | None = None

    def setup(self, **kwargs: Any) -> None:
        """Create the listener on the given ``node``."""
        self.node = node_of(self, kwargs)
        self.listener = TransformListener(
            self.buffer, self.node, qos=self.qos_profile, static_qos=self.static_qos_profile
        )

    def initialise(self) -> None:
        """Set the variable to None, if the policy says so."""
        if self.clearing_policy == ClearingPolicy.ON_INITIALISE:
            self.blackboard.set(self.variable_name, None)

    def update(self) -> Status:
        """Store the transform."""
        if not self.buffer.can_transform(self.target_frame, self.source_frame, Time()):
            self.feedback_message = f"waiting for transform [{self.source_frame} -> {self.target_frame}]"
            return Status.RUNNING
        transform = self.buffer.lookup_transform(self.target_frame, self.source_frame, Time())
        self.blackboard.set(self.variable_name, transform)
        self.feedback_message = f"transform saved to {self.variable_name}"
        return Status.SUCCESS
