"""Tracking of a robot along a route."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import Progress
from daidalos.navigation.routes.graph import GraphEdge, GraphNode, Route


@dataclass(frozen=True)
class TrackerParameters(Parameters):
    """Parameters, by their Nav2 names."""

    radius_to_achieve_node: float = parameter(
        2.0, "Distance of a node within which the robot may pass it.", unit="m", above=0.0
    )
    boundary_radius_to_achieve_node: float = parameter(
        1.0, "Distance of the first and last node at which they are achieved.", unit="m", above=0.0
    )


class RouteTracker:
    """Tracker that says which nodes a robot has achieved.

    A node is achieved where the robot crosses the line that bisects the angle of its edges within
    `radius_to_achieve_node`, or leaves that circle; the first and last node where it comes near enough.

    Parameters
    ----------
    route : Route
    parameters : TrackerParameters
    edge : GraphEdge or None
        The edge to the route's first node that the robot is on already.
    """

    def __init__(self, route: Route, parameters: TrackerParameters, edge: GraphEdge | None = None) -> None:
        self.route = route
        self._parameters = parameters
        self._next: GraphNode | None = route.start
        self._edge = edge
        self._seed = edge
        self._last: GraphNode | None = edge.start if edge else None
        self._index = -1
        self._is_near = False

    @property
    def next_node(self) -> GraphNode | None:
        """The node ahead; None at the end."""
        return self._next

    @property
    def last_node(self) -> GraphNode | None:
        """The last node that was achieved."""
        return self._last

    @property
    def edge(self) -> GraphEdge | None:
        """The edge that the robot is on."""
        return self._edge

    @property
    def is_completed(self) -> bool:
        """Whether the last node was achieved."""
        return self._next is None

    def progress(self, pose: Array) -> Progress:
        """Return the progress of a robot at a pose (x, y, yaw)."""
        left = self._seed if self._index == 0 else self.route.edges[self._index - 1] if self._index > 0 else None
        return Progress(self.route, pose, self._last, self._edge, left)

    def update(self, pose: Array) -> bool:
        """Return whether the robot, at a pose (x, y, yaw), has achieved the next node."""
        if self._next is None or not self._has_achieved(self._next, pose):
            return False
        self._is_near = False
        self._last = self._next
        self._index += 1
        edges = self.route.edges
        self._edge = edges[self._index] if self._index < len(edges) else None
        self._next = self._edge.end if self._edge else None
        return True

    def _has_achieved(self, node: GraphNode, pose: Array) -> bool:
        offset = node.point - pose[:2]
        distance = float(np.hypot(*offset))
        is_boundary = self._index == len(self.route.edges) - 1 or self._edge is None
        p = self._parameters
        is_near = distance <= (p.boundary_radius_to_achieve_node if is_boundary else p.radius_to_achieve_node)
        has_left = self._is_near and not is_near
        self._is_near = is_near
        if distance < 1e-4 or has_left or is_boundary:
            return distance < 1e-4 or has_left or is_near
        return is_near and self._is_past_bisector(node, offset)

    def _is_past_bisector(self, node: GraphNode, offset: Array) -> bool:
        """Return whether the robot is beyond the line that bisects the angle between both edges of a node."""
        assert self._edge is not None
        into, out = node.point - self._edge.start.point, self.route.edges[self._index + 1].end.point - node.point
        lengths = math.hypot(*into), math.hypot(*out)
        if min(lengths) < 1e-6:
            return True
        return float((into / lengths[0] + out / lengths[1]) @ offset) <= 0.0
