"""Visitors of behaviours at the setup of a tree, and for messages."""

from __future__ import annotations

from typing import Any

import py_trees
from py_trees_ros_interfaces.msg import BehaviourTree
from rclpy.node import Node

from py_trees_ros import conversions


class SetupLogger(py_trees.visitors.VisitorBase):  # type: ignore[misc]
    """Visitor that logs how long the setup of each behaviour took.

    Parameters
    ----------
    node
        The node that logs.
    """

    def __init__(self, node: Node) -> None:
        super().__init__(full=True)
        self.node = node

    def initialise(self) -> None:
        """Start to measure."""
        self._begin = self._last = self.node.get_clock().now()

    def run(self, behaviour: Any) -> None:
        """Log the time since the last behaviour."""
        now = self.node.get_clock().now()
        self.node.get_logger().debug(f"'{behaviour.name}'.setup: {(now - self._last).nanoseconds * 1e-9:.4f}s")
        self._last = now

    def finalise(self) -> None:
        """Log the time since the start."""
        elapsed = (self.node.get_clock().now() - self._begin).nanoseconds * 1e-9
        self.node.get_logger().debug(f"Total tree setup time: {elapsed:.4f}s")


class TreeToMsgVisitor(py_trees.visitors.VisitorBase):  # type: ignore[misc]
    """Visitor that collects the behaviours in a message, `tree`."""

    def __init__(self) -> None:
        super().__init__(full=True)
        self.tree = BehaviourTree()

    def initialise(self) -> None:
        """Start a message."""
        self.tree = BehaviourTree()

    def run(self, behaviour: Any) -> None:
        """Add a behaviour to the message."""
        self.tree.behaviours.append(conversions.behaviour_to_msg(behaviour))
