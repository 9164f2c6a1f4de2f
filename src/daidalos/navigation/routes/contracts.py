"""Contracts of the extensions of routes: readers of graph files, scorers of edges, operations on the way."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from daidalos.common.arrays import Array
from daidalos.navigation.contracts import NavigationExtension
from daidalos.navigation.routes.costs import RouteCosts
from daidalos.navigation.routes.graph import GraphEdge, GraphNode, Route, RouteGraph


@dataclass(frozen=True)
class ServiceOffer:
    """Service that an extension offers.

    Attributes
    ----------
    name : str
        Last part of its name, after those of the server and the extension.
    type : str
        Such as ``std_srvs/srv/Trigger``; its response has a field `success`.
    answer : callable
        Called with the request.
    """

    name: str
    type: str
    answer: Callable[[Any], None]


class GraphFileLoader(NavigationExtension):
    """Reader of graph files."""

    @abstractmethod
    def load(self, path: Path) -> RouteGraph:
        """Return the graph of a file.

        Raises
        ------
        NoValidGraph
            The file is missing or has no valid graph; the message names file and line.
        """


class RouteExtension(NavigationExtension):
    """Base of scorers and operations.

    Attributes
    ----------
    costs : RouteCosts or None
        Of the latest costmap of `costmap_topic`; the server sets it before each request.
    """

    costs: RouteCosts | None = None

    @property
    def costmap_topic(self) -> str:
        """Topic of the costmap that it needs; empty where it needs none."""
        return ""

    @property
    def services(self) -> tuple[ServiceOffer, ...]:
        """Services that it offers."""
        return ()


@dataclass(frozen=True)
class RouteRequest:
    """Request for a route.

    Attributes
    ----------
    start, goal : GraphNode
    start_pose, goal_pose : ndarray, shape (3,), or None
        Poses (x, y, yaw) that were asked for; None where nodes were.
    """

    start: GraphNode
    goal: GraphNode
    start_pose: Array | None = None
    goal_pose: Array | None = None


class EdgeScorer(RouteExtension):
    """Scorer of edges; the costs of all scorers are added."""

    @abstractmethod
    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Return the cost of an edge, None where it must not be used.

        Raises
        ------
        InvalidScorerUse
            The request lacks what the scorer needs.
        """


@dataclass(frozen=True)
class Progress:
    """Progress of a robot on its route.

    Attributes
    ----------
    route : Route
    pose : ndarray, shape (3,)
        Of the robot (x, y, yaw) in the graph's frame.
    node : GraphNode or None
        The last node that was achieved.
    edge, left : GraphEdge or None
        The edge that the robot is on, and the one before it.
    """

    route: Route
    pose: Array
    node: GraphNode | None = None
    edge: GraphEdge | None = None
    left: GraphEdge | None = None


@dataclass(frozen=True)
class Message:
    """Message to publish, or service to call.

    Attributes
    ----------
    name : str
        Of the topic or service.
    type : str
        Such as ``nav2_msgs/msg/SpeedLimit``.
    fields : mapping
        Of the message or the request.
    """

    name: str
    type: str
    fields: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class OperationResult:
    """Result of an operation.

    Attributes
    ----------
    reroute : bool
        Whether another route is to be searched.
    blocked : tuple of int
        Edges or nodes that it must not use.
    published : tuple of Message
    called : Message or None
        A service whose response has a field `success`; the route fails where that is false or does not come.
    """

    reroute: bool = False
    blocked: tuple[int, ...] = ()
    published: tuple[Message, ...] = ()
    called: Message | None = None


NOTHING = OperationResult()

ON_GRAPH, ON_STATUS_CHANGE, ON_QUERY = "graph", "status_change", "query"
"""When an operation is carried out: where the graph asks for it, at each node, or all the time."""


class RouteOperation(RouteExtension):
    """Operation on the way along a route.

    Attributes
    ----------
    occasion : str
        Class attribute: `ON_GRAPH`, `ON_STATUS_CHANGE` or `ON_QUERY`.
    """

    occasion: str = ON_GRAPH

    @abstractmethod
    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Carry out the operation.

        Parameters
        ----------
        progress : Progress
        now : float
            Time [s].
        metadata : mapping
            What the graph says for the operation.

        Raises
        ------
        OperationFailed
            It cannot be done, and the robot must not go on.
        """
