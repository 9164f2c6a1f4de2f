"""Node that is spun in a thread of its own, beside the state machine."""

from __future__ import annotations

import threading
from contextlib import suppress
from typing import Any

from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node


class SmachNode(Node):
    """Node for a state machine.

    Parameters
    ----------
    node_name
        Name of the node.
    keywords
        For `rclpy.node.Node`.
    """

    def __init__(self, node_name: str, **keywords: Any) -> None:
        super().__init__(node_name, **keywords)
        self.__executor = SingleThreadedExecutor()
        self.__thread: threading.Thread | None = None

    def start(self) -> None:
        """Start to spin the node."""
        self.__executor.add_node(self)

        def spin() -> None:
            with suppress(ExternalShutdownException):
                self.__executor.spin()

        self.__thread = threading.Thread(target=spin)
        self.__thread.start()

    def join(self) -> None:
        """Wait until the node is no longer spun."""
        if self.__thread is not None:
            self.__thread.join()
