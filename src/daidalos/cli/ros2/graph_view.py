"""Graph for verbs, from the daemon or from a node of their own."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ros2cli.node import NODE_NAME_PREFIX
from ros2cli.node.direct import direct_node

if TYPE_CHECKING:
    from daidalos.transport.graph import Graph


@contextmanager
def graph_view(args: argparse.Namespace) -> Iterator[Graph]:
    """Yield the graph, from the daemon if one runs and may be used, else from a new node.

    Parameters
    ----------
    args
        What `ros2cli.node.strategy.add_arguments` declared, as far as the verb did.
    """
    from rclpy.utilities import get_rmw_implementation_identifier
    from ros2cli.daemon import client

    if getattr(args, "no_daemon", False):
        with direct_node(args) as node:
            yield node.handle.graph
        return
    graph = client.fetch_graph()
    if graph is not None:
        yield graph
        return
    slow = get_rmw_implementation_identifier() == "rmw_cyclonedds_cpp"
    if slow:  # discovery takes half a second, which the next command is to be spared
        client.start_in_background()
    with direct_node(args) as node:
        graph = node.handle.graph
        yield graph
        if not slow and any(not other.name.startswith(NODE_NAME_PREFIX) for other in graph.nodes()):
            client.start_in_background()
