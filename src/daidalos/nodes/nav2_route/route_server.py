"""`route_server`: finds routes through a graph of places, and tracks the robot along them."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import compose, inverse
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import IndeterminateNodes
from daidalos.navigation.extensions import EDGE_SCORERS, GRAPH_FILE_LOADERS, ROUTE_OPERATIONS
from daidalos.navigation.routes.contracts import EdgeScorer, GraphFileLoader, RouteExtension, RouteRequest
from daidalos.navigation.routes.costs import RouteCosts
from daidalos.navigation.routes.dense_path import DensePathParameters, dense_path
from daidalos.navigation.routes.goal_intent import (
    GoalIntentParameters,
    nearest_node,
    node_of,
    prune_goal,
    prune_start,
)
from daidalos.navigation.routes.graph import GraphEdge, GraphNode, Route, RouteGraph, closest_point
from daidalos.navigation.routes.search import find_route
from daidalos.navigation.routes.tracker import RouteTracker, TrackerParameters
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import path_message, pose2_of, pose2_of_transform
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.nav2_route._operations import Operations
from daidalos.nodes.nav2_route._route_messages import graph_markers, route_message
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import duration_message, nanoseconds

_DEFAULT_PLUGINS = {
    name: f"nav2_route::{name}"
    for name in (
        "GeoJsonGraphFileLoader", "DistanceScorer", "DynamicEdgesScorer", "AdjustSpeedLimit", "ReroutingService"
    )
}  # fmt: skip
_WITHOUT_EFFECT = {
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "service_introspection_mode": "service introspection is configured by each service's own parameters",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class RouteServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `data_timeout` is ours."""

    route_frame: str = parameter("map", "Frame of the graph and of routes.", not_empty=True, read_only=True)
    base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    costmap_topic: str = parameter(
        "global_costmap/costmap_raw", "Topic of the costmap by which nodes near poses are found.", not_empty=True,
        read_only=True,
    )  # fmt: skip
    graph_filepath: str = parameter("", "File of the graph; empty for none yet.", read_only=True)
    graph_file_loader: str = parameter(
        "GeoJsonGraphFileLoader", "Name of the reader of graph files.", not_empty=True, read_only=True
    )
    edge_cost_functions: tuple[str, ...] = parameter(
        ("DistanceScorer", "DynamicEdgesScorer"), "Names of the scorers of edges.", unique=True, read_only=True
    )
    operations: tuple[str, ...] = parameter(
        ("AdjustSpeedLimit", "ReroutingService"), "Names of the operations.", unique=True, read_only=True
    )
    max_iterations: int = parameter(0, "Largest number of nodes of a search; 0 or less: any number.")
    max_planning_time: float = parameter(2.0, "Longest search; 0: any time.", unit="s", minimum=0.0)
    tracker_update_rate: float = parameter(50.0, "Looks at the robot's pose per second.", unit="Hz", above=0.0)
    aggregate_blocked_ids: bool = parameter(
        False, "Whether what was blocked once stays so until the goal ends, rather than until the next route."
    )
    data_timeout: float = parameter(
        1.0, "Age of the robot's transform from which on tracking is aborted.", unit="s", above=0.0
    )


@dataclass
class _Search:
    """Search for a goal, and what tracking adds to it: another start, blocked places and the edge underway."""

    goal: Any
    node: GraphNode | None = None
    pose: Array | None = None
    edge: GraphEdge | None = None
    blocked: set[int] = field(default_factory=set)


class RouteServer(ManagedNode):
    """Server of ``compute_route`` and ``compute_and_track_route``."""

    def __init__(self, node_name: str = "route_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        set_to = partial(partial, self._reconfigure)
        self._settings = declare(self, RouteServerParameters, reconfigure=set_to("_settings"))
        self._intent = declare(self, GoalIntentParameters, reconfigure=set_to("_intent"))
        self._path = declare(self, DensePathParameters, reconfigure=set_to("_path"))
        self._tracking = declare(self, TrackerParameters, reconfigure=set_to("_tracking"))
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._current: dict[str, Any] = {}

    def _reconfigure(self, name: str, parameters: Any) -> None:
        """Use other parameters from the next goal or cycle on."""
        setattr(self, name, parameters)

    def configure(self) -> None:
        """Load the graph, make scorers and operations, and serve."""
        from nav2_msgs.action import ComputeAndTrackRoute, ComputeRoute
        from nav2_msgs.srv import SetRouteGraph
        from nav_msgs.msg import Path as PathMessage
        from visualization_msgs.msg import MarkerArray

        declare_without_effect(self, _WITHOUT_EFFECT)
        p = self._settings
        self._costmaps: dict[str, tuple[Costmap, str] | None] = {}
        maker = ExtensionMaker(self, NavigationContext(global_frame=p.route_frame, base_frame=p.base_frame))
        make = partial(self._make, maker)
        self._loader: GraphFileLoader = maker.make(
            GRAPH_FILE_LOADERS, p.graph_file_loader, _DEFAULT_PLUGINS.get(p.graph_file_loader, "")
        )
        self._scorers: dict[str, EdgeScorer] = {name: make(EDGE_SCORERS, name) for name in p.edge_cost_functions}
        self._carried_out = {name: make(ROUTE_OPERATIONS, name) for name in p.operations}
        self._operations = Operations(self, self._carried_out)
        self._listen(p.costmap_topic)
        self._markers = self.create_publisher(MarkerArray, "route_graph", LATCHED)
        self._plan = self.create_publisher(PathMessage, "plan", 1)
        self._graph = RouteGraph()
        if p.graph_filepath:
            self._use(self._loader.load(Path(p.graph_filepath)))
        self.create_service(SetRouteGraph, f"{self.get_name()}/set_route_graph", self._set_graph)
        self.serve_action(ComputeRoute, "compute_route", self._compute)
        self.serve_action(ComputeAndTrackRoute, "compute_and_track_route", self._compute_and_track)

    # Extensions, graph and costmaps.

    def _make(self, maker: ExtensionMaker, kind: Any, name: str) -> Any:
        """Make a scorer or an operation, with its services and its costs."""
        from rosidl_runtime_py.utilities import get_service

        made: RouteExtension = maker.make(kind, name, _DEFAULT_PLUGINS.get(name, ""))
        if made.costmap_topic:
            self._listen(made.costmap_topic)
        for offer in made.services:

            def answer(request: Any, response: Any, of: Any = offer) -> Any:
                of.answer(request)
                response.success = True
                return response

            self.create_service(get_service(offer.type), f"{self.get_name()}/{name}/{offer.name}", answer)
        return made

    def _listen(self, topic: str) -> None:
        from nav2_msgs.msg import Costmap as CostmapMessage

        if topic in self._costmaps:
            return

        def take(message: Any) -> None:
            self._costmaps[topic] = (costmap_of(message), message.header.frame_id)

        self._costmaps[topic] = None
        self.create_subscription(CostmapMessage, topic, take, LATCHED)

    def _costs(self, topic: str) -> RouteCosts | None:
        """Return the costs of a costmap at the places of the graph; None where there is none yet."""
        known = self._costmaps.get(topic)
        if known is None:
            return None
        costmap, frame = known
        if frame == self._settings.route_frame:
            return RouteCosts(costmap)
        return RouteCosts(costmap, inverse(self._pose_in_route_frame(frame)))

    def _give_costs(self, extensions: Iterable[RouteExtension]) -> None:
        for one in extensions:
            if one.costmap_topic:
                one.costs = self._costs(one.costmap_topic)

    def _set_graph(self, request: Any, response: Any) -> Any:
        """Use the graph of another file; the present one stays where that fails."""
        try:
            self._use(self._loader.load(Path(request.graph_filepath)))
            response.success = True
        except UserError as error:
            self.get_logger().error(f"the graph was not changed: {error}")
            response.success = False
        return response

    def _use(self, graph: RouteGraph) -> None:
        unknown = self._operations.unknown(graph)
        if unknown:
            self.get_logger().warning(
                f"the graph asks for operations that are not among 'operations': {unknown}; routes that come there fail"
            )
        self._graph = graph
        if not graph.frames - {self._settings.route_frame}:
            self._show_graph()

    def _show_graph(self) -> None:
        self._markers.publish(graph_markers(self._graph, self._settings.route_frame, self.get_clock().now().to_msg()))

    def _graph_in_route_frame(self) -> RouteGraph:
        """Return the graph, whose places are transformed before it is used first."""
        frames = self._graph.frames - {self._settings.route_frame}
        if frames:
            poses = {frame: self._pose_in_route_frame(frame) for frame in frames}
            self._graph.transform(self._settings.route_frame, poses)
            self._show_graph()
        return self._graph

    # Poses.

    def _pose_in_route_frame(self, frame: str, *, timeout: float = math.inf) -> Array:
        """Return the latest pose (x, y, yaw) of a frame.

        Raises
        ------
        TransformFailed
            It is not known, or older than a time [s].
        """
        try:
            found = self._buffer.lookup_transform(self._settings.route_frame, frame, Time())
        except TransformException as error:
            raise TransformFailed(str(error)) from None
        stamp_ns = nanoseconds(found.header.stamp)
        age = (self.get_clock().now().nanoseconds - stamp_ns) * 1e-9 if stamp_ns else 0.0
        if age > timeout:
            raise TransformFailed(f"the transform of {frame} is {age:.3g} s old, longer than {timeout:g} s")
        return pose2_of_transform(found.transform)

    def _robot(self) -> Array:
        return self._pose_in_route_frame(self._settings.base_frame, timeout=self._settings.data_timeout)

    def _given(self, stamped: Any) -> Array:
        """Return a ``PoseStamped`` of a request in the frame of routes; IndeterminateNodes where it is not finite."""
        frame, pose = stamped.header.frame_id, pose2_of(stamped.pose)
        if not np.isfinite(pose).all():
            raise IndeterminateNodes("a pose of the goal is not finite")
        return pose if frame in ("", self._settings.route_frame) else compose(self._pose_in_route_frame(frame), pose)

    # Routes.

    def _find(self, search: _Search) -> tuple[Route, Array, GraphEdge | None]:
        """Return a route, its path, and the edge to the route's begin on which the robot is already."""
        begun, goal = time.monotonic(), search.goal
        graph, p = self._graph_in_route_frame(), self._settings
        start_pose, goal_pose = None, None
        if goal.use_poses:
            start_pose = self._given(goal.start) if goal.use_start else self._robot()
            goal_pose = self._given(goal.goal)
            costs = self._costs(p.costmap_topic) if self._intent.enable_nn_search else None
            end = nearest_node(graph, goal_pose, costs, self._intent)
            start = search.node or nearest_node(graph, start_pose, costs, self._intent)
        else:
            end = node_of(graph, goal.goal_id, "goal")
            start = search.node or node_of(graph, goal.start_id, "start")
        if search.node is not None:
            start = node_of(graph, start.id, "last")  # the graph may have been replaced meanwhile
        start_pose = start_pose if search.pose is None else search.pose
        route = Route(start)
        if start is not end:
            self._give_costs(self._scorers.values())
            request = RouteRequest(start, end, start_pose if goal.use_poses else None, goal_pose)
            route = find_route(
                graph, request, list(self._scorers.values()), blocked=search.blocked, max_iterations=p.max_iterations,
                is_late=lambda: 0.0 < p.max_planning_time < time.monotonic() - begun,
            )  # fmt: skip
        return self._pruned(route, search, start_pose, goal_pose)

    def _pruned(
        self, route: Route, search: _Search, start_pose: Array | None, goal_pose: Array | None
    ) -> tuple[Route, Array, GraphEdge | None]:
        """Return a route without what is passed already, with its path; see `_find`."""
        edge, begin = None, None
        if start_pose is not None:
            pruned = prune_start(route, start_pose, self._intent)
            if pruned is not route and route.edges[0] is search.edge:
                edge = route.edges[0]
                begin = closest_point(start_pose, edge.start.point, edge.end.point)
            route = pruned
        if goal_pose is not None:
            route = prune_goal(route, goal_pose, self._intent)
        return route, dense_path(route, self._path, begin, self._warn), edge

    def _warn(self, line: str) -> None:
        self.get_logger().warning(line, throttle_duration_sec=5.0)

    def _published(self, path: Array) -> Any:
        message = path_message(path, self._settings.route_frame, self.get_clock().now().to_msg())
        self._plan.publish(message)
        return message

    async def _compute(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import ComputeRoute

        begun = time.monotonic()
        route, path, _ = self._find(_Search(goal_handle.request))
        result = ComputeRoute.Result(path=self._published(path))
        result.route = route_message(route, self._settings.route_frame, self.get_clock().now().to_msg())
        result.planning_time = duration_message(time.monotonic() - begun)
        goal_handle.succeed()
        return result

    async def _compute_and_track(self, goal_handle: Any) -> Any:
        """Track the robot along a route, and along others where operations ask for it; another goal replaces it."""
        from nav2_msgs.action import ComputeAndTrackRoute

        result = ComputeAndTrackRoute.Result()
        begun_ns = self.get_clock().now().nanoseconds
        self._current["track"] = goal_handle
        search: _Search | None = _Search(goal_handle.request)
        while search is not None and not self._is_over(goal_handle):
            search = await self._track(goal_handle, search)
        result.execution_duration = duration_message(1e-9 * (self.get_clock().now().nanoseconds - begun_ns))
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif self._current["track"] is not goal_handle:
            result.error_msg = "replaced by another goal"
            goal_handle.abort(result)
        else:
            goal_handle.succeed()
        return result

    def _is_over(self, goal_handle: Any) -> bool:
        is_active = goal_handle.is_active and not goal_handle.is_cancel_requested
        return not is_active or self._current["track"] is not goal_handle

    async def _track(self, goal_handle: Any, search: _Search) -> _Search | None:
        """Track the robot along one route; return the search for the next one, None at the end."""
        route, path, edge = self._find(search)
        tracker = RouteTracker(route, self._tracking, edge)
        feedback = partial(self._tell, goal_handle, tracker, self._published(path))
        feedback(rerouted=True)
        with Cycle(self, self._settings.tracker_update_rate) as cycle:
            while not self._is_over(goal_handle):
                pose = self._robot()
                has_changed = tracker.update(pose)
                self._give_costs(self._carried_out.values())
                outcome = await self._operations.process(
                    tracker.progress(pose), has_changed=has_changed, is_over=partial(self._is_over, goal_handle)
                )
                if has_changed or outcome.triggered:
                    feedback(triggered=outcome.triggered)
                if tracker.is_completed:
                    return None
                if outcome.reroute:
                    return self._next(search, tracker, pose, outcome.blocked)
                await cycle.next()
        return None

    def _next(self, search: _Search, tracker: RouteTracker, pose: Array, blocked: set[int]) -> _Search:
        """Return the search for the route after another one."""
        blocked = blocked | search.blocked if self._settings.aggregate_blocked_ids else blocked
        around = f" around {', '.join(map(str, sorted(blocked)))}" if blocked else ""
        self.get_logger().info(f"another route{around} is searched")
        if tracker.last_node is None:
            return _Search(search.goal, blocked=blocked)
        return replace(search, node=tracker.last_node, pose=pose, edge=tracker.edge, blocked=blocked)

    def _tell(
        self,
        goal_handle: Any,
        tracker: RouteTracker,
        path: Any,
        *,
        rerouted: bool = False,
        triggered: list[str] | None = None,
    ) -> None:
        from nav2_msgs.action import ComputeAndTrackRoute

        def id_of(one: GraphNode | GraphEdge | None) -> int:
            return one.id if one is not None else 0

        goal_handle.publish_feedback(
            ComputeAndTrackRoute.Feedback(
                last_node_id=id_of(tracker.last_node), next_node_id=id_of(tracker.next_node),
                current_edge_id=id_of(tracker.edge), path=path, operations_triggered=triggered or [],
                route=route_message(tracker.route, path.header.frame_id, path.header.stamp), rerouted=rerouted,
            )
        )  # fmt: skip
