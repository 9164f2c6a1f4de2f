"""A thread that runs a node's callbacks."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.node import Node


class MessagePump:
    """Thread that runs a node's callbacks, so that a test need not.

    Parameters
    ----------
    node
        The node.
    context
        Its context; the default one if not said.
    """

    def __init__(self, node: Node, context: Context | None = None) -> None:
        from rclpy.executors import SingleThreadedExecutor

        self._node = node
        self._executor = SingleThreadedExecutor(context=context)
        self._thread = threading.Thread(target=self._spin, daemon=True)

    def start(self) -> None:
        """Start running them."""
        self._executor.add_node(self._node)
        self._thread.start()

    def stop(self) -> None:
        """Run no more of them; returns when the last one has ended."""
        self._executor.shutdown()
        self._thread.join()

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self._executor.spin()
        except (ExternalShutdownException, ShutdownException):
            return
