"""State with a node."""

from __future__ import annotations

from typing import Any

import smach
from rclpy.node import Node


class RosState(smach.State):
    """Base of states that use a node.

    Parameters
    ----------
    node
        The node; somebody else spins it, in another thread.
    keywords
        See `smach.State`.
    """

    def __init__(self, node: Node, **keywords: Any) -> None:
        super().__init__(**keywords)
        self.__node = node

    @property
    def node(self) -> Node:
        """The node."""
        return self.__node
