"""The node that a verb takes part in the graph with, and the graph as it sees it."""

from __future__ import annotations

import argparse
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.node import Node

    from daidalos.transport.graph import Graph

NODE_NAME_PREFIX = "_ros2cli"
_TIMEOUT_S = 2.0
"""How long processes of this machine that are there may take to tell of themselves."""


def add_direct_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of verbs that need a node of their own."""
    parser.add_argument(
        "--spin-time",
        type=float,
        default=None,
        help="Spin time in seconds to wait for discovery (only applies when not using an already running daemon)",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--ros-args", nargs=argparse.REMAINDER, default=[], help=argparse.SUPPRESS)


def add_graph_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of verbs that ask about the graph."""
    add_direct_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true", help="Do not spawn nor use an already running daemon")


@contextmanager
def direct_node(args: argparse.Namespace, name: str | None = None, **options: Any) -> Iterator[Node]:
    """Give a node of our own, after everybody on this machine has told of itself.

    Parameters
    ----------
    args
        What `add_direct_arguments` declared, as far as the verb did.
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
        options = {"start_parameter_services": False, "parameter_overrides": overrides, **options}
        node = rclpy.create_node(name or f"{NODE_NAME_PREFIX}_{os.getpid()}", **options)
        try:
            with watching(signal.SIGINT):
                wait_for_discovery(node, getattr(args, "spin_time", None))
                yield node
        finally:
            node.destroy_node()
    finally:
        rclpy.try_shutdown()


def wait_for_discovery(node: Node, spin_time: float | None) -> None:
    """Wait until who is on this machine has told of itself, and `spin_time` seconds for who is elsewhere."""
    session = node.handle.session
    session.backend.settle(_TIMEOUT_S)
    if spin_time:
        session.graph.wait_for(lambda: False, spin_time)


@contextmanager
def graph_view(args: argparse.Namespace) -> Iterator[Graph]:
    """Give the graph, from the daemon if one runs and may be used, else from a node of our own."""
    from daidalos.cli.ros2.daemon import client

    if getattr(args, "no_daemon", False):
        with direct_node(args) as node:
            yield node.handle.graph
        return
    graph = client.fetch_graph()
    if graph is not None:
        yield graph
        return
    with direct_node(args) as node:
        graph = node.handle.graph
        yield graph
        if any(not other.name.startswith(NODE_NAME_PREFIX) for other in graph.nodes()):
            client.spawn_quietly()
