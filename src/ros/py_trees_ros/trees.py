"""Behaviour trees in a graph: ticked by a timer, shown in snapshots; and the watcher of snapshots."""

from __future__ import annotations

import collections
import dataclasses
import enum
import itertools
import math
import statistics
import uuid
from collections.abc import Callable, Collection
from typing import Any

import py_trees
import rclpy
from diagnostic_msgs.msg import KeyValue
from py_trees.blackboard import Blackboard
from py_trees_ros_interfaces.msg import BehaviourTree as BehaviourTreeMessage
from py_trees_ros_interfaces.msg import SnapshotStreamParameters, Statistics
from py_trees_ros_interfaces.srv import CloseSnapshotStream, OpenSnapshotStream, ReconfigureSnapshotStream
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.time import Time

from py_trees_ros import blackboard, conversions, exceptions, utilities, visitors

_SERIES = 10
"""Number of ticks that averages and variances are of."""
_NEARLY = 0.98
"""Part of the period after which a snapshot is due, since ticks do not come exactly then."""


class SnapshotStream:
    """Publisher of snapshots of a tree.

    Parameters
    ----------
    node
        The node that publishes.
    topic_name
        The topic; a new one where None.
    parameters
        What to publish and when.
    """

    @dataclasses.dataclass
    class Parameters:
        """What to publish.

        Attributes
        ----------
        snapshot_period
            Time between snapshots of a tree that does not change [s].
        blackboard_data, blackboard_activity
            Whether to publish the variables of visited behaviours, and what happened on the blackboard.
        """

        snapshot_period: float = math.inf
        blackboard_data: bool = False
        blackboard_activity: bool = False

    _counter = itertools.count()

    def __init__(self, node: Node, topic_name: str | None = None, parameters: Parameters | None = None) -> None:
        self.node = node
        self.topic_name = SnapshotStream.expand_topic_name(node, topic_name)
        self.publisher = node.create_publisher(BehaviourTreeMessage, self.topic_name, utilities.qos_profile_latched())
        self.parameters = parameters or SnapshotStream.Parameters()
        self._last: Time | None = None

    @staticmethod
    def expand_topic_name(node: Node, topic_name: str | None) -> str:
        """Return the full name of a stream: relative names are under ``~/snapshot_streams``, None is a new name."""
        if not topic_name:
            topic_name = f"~/snapshot_streams/_snapshots_{next(SnapshotStream._counter)}"
        elif not topic_name.startswith(("~", "/")):
            topic_name = f"~/snapshot_streams/{topic_name}"
        return expand_topic_name(topic_name, node.get_name(), node.get_namespace())

    def publish(
        self,
        root: Any,
        changed: bool,
        statistics: Statistics | None,
        visited_behaviour_ids: Collection[uuid.UUID],
        visited_blackboard_client_ids: Collection[uuid.UUID],
    ) -> None:
        """Publish a snapshot if the tree has changed or one is due.

        Parameters
        ----------
        root
            The root of the tree.
        changed
            Whether the tree has changed.
        statistics
            Of the ticks.
        visited_behaviour_ids, visited_blackboard_client_ids
            Behaviours that were visited, and their blackboard clients.
        """
        now = self.node.get_clock().now()
        if self._last is not None and not changed:
            elapsed = (now - self._last).nanoseconds * 1e-9
            if elapsed < _NEARLY * self.parameters.snapshot_period:
                return
        message = BehaviourTreeMessage(changed=changed or self._last is None)
        self._last = now
        for behaviour in root.iterate():
            described = conversions.behaviour_to_msg(behaviour)
            described.is_active = behaviour.id in visited_behaviour_ids
            message.behaviours.append(described)
        if self.parameters.blackboard_data:
            message.blackboard_on_visited_path = _variables(visited_blackboard_client_ids)
        if self.parameters.blackboard_activity:
            message.blackboard_activity = conversions.activity_stream_to_msgs()
        if statistics is not None:
            message.statistics = statistics
        self.publisher.publish(message)

    def shutdown(self) -> None:
        """Stop to publish."""
        self.node.destroy_publisher(self.publisher)


def _variables(clients: Collection[uuid.UUID]) -> list[KeyValue]:
    found = []
    for key in sorted(Blackboard.keys_filtered_by_clients(client_ids=set(clients))):
        try:
            value = str(Blackboard.get(key))
        except KeyError:
            value = "-"
        found.append(KeyValue(key=key, value=value))
    return found


class BehaviourTree(py_trees.trees.BehaviourTree):  # type: ignore[misc]
    """Behaviour tree with a node.

    Its parameters ``default_snapshot_stream``, ``default_snapshot_period``, ``default_snapshot_blackboard_data`` and
    ``default_snapshot_blackboard_activity`` are about the stream ``~/snapshots``; services under
    ``~/snapshot_streams`` and ``~/blackboard_streams`` open others.

    Parameters
    ----------
    root
        The root of the tree.
    unicode_tree_debug
        Whether to print the tree after each tick.
    """

    def __init__(self, root: Any, unicode_tree_debug: bool = False) -> None:
        super().__init__(root)
        display = py_trees.visitors.DisplaySnapshotVisitor if unicode_tree_debug else py_trees.visitors.SnapshotVisitor
        self.snapshot_visitor: Any = display()
        self.visitors.append(self.snapshot_visitor)
        self.statistics: Statistics | None = None
        self._starts: collections.deque[float] = collections.deque(maxlen=_SERIES)
        self._intervals: collections.deque[float] = collections.deque(maxlen=_SERIES)
        self._durations: collections.deque[float] = collections.deque(maxlen=_SERIES)
        self.pre_tick_handlers.append(self._begin_statistics)
        self.post_tick_handlers.append(self._end_statistics)
        self.timer: Any = None
        self.tick_tock_count = 0
        self.node: Any = None
        self.snapshot_streams: dict[str, SnapshotStream] = {}

    def setup(
        self,
        node: Node | None = None,
        node_name: str = "tree",
        timeout: Any = py_trees.common.Duration.INFINITE,
        visitor: Any = None,
        **kwargs: Any,
    ) -> None:
        """Set up the behaviours, with a ``node`` among their arguments.

        Parameters
        ----------
        node
            The node; a new one of name `node_name` where None.
        node_name
            Name of a new node.
        timeout
            How long the setup of behaviours may take [s]; the parameter ``setup_timeout`` takes precedence.
        visitor
            Visitor of behaviours that were set up.
        kwargs
            Further arguments of the behaviours.

        Raises
        ------
        exceptions.TimedOutError
            When it takes too long.
        TypeError
            When `node` is not a node.
        """
        if node is not None and not isinstance(node, Node):
            raise TypeError(f"invalid node object [received: {type(node)}][expected: rclpy.node.Node]")
        self.node = node if node is not None else rclpy.create_node(node_name)
        self._default_topic = SnapshotStream.expand_topic_name(self.node, "~/snapshots")
        self.snapshot_stream_services = utilities.Services(
            self.node,
            [
                ("close", "~/snapshot_streams/close", CloseSnapshotStream, self._close_snapshot_stream),
                ("open", "~/snapshot_streams/open", OpenSnapshotStream, self._open_snapshot_stream),
                (
                    "reconfigure",
                    "~/snapshot_streams/reconfigure",
                    ReconfigureSnapshotStream,
                    self._reconfigure_snapshot_stream,
                ),
            ],
            introspection_topic_name="snapshot_streams/services",
        )
        self.blackboard_exchange = blackboard.Exchange()
        self.blackboard_exchange.setup(self.node)
        self._declare_parameters(timeout)
        limit = self.node.get_parameter("setup_timeout").value
        infinite = py_trees.common.Duration.INFINITE
        try:
            super().setup(
                timeout=infinite if limit >= infinite.value else limit,
                visitor=visitor or visitors.SetupLogger(self.node),
                node=self.node,
                **kwargs,
            )
        except RuntimeError as error:
            if "timed out" in str(error):
                raise exceptions.TimedOutError(str(error)) from error
            raise
        self.tree_update_handler = self._publish_update
        self.post_tick_handlers.append(self._publish_snapshots)

    def _declare_parameters(self, timeout: Any) -> None:
        infinite = py_trees.common.Duration.INFINITE
        positive = [FloatingPointRange(from_value=0.0, to_value=infinite.value)]
        default = "the stream ~/snapshots"
        for name, value, description, limits in (
            ("default_snapshot_period", 2.0, f"time between snapshots in {default} without changes [s]", positive),
            ("default_snapshot_blackboard_data", True, f"variables of visited behaviours in {default}", []),
            ("default_snapshot_blackboard_activity", False, f"activity on the blackboard in {default}", []),
            ("default_snapshot_stream", False, f"whether to publish {default}", []),
            (
                "setup_timeout",
                infinite.value if timeout == infinite else float(timeout),
                "limit of setup [s]",
                positive,
            ),
        ):
            if not self.node.has_parameter(name):
                descriptor = ParameterDescriptor(
                    description=description, floating_point_range=limits, read_only=name == "setup_timeout"
                )
                self.node.declare_parameter(name, value, descriptor)
        self._configure_default_stream({})
        self.node.add_on_set_parameters_callback(self._on_parameters)

    def _on_parameters(self, parameters: Any) -> SetParametersResult:
        self._configure_default_stream({parameter.name: parameter.value for parameter in parameters})
        return SetParametersResult(successful=True)

    def _configure_default_stream(self, changed: dict[str, Any]) -> None:
        def value(name: str) -> Any:
            full = f"default_snapshot_{name}"
            return changed[full] if full in changed else self.node.get_parameter(full).value

        if value("stream"):
            wanted = SnapshotStream.Parameters(value("period"), value("blackboard_data"), value("blackboard_activity"))
            self._open_stream(self._default_topic, wanted)
        else:
            self._close_stream(self._default_topic)

    def _open_stream(self, topic: str | None, parameters: SnapshotStream.Parameters) -> SnapshotStream:
        """Return a stream with these parameters, which is made if it does not exist."""
        stream = self.snapshot_streams.get(topic or "")
        if stream is None:
            stream = SnapshotStream(self.node, topic, SnapshotStream.Parameters())
            self.snapshot_streams[stream.topic_name] = stream
        if parameters.blackboard_activity and not stream.parameters.blackboard_activity:
            self.blackboard_exchange.register_activity_stream_client()
        elif stream.parameters.blackboard_activity and not parameters.blackboard_activity:
            self.blackboard_exchange.unregister_activity_stream_client()
        stream.parameters = parameters
        return stream

    def _close_stream(self, topic: str) -> bool:
        stream = self.snapshot_streams.pop(topic, None)
        if stream is None:
            return False
        if stream.parameters.blackboard_activity:
            self.blackboard_exchange.unregister_activity_stream_client()
        stream.shutdown()
        return True

    def tick_tock(
        self,
        period_ms: float,
        number_of_iterations: int = py_trees.trees.CONTINUOUS_TICK_TOCK,
        pre_tick_handler: Callable[[Any], None] | None = None,
        post_tick_handler: Callable[[Any], None] | None = None,
    ) -> None:
        """Tick by a timer of the node.

        Parameters
        ----------
        period_ms
            Time between ticks [ms].
        number_of_iterations
            Number of ticks; without limit by default.
        pre_tick_handler, post_tick_handler
            Called with the tree before and after each tick.
        """

        def tick() -> None:
            if number_of_iterations in (py_trees.trees.CONTINUOUS_TICK_TOCK,) or (
                self.tick_tock_count < number_of_iterations
            ):
                self.tick(pre_tick_handler, post_tick_handler)
                self.tick_tock_count += 1
            else:
                self.timer.cancel()

        self.tick_tock_count = 0
        self.timer = self.node.create_timer(period_ms / 1000.0, tick)

    def shutdown(self) -> None:
        """Interrupt and shut down the behaviours, and destroy the node."""
        if self.timer is not None:
            self.timer.cancel()
            self.node.destroy_timer(self.timer)
            self.timer = None
        super().shutdown()
        if self.node is not None:
            self.node.destroy_node()

    def _begin_statistics(self, tree: Any) -> None:
        now = self._now()
        start = conversions.rclpy_time_to_float(now)
        self._intervals.append(start - self._starts[-1] if self._starts else 0.0)
        self._starts.append(start)
        self.statistics = Statistics(count=self.count, stamp=now.to_msg())
        _fill(self.statistics, "tick_interval", self._intervals)

    def _end_statistics(self, tree: Any) -> None:
        assert self.statistics is not None
        self._durations.append(conversions.rclpy_time_to_float(self._now()) - self._starts[-1])
        _fill(self.statistics, "tick_duration", self._durations)

    def _now(self) -> Time:
        return self.node.get_clock().now() if self.node is not None else Time()

    def _publish_update(self) -> None:
        """Publish a snapshot after behaviours were added or removed."""
        if self.statistics is not None:
            self.statistics.stamp = self._now().to_msg()
            self._publish(True)

    def _publish_snapshots(self, tree: Any) -> None:
        self._publish(self.snapshot_visitor.changed)
        self.blackboard_exchange.post_tick_handler(self.snapshot_visitor.visited_blackboard_client_ids)

    def _publish(self, changed: bool) -> None:
        for stream in list(self.snapshot_streams.values()):
            stream.publish(
                self.root,
                changed,
                self.statistics,
                self.snapshot_visitor.visited.keys(),
                self.snapshot_visitor.visited_blackboard_client_ids,
            )

    def _open_snapshot_stream(self, request: Any, response: Any) -> Any:
        topic = SnapshotStream.expand_topic_name(self.node, request.topic_name)
        response.topic_name = self._open_stream(topic, _parameters(request.parameters)).topic_name
        return response

    def _close_snapshot_stream(self, request: Any, response: Any) -> Any:
        response.result = self._close_stream(request.topic_name)
        return response

    def _reconfigure_snapshot_stream(self, request: Any, response: Any) -> Any:
        response.result = request.topic_name in self.snapshot_streams
        if response.result:
            self._open_stream(request.topic_name, _parameters(request.parameters))
        return response


def _parameters(message: SnapshotStreamParameters) -> SnapshotStream.Parameters:
    return SnapshotStream.Parameters(message.snapshot_period, message.blackboard_data, message.blackboard_activity)


def _fill(message: Statistics, name: str, series: collections.deque[float]) -> None:
    """Set a quantity's last value, average and variance."""
    setattr(message, name, series[-1])
    setattr(message, f"{name}_average", sum(series) / len(series))
    setattr(message, f"{name}_variance", statistics.variance(series) if len(series) > 1 else 0.0)


class WatcherMode(enum.Enum):
    """What a watcher does."""

    SNAPSHOT = "SNAPSHOT"
    """It prints one snapshot."""
    STREAM = "STREAM"
    """It prints each snapshot."""


class Watcher:
    """Viewer of a tree's snapshots, as text.

    Parameters
    ----------
    topic_name
        Topic of snapshots; None: a stream is opened.
    namespace_hint
        Text in the name of the tree's services, to choose among several trees.
    parameters
        Of the opened stream.
    mode
        What to do.
    statistics
        Whether to print statistics, too.
    """

    def __init__(
        self,
        topic_name: str | None = None,
        namespace_hint: str | None = None,
        parameters: SnapshotStream.Parameters | None = None,
        mode: WatcherMode = WatcherMode.STREAM,
        statistics: bool = False,
    ) -> None:
        self.topic_name = topic_name
        self.namespace_hint = namespace_hint
        self.parameters = parameters or SnapshotStream.Parameters(blackboard_data=True)
        self.mode = mode
        self.display_statistics = statistics
        self.node: Any = None
        self.done = False
        self._opened: str | None = None

    def setup(self, timeout_sec: float) -> None:
        """Create the node, open a stream and subscribe to it.

        Raises
        ------
        exceptions.NotFoundError, exceptions.MultipleFoundError
            When there is no tree, or more than one.
        exceptions.TimedOutError
            When the tree does not answer.
        """
        self.node = rclpy.create_node(utilities.create_anonymous_node_name("tree_watcher"))
        topic = self.topic_name or self._open(timeout_sec)
        self.subscription = self.node.create_subscription(
            BehaviourTreeMessage, topic, self.callback_snapshot, utilities.qos_profile_latched()
        )

    def _open(self, timeout_sec: float) -> str:
        kind = "py_trees_ros_interfaces/srv/OpenSnapshotStream"
        name = utilities.find_service(self.node, kind, self.namespace_hint, timeout_sec)
        request = OpenSnapshotStream.Request()
        request.parameters.snapshot_period = self.parameters.snapshot_period
        request.parameters.blackboard_data = self.parameters.blackboard_data
        request.parameters.blackboard_activity = self.parameters.blackboard_activity
        self._opened = self._call(OpenSnapshotStream, name, request, timeout_sec).topic_name
        self._close_name = name.removesuffix("open") + "close"
        return self._opened

    def _call(self, kind: Any, name: str, request: Any, timeout_sec: float) -> Any:
        client = self.node.create_client(kind, name)
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=timeout_sec)
        if future.result() is None:
            raise exceptions.TimedOutError(f"no response from service '{name}'")
        return future.result()

    def shutdown(self) -> None:
        """Close the stream and destroy the node."""
        if self._opened is not None and self.node.context.ok():
            request = CloseSnapshotStream.Request(topic_name=self._opened)
            try:
                self._call(CloseSnapshotStream, self._close_name, request, 1.0)
            except exceptions.TimedOutError:
                self.node.get_logger().debug("the tree is gone")
        self.node.destroy_node()

    def callback_snapshot(self, msg: BehaviourTreeMessage) -> None:
        """Print a snapshot."""
        print(self.text(msg), flush=True)  # noqa: T201
        self.done = self.mode == WatcherMode.SNAPSHOT

    def text(self, msg: BehaviourTreeMessage) -> str:
        """Return a snapshot as text."""
        root, visited = tree_of(msg)
        parts = ["" if root is None else py_trees.display.unicode_tree(root, show_status=True, visited=visited)]
        if self.parameters.blackboard_data:
            parts += ["Blackboard Data", *(f"    {one.key}: {one.value}" for one in msg.blackboard_on_visited_path)]
        if self.parameters.blackboard_activity:
            parts += [
                "Blackboard Activity",
                *(f"    {one.key}: {one.activity_type} by {one.client_name}" for one in msg.blackboard_activity),
            ]
        if self.display_statistics:
            numbers = msg.statistics
            parts += [
                "Statistics",
                f"    Count: {numbers.count}",
                f"    Duration: {numbers.tick_duration * 1e3:.3f} (ms)",
                f"    Interval: {numbers.tick_interval:.3f} (s)",
            ]
        return "\n".join(parts)


def tree_of(msg: BehaviourTreeMessage) -> tuple[Any, dict[uuid.UUID, Any]]:
    """Return the root of the tree of a snapshot, for display, and the states of its visited behaviours."""
    described = {conversions.msg_to_uuid4(one.own_id): one for one in msg.behaviours}

    def build(one: Any) -> Any:
        behaviour = conversions.msg_to_behaviour(one)
        children = [build(described[key]) for key in map(conversions.msg_to_uuid4, one.child_ids) if key in described]
        if isinstance(behaviour, py_trees.decorators.Decorator) and children:
            behaviour.children = children
            behaviour.decorated = children[0]
        else:
            behaviour.children = children
        for child in children:
            child.parent = behaviour
        current = conversions.msg_to_uuid4(one.current_child_id)
        behaviour.current_child = next((child for child in children if child.id == current), None)
        return behaviour

    visited = {
        key: conversions.msg_constant_to_status_enum(one.status) for key, one in described.items() if one.is_active
    }
    roots = [one for one in msg.behaviours if conversions.msg_to_uuid4(one.parent_id) not in described]
    return (build(roots[0]) if roots else None), visited
