"""Graph of places that robots drive between: nodes, directed edges, and what is known and done there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import transform_points

TRIGGERS = ("NODE", "ON_ENTER", "ON_EXIT")
"""When an operation is carried out: at a node, or where an edge is entered or left."""


@dataclass(frozen=True)
class GraphOperation:
    """Operation that a graph asks for.

    Attributes
    ----------
    type : str
        Name of the operation in the parameters of the route server.
    trigger : str
        One of `TRIGGERS`.
    metadata : mapping
        For the operation.
    """

    type: str
    trigger: str
    metadata: Mapping[str, Any] = field(default_factory=dict)


@dataclass(eq=False)
class GraphNode:
    """Place of a graph.

    Attributes
    ----------
    id : int
        Unique among the nodes of a graph.
    x, y : float
        Position [m].
    frame : str
        Frame of the position; empty for that of the graph.
    metadata : dict
        Whatever the graph says about it.
    operations : tuple of GraphOperation
    """

    id: int
    x: float
    y: float
    frame: str = ""
    metadata: dict[str, Any] = field(default_factory=dict)
    operations: tuple[GraphOperation, ...] = ()

    @property
    def point(self) -> Array:
        """Position [m], shape (2,)."""
        return np.array([self.x, self.y])


@dataclass(eq=False)
class GraphEdge:
    """Directed connection of two nodes.

    Attributes
    ----------
    id : int
        By which requests close it; edges of one identifier are closed together.
    start, end : GraphNode
    cost : float
        Fixed cost; it counts where no scorers are used or it may not be overridden.
    overridable : bool
        Whether scorers decide the cost.
    metadata : dict
        Whatever the graph says about it, and what was learned on the way.
    operations : tuple of GraphOperation
    """

    id: int
    start: GraphNode
    end: GraphNode
    cost: float = 0.0
    overridable: bool = True
    metadata: dict[str, Any] = field(default_factory=dict)
    operations: tuple[GraphOperation, ...] = ()

    @property
    def length(self) -> float:
        """Length [m]."""
        return math.hypot(self.end.x - self.start.x, self.end.y - self.start.y)

    @property
    def heading(self) -> float:
        """Direction [rad]."""
        return math.atan2(self.end.y - self.start.y, self.end.x - self.start.x)

    def number(self, key: str, default: float) -> float:
        """Return a number of the metadata; the default where there is none, or it is no number."""
        value = self.metadata.get(key, default)
        return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else default


class RouteGraph:
    """Nodes by their identifiers, and the edges between them.

    Parameters
    ----------
    nodes : iterable of GraphNode
    edges : iterable of GraphEdge
        Between these nodes.
    """

    def __init__(self, nodes: Iterable[GraphNode] = (), edges: Iterable[GraphEdge] = ()) -> None:
        self.nodes = {node.id: node for node in nodes}
        self.edges = tuple(edges)
        self._leaving: dict[int, list[GraphEdge]] = {}
        for edge in self.edges:
            self._leaving.setdefault(edge.start.id, []).append(edge)

    def edges_from(self, node: GraphNode) -> list[GraphEdge]:
        """Return the edges that leave a node."""
        return self._leaving.get(node.id, [])

    @property
    def frames(self) -> set[str]:
        """Frames in which positions are given."""
        return {node.frame for node in self.nodes.values() if node.frame}

    def transform(self, frame: str, poses: Mapping[str, Array]) -> None:
        """Express all positions in one frame.

        Parameters
        ----------
        frame : str
        poses : mapping of str to ndarray
            Pose (x, y, yaw) of each other frame in it.
        """
        for node in self.nodes.values():
            if node.frame not in ("", frame):
                node.x, node.y = transform_points(poses[node.frame], node.point[None])[0].tolist()
            node.frame = frame

    @cached_property
    def _positions(self) -> tuple[Array, list[GraphNode]]:
        nodes = list(self.nodes.values())
        return np.array([(node.x, node.y) for node in nodes]).reshape(-1, 2), nodes

    def nearest(self, point: Array, count: int) -> list[GraphNode]:
        """Return the nodes nearest to a point (x, y) [m], the nearest first."""
        positions, nodes = self._positions
        distances = np.hypot(*(positions - np.asarray(point)[:2]).T)
        order = np.argsort(distances, kind="stable")[:count]
        return [nodes[index] for index in order]


@dataclass(frozen=True)
class Route:
    """Way through a graph.

    Attributes
    ----------
    start : GraphNode
    edges : tuple of GraphEdge
        In order; none for a route that ends where it begins.
    costs : tuple of float
        Of the edges.
    """

    start: GraphNode
    edges: tuple[GraphEdge, ...] = ()
    costs: tuple[float, ...] = ()

    @property
    def cost(self) -> float:
        """Total cost."""
        return sum(self.costs)

    @property
    def nodes(self) -> tuple[GraphNode, ...]:
        """Nodes in order."""
        return (self.start, *(edge.end for edge in self.edges))

    def without_first(self) -> Route:
        """Return the route from its second node on."""
        return Route(self.edges[0].end, self.edges[1:], self.costs[1:])

    def without_last(self) -> Route:
        """Return the route to its last node but one."""
        return Route(self.start, self.edges[:-1], self.costs[:-1])


def closest_point(point: Array, start: Array, end: Array) -> Array:
    """Return the point (2,) of the line from start to end that is nearest to a point [m]."""
    along = end - start
    square = float(along @ along)
    if square < 1e-12:
        return start
    share = float((point[:2] - start) @ along) / square
    nearest: Array = start + min(max(share, 0.0), 1.0) * along
    return nearest
