"""Blackboard on topics: what is on it, as text, whenever it changes."""

from __future__ import annotations

import pickle
import uuid
from collections.abc import Collection
from typing import Any

from py_trees.blackboard import Blackboard
from py_trees_ros_interfaces.srv import CloseBlackboardStream, GetBlackboardVariables, OpenBlackboardStream
from rclpy.node import Node
from std_msgs.msg import String

from py_trees_ros import utilities


class SubBlackboard:
    """Some variables of the blackboard, and whether they have changed.

    Parameters
    ----------
    node
        The node that logs what cannot be compared.
    """

    def __init__(self, node: Node) -> None:
        self.node = node
        self.is_changed = False
        self.variable_names: set[str] = set()
        self._before: bytes | None = None
        self._warned = False

    def update(self, variable_names: Collection[str]) -> None:
        """Set the variables, and `is_changed`: whether their values differ from those of the last call.

        Values that cannot be compared count as changed; the first of them is logged.
        """
        self.variable_names = set(variable_names)
        values = {}
        for name in sorted(self.variable_names):
            try:
                values[name] = Blackboard.get(name)
            except KeyError:
                continue  # it is not there yet
        try:
            now: bytes | None = pickle.dumps(values, -1)
        except Exception as error:  # values may raise anything
            if not self._warned:
                self.node.get_logger().error(f"cannot tell changes of blackboard variables: {error}")
                self._warned = True
            now = None
        self.is_changed = now is None or now != self._before
        self._before = now

    def __str__(self) -> str:
        lines = []
        width = max(map(len, self.variable_names), default=0)
        for name in sorted(self.variable_names):
            try:
                value = str(Blackboard.get(name))
            except KeyError:
                value = "-"
            if "\n" in value:
                lines += [f"    {name:<{width}}:", *(f"    {line}" for line in value.splitlines())]
            else:
                lines.append(f"    {name:<{width}}: {value}")
        return "\n".join(lines)


class BlackboardView:
    """Publisher of some variables of the blackboard.

    Parameters
    ----------
    node
        The node that publishes.
    topic_name
        The topic.
    variable_names
        The variables; all where empty.
    filter_on_visited_path
        Whether to publish only those that visited behaviours can use.
    with_activity_stream
        Whether to publish what happened to them, too.
    """

    def __init__(
        self,
        node: Node,
        topic_name: str,
        variable_names: Collection[str],
        filter_on_visited_path: bool,
        with_activity_stream: bool,
    ) -> None:
        self.node = node
        self.topic_name = topic_name
        self.variable_names = set(variable_names)
        self.filter_on_visited_path = filter_on_visited_path
        self.with_activity_stream = with_activity_stream
        self.sub_blackboard = SubBlackboard(node)
        self.publisher = node.create_publisher(String, topic_name, utilities.qos_profile_latched())

    def shutdown(self) -> None:
        """Stop to publish."""
        self.node.destroy_publisher(self.publisher)

    def publish_if_changed(self, visited_clients: Collection[uuid.UUID]) -> None:
        """Publish the variables if they have changed, or something happened to them.

        Parameters
        ----------
        visited_clients
            Blackboard clients of the behaviours that were visited.
        """
        names = self.variable_names or set(Blackboard.keys())
        if self.filter_on_visited_path:
            visited = Blackboard.keys_filtered_by_clients(client_ids=set(visited_clients))
            names = {name for name in names if _absolute(name.split(".")[0]) in visited}
        self.sub_blackboard.update({_absolute(name) for name in names})
        activity = self._activity() if self.with_activity_stream else ""
        if self.sub_blackboard.is_changed or activity:
            parts = ["Blackboard Data", str(self.sub_blackboard)] + (["Activity", activity] if activity else [])
            self.publisher.publish(String(data="\n".join(parts)))

    def _activity(self) -> str:
        stream = Blackboard.activity_stream
        items = [] if stream is None else stream.data
        keys = {name.split(".")[0] for name in self.sub_blackboard.variable_names}
        return "\n".join(
            f"    {item.key} : {item.activity_type} : {item.client_name} : {item.current_value}"
            for item in items
            if item.key in keys
        )


def _absolute(name: str) -> str:
    return str(Blackboard.absolute_name("/", name))


class Exchange:
    """Services by which others have variables of the blackboard published."""

    def __init__(self) -> None:
        self.node: Node | None = None
        self.views: list[BlackboardView] = []
        self.services: dict[str, Any] = {}
        self.activity_stream_clients = 0
        self._number = 0

    def setup(self, node: Node) -> None:
        """Create the services on a node."""
        self.node = node
        for name, kind, callback in (
            ("get_variables", GetBlackboardVariables, self._get_variables),
            ("open", OpenBlackboardStream, self._open),
            ("close", CloseBlackboardStream, self._close),
        ):
            self.services[name] = node.create_service(kind, f"~/blackboard_streams/{name}", callback)

    def post_tick_handler(self, visited_client_ids: Collection[uuid.UUID] | None = None) -> None:
        """Publish what has changed.

        Parameters
        ----------
        visited_client_ids
            Blackboard clients of the behaviours that were visited.
        """
        for view in self.views:
            view.publish_if_changed(visited_client_ids or ())
        if Blackboard.activity_stream is not None:
            Blackboard.activity_stream.clear()

    def register_activity_stream_client(self) -> None:
        """Record what happens on the blackboard from now on."""
        self.activity_stream_clients += 1
        if self.activity_stream_clients == 1:
            Blackboard.enable_activity_stream()

    def unregister_activity_stream_client(self) -> None:
        """Record it no longer, unless others want it."""
        self.activity_stream_clients -= 1
        if self.activity_stream_clients == 0:
            Blackboard.disable_activity_stream()

    def _get_variables(self, request: Any, response: Any) -> Any:
        names = []
        for key in sorted(Blackboard.keys()):
            names.append(key)
            try:
                names += [f"{key}.{attribute}" for attribute in vars(Blackboard.get(key))]
            except (KeyError, TypeError):
                continue  # it has no value, or one without attributes
        response.variables = names
        return response

    def _open(self, request: Any, response: Any) -> Any:
        assert self.node is not None
        topic = utilities.resolve_name(self.node, f"~/blackboard_streams/_watcher_{self._number}")
        self._number += 1
        view = BlackboardView(
            self.node, topic, request.variables, request.filter_on_visited_path, request.with_activity_stream
        )
        self.views.append(view)
        if request.with_activity_stream:
            self.register_activity_stream_client()
        view.publish_if_changed(())
        response.topic = topic
        return response

    def _close(self, request: Any, response: Any) -> Any:
        closed = [view for view in self.views if view.topic_name == request.topic_name]
        for view in closed:
            view.shutdown()
            self.views.remove(view)
            if view.with_activity_stream:
                self.unregister_activity_stream_client()
        response.result = bool(closed)
        return response
