"""Messages of routes and graphs."""

from __future__ import annotations

from typing import Any

from daidalos.navigation.routes.graph import GraphNode, Route, RouteGraph

_NODE_SIZE, _EDGE_WIDTH, _TEXT_SIZE = 0.1, 0.05, 0.1
_RED, _GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 0.5)


def route_message(route: Route, frame: str, stamp: Any) -> Any:
    """Return a route as ``nav2_msgs/msg/Route``."""
    from nav2_msgs.msg import Route as RouteMessage
    from nav2_msgs.msg import RouteEdge, RouteNode
    from std_msgs.msg import Header

    return RouteMessage(
        header=Header(frame_id=frame, stamp=stamp),
        route_cost=float(route.cost),
        nodes=[RouteNode(nodeid=node.id, position=_point(node)) for node in route.nodes],
        edges=[RouteEdge(edgeid=edge.id, start=_point(edge.start), end=_point(edge.end)) for edge in route.edges],
    )


def graph_markers(graph: RouteGraph, frame: str, stamp: Any) -> Any:
    """Return a graph as ``visualization_msgs/msg/MarkerArray``: nodes, edges and their identifiers."""
    from visualization_msgs.msg import Marker, MarkerArray

    def marker(kind: int, name: str, size: float, color: tuple[float, ...], identifier: int = 0) -> Any:
        one = Marker(ns=f"route_graph_{name}", id=identifier, type=kind)
        one.header.frame_id, one.header.stamp = frame, stamp
        one.scale.x = one.scale.y = one.scale.z = size
        one.color.r, one.color.g, one.color.b, one.color.a = color
        one.pose.orientation.w = 1.0
        return one

    def label(name: str, color: tuple[float, ...], identifier: int, x: float, y: float, text: int) -> Any:
        one = marker(Marker.TEXT_VIEW_FACING, name, _TEXT_SIZE, color, identifier)
        one.pose.position.x, one.pose.position.y, one.text = x + 0.07, y, str(text)
        return one

    nodes = marker(Marker.SPHERE_LIST, "nodes", _NODE_SIZE, _RED)
    edges = marker(Marker.LINE_LIST, "edges", _EDGE_WIDTH, _GREEN)
    nodes.points = [_point(node) for node in graph.nodes.values()]
    edges.points = [_point(end) for edge in graph.edges for end in (edge.start, edge.end)]
    labels = [
        label("node_ids", _RED, index, node.x, node.y, node.id)
        for index, node in enumerate(graph.nodes.values(), start=1)
    ]
    for index, edge in enumerate(graph.edges, start=1):
        aside = 0.05 if edge.start.id > edge.end.id else -0.05  # the labels of both directions stay legible
        x, y = 0.5 * (edge.start.x + edge.end.x), 0.5 * (edge.start.y + edge.end.y)
        labels.append(label("edge_ids", (*_GREEN[:3], 1.0), index, x, y + aside, edge.id))
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL), *labels, edges, nodes])


def _point(node: GraphNode) -> Any:
    from geometry_msgs.msg import Point

    return Point(x=float(node.x), y=float(node.y), z=0.0)
