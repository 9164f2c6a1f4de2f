"""Graph queries of nodes, answered from the graph that the daemon has discovered."""

from __future__ import annotations

from types import TracebackType

from rclpy.impl import names
from rclpy.impl.errors import NodeNameNonExistentError
from rclpy.impl.node_graph import NodeGraph

from daidalos.transport.graph import EndpointKind, Graph, NodeInfo, names_and_types
from ros2cli.node import NODE_NAME_PREFIX

_NAME_PREFIX = f"{NODE_NAME_PREFIX}_daemon"


class GraphView(NodeGraph):
    """The methods of a node that ask about the graph, in the place of the daemon's node.

    Parameters
    ----------
    graph
        The daemon's graph.
    """

    def __init__(self, graph: Graph) -> None:
        self.handle = _Handle(graph)  # type: ignore[assignment]

    def get_name(self) -> str:
        """Return the name of the daemon's node."""
        names = (node.name for node in self.handle.graph.nodes())
        return next((name for name in names if name.startswith(_NAME_PREFIX)), _NAME_PREFIX)

    def get_namespace(self) -> str:
        """Return the namespace of the daemon's node."""
        return "/"


class _Handle:
    """Handle of the daemon's node, as far as graph queries use it."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph

    def __enter__(self) -> _Handle:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the use of the handle."""

    def find_node(self, name: str, namespace: str) -> NodeInfo:
        """Return the description of a node; raises NodeNameNonExistentError when there is none of that name."""
        found = self.graph.find_nodes(name, namespace)
        if not found:
            raise NodeNameNonExistentError(f"the daemon knows no node '{namespace.rstrip('/')}/{name}'")
        return found[0]

    def names_and_types_of(self, name: str, namespace: str, kind: EndpointKind) -> list[tuple[str, list[str]]]:
        """Return what endpoints of a kind a node has."""
        return names_and_types(self.graph.endpoints_of(self.find_node(name, namespace), kind))

    def resolve_name(self, name: str, *, is_service: bool = False, only_expand: bool = False) -> str:
        """Return the full name of a topic or service, relative ones taken to be in the root namespace."""
        return names.expand(name, _NAME_PREFIX, "/")
