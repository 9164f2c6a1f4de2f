"""The graph that checks and reports look at."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from daidalos.transport.graph import Graph

_shared: ContextVar[Graph | None] = ContextVar("graph", default=None)


@contextmanager
def shared_graph(graph: Graph) -> Iterator[None]:
    """Make all checks and reports look at one graph, in the manner of a command that has it already."""
    token = _shared.set(graph)
    try:
        yield
    finally:
        _shared.reset(token)


@contextmanager
def current_graph() -> Iterator[Graph]:
    """Yield the shared graph, or that of a node of our own where there is none."""
    graph = _shared.get()
    if graph is not None:
        yield graph
        return
    from ros2cli.node.direct import direct_node

    with direct_node(Namespace()) as node:
        yield node.handle.graph
