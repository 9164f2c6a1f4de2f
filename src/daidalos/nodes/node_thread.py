"""Contained node, spun in a thread of its own."""

from __future__ import annotations

import threading

from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from daidalos.common import tracebacks
from daidalos.nodes.runner import fail, make_executor


class NodeThread:
    """Spins a node until `stop`; an error in one of its callbacks ends the process.

    Parameters
    ----------
    node : Node
    threads : int
        How many of its callbacks may run at the same time.
    """

    def __init__(self, node: Node, threads: int = 1) -> None:
        self._executor = make_executor(threads, node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, name=node.get_name(), daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return
        except Exception as error:
            tracebacks.show(type(error), error, error.__traceback__)
            fail()

    def stop(self) -> None:
        """End; the node's callbacks have returned afterwards."""
        self._executor.shutdown()
        if self._thread is not threading.current_thread():
            self._thread.join(timeout=5.0)
