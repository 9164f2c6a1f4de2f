"""Behaviours that publish."""

from __future__ import annotations

from typing import Any

import py_trees
from rclpy.node import Node
from rclpy.qos import QoSProfile


def node_of(behaviour: Any, keywords: dict[str, Any]) -> Node:
    """Return the node among the arguments of a behaviour's `setup`; raises KeyError if there is none."""
    if "node" not in keywords:
        raise KeyError(f"didn't find 'node' in setup's kwargs [{behaviour.name}][{type(behaviour).__name__}]")
    node: Node = keywords["node"]
    return node


class FromBlackboard(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Behaviour that publishes a variable of the blackboard: SUCCESS, or FAILURE without such a variable.

    `update` raises TypeError for a variable that is not a message of the topic.

    Parameters
    ----------
    name
        Name of the behaviour.
    topic_name, topic_type, qos_profile
        The topic, the class of its messages and the quality of service.
    blackboard_variable
        Name of the variable, with a message; may be nested, such as ``robot.pose``.
    """

    def __init__(
        self, name: str, topic_name: str, topic_type: Any, qos_profile: QoSProfile, blackboard_variable: str
    ) -> None:
        super().__init__(name=name)
        self.topic_name = topic_name
        self.topic_type = topic_type
        self.qos_profile = qos_profile
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard_variable = blackboard_variable
        self.key = blackboard_variable.split(".")[0]
        self.blackboard.register_key(key=self.key, access=py_trees.common.Access.READ)
        self.publisher: Any = None
        self.node: Node | None = None

    def setup(self, **kwargs: Any) -> None:
        """Create the publisher on the given ``node``."""
        self.node = node_of(self, kwargs)
        self.publisher = self.node.create_publisher(self.topic_type, self.topic_name, self.qos_profile)

    def update(self) -> py_trees.common.Status:
        """Publish the variable."""
        try:
            message = self.blackboard.get(self.blackboard_variable)
        except KeyError:
            self.feedback_message = "nothing to publish"
            return py_trees.common.Status.FAILURE
        if not isinstance(message, self.topic_type):
            raise TypeError(f"{self.blackboard_variable} is not the required type [{self.topic_type}][{type(message)}]")
        self.publisher.publish(message)
        self.feedback_message = "published"
        return py_trees.common.Status.SUCCESS
