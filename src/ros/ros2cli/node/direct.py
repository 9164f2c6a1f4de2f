"""A node of a command's own."""

from __future__ import annotations

import argparse
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ros2cli.node import NODE_NAME_PREFIX

if TYPE_CHECKING:
    from rclpy.node import Node

DEFAULT_TIMEOUT = 0.0
"""How much longer to wait for the discovery of other machines, unless ``--spin-time`` says so [s]."""

_DISCOVERY_TIMEOUT_S = 2.0
"""How long the discovery of the processes of this machine may take [s]."""


class DirectNode:
    """A node in the graph, from the beginning to the end of a ``with`` block; it has the attributes of the node.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    node_name
        The node's name; a hidden one where None.
    """

    node: Node

    def __init__(self, args: argparse.Namespace, *, node_name: str | None = None) -> None:
        self._context = direct_node(args, node_name)

    def __enter__(self) -> DirectNode:
        self.node = self._context.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._context.__exit__(kind, error, trace)

    def __getattr__(self, name: str) -> Any:
        if name == "node":
            raise AttributeError("the node is there only within a `with` block")
        return getattr(self.node, name)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of verbs that need a node of their own."""
    parser.add_argument(
        "--spin-time",
        type=float,
        default=DEFAULT_TIMEOUT,
        help="Spin time in seconds to wait for discovery (only applies when not using an already running daemon)",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--ros-args", nargs=argparse.REMAINDER, default=[], help=argparse.SUPPRESS)


@contextmanager
def direct_node(args: argparse.Namespace, name: str | None = None, **options: Any) -> Iterator[Node]:
    """Yield a node of our own, after all processes of this machine were discovered.

    Parameters
    ----------
    args
        What `add_arguments` declared, as far as the verb did.
    name
        The node's name; a hidden one with our process's number where None.
    options
        For `rclpy.create_node`.
    """
    import rclpy
    from rclpy.impl.signal_watch import watching
    from rclpy.parameter import Parameter

    ros_args = getattr(args, "ros_args", [])
    # Ctrl-C raises KeyboardInterrupt, wherever we are.
    rclpy.init(args=["--ros-args", *ros_args] if ros_args else [], signal_handler_options=rclpy.SignalHandlerOptions.NO)
    try:
        overrides: list[Parameter[Any]] = []
        if getattr(args, "use_sim_time", False):
            overrides.append(Parameter("use_sim_time", value=True))
        if not getattr(args, "start_type_description_service", True):
            overrides.append(Parameter("start_type_description_service", value=False))
        options = {"start_parameter_services": False, "parameter_overrides": overrides, **options}
        node = rclpy.create_node(name or f"{NODE_NAME_PREFIX}_{os.getpid()}", **options)
        try:
            with watching(signal.SIGINT):
                _wait_for_discovery(node, getattr(args, "spin_time", None))
                yield node
        finally:
            node.destroy_node()
    finally:
        rclpy.try_shutdown()


def _wait_for_discovery(node: Node, spin_time: float | None) -> None:
    """Wait for the discovery of this machine's processes, and `spin_time` seconds for that of others."""
    session = node.handle.session
    session.backend.settle(_DISCOVERY_TIMEOUT_S)
    if spin_time:
        session.graph.wait_for(lambda: False, spin_time)
