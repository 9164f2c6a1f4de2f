"""Callbacks for changes of any node's parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterEvent

    from rclpy.node import Node
    from rclpy.qos_overriding_options import QoSOverridingOptions


class ParameterCallbackHandle:
    """A callback for one parameter of one node."""

    def __init__(self, parameter_name: str, node_name: str, callback: Callable[[Any], None]) -> None:
        self.parameter_name = parameter_name
        self.node_name = node_name
        self.callback = callback


class ParameterEventCallbackHandle:
    """A callback for every event."""

    def __init__(self, callback: Callable[[ParameterEvent], None]) -> None:
        self.callback = callback


class ParameterEventHandler:
    """Handler that follows ``/parameter_events``; of several callbacks, the one added last is called first.

    Parameters
    ----------
    node
        Whose executor calls the callbacks.
    qos_profile, callback_group, event_callbacks, qos_overriding_options, raw
        Of the subscription; see `Node.create_subscription`.
    """

    class Callbacks:
        """The callbacks that were added."""

        def __init__(self) -> None:
            self.parameter_callbacks: dict[tuple[str, str], list[ParameterCallbackHandle]] = {}
            self.event_callbacks: list[ParameterEventCallbackHandle] = []

        def event_callback(self, event: ParameterEvent) -> None:
            """Call what is meant by an event."""
            for (parameter_name, node_name), handles in list(self.parameter_callbacks.items()):
                parameter = ParameterEventHandler.get_parameter_from_event(event, parameter_name, node_name)
                if parameter is not None:
                    for handle in list(handles):
                        handle.callback(parameter)
            for event_handle in list(self.event_callbacks):
                event_handle.callback(event)

        def add_parameter_callback(
            self, parameter_name: str, node_name: str, callback: Callable[[Any], None]
        ) -> ParameterCallbackHandle:
            """Call a function when a parameter changes."""
            handle = ParameterCallbackHandle(parameter_name, node_name, callback)
            self.parameter_callbacks.setdefault((parameter_name, node_name), []).insert(0, handle)
            return handle

        def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
            """Remove a callback; raise RuntimeError when it was not added."""
            key = (handle.parameter_name, handle.node_name)
            handles = self.parameter_callbacks.get(key, [])
            if handle not in handles:
                raise RuntimeError("Callback doesn't exist")
            handles.remove(handle)
            if not handles:
                del self.parameter_callbacks[key]

        def add_parameter_event_callback(
            self, callback: Callable[[ParameterEvent], None]
        ) -> ParameterEventCallbackHandle:
            """Call a function with every event."""
            handle = ParameterEventCallbackHandle(callback)
            self.event_callbacks.insert(0, handle)
            return handle

        def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
            """Remove a callback; raise RuntimeError when it was not added."""
            if handle not in self.event_callbacks:
                raise RuntimeError("Callback doesn't exist")
            self.event_callbacks.remove(handle)

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> None:
        from rcl_interfaces.msg import ParameterEvent

        self.node = node
        self.qos_profile = qos_profile
        self._callbacks = ParameterEventHandler.Callbacks()
        self.parameter_event_subscription = node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            self._callbacks.event_callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )

    def destroy(self) -> None:
        """Stop following parameter events."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(event: ParameterEvent, parameter_name: str, node_name: str) -> Any:
        """Return the ``rcl_interfaces/msg/Parameter`` of that name and node in an event, or None."""
        if event.node != node_name:
            return None
        parameters = ParameterEventHandler.get_parameters_from_event(event)
        return next((one for one in parameters if one.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: ParameterEvent) -> Iterable[Any]:
        """Return every ``rcl_interfaces/msg/Parameter`` that is new or changed by an event."""
        yield from (*event.new_parameters, *event.changed_parameters)

    def configure_nodes_filter(self, node_names: list[str] | None = None) -> bool:
        """Receive events of these nodes only, of all where None; return whether that is so now."""
        names = [self._resolve_path(name) for name in node_names or ()]
        expression = " OR ".join(f"node = %{number}" for number in range(len(names)))
        self.parameter_event_subscription.set_content_filter(expression, [f"'{name}'" for name in names])
        return self.parameter_event_subscription.is_cft_enabled is bool(names)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], None]
    ) -> ParameterCallbackHandle:
        """Call ``callback(parameter)`` when a parameter changes; a relative node name is one in our namespace."""
        return self._callbacks.add_parameter_callback(parameter_name, self._resolve_path(node_name), callback)

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove a callback that `add_parameter_callback` added; raise RuntimeError when it was not."""
        self._callbacks.remove_parameter_callback(handle)

    def add_parameter_event_callback(self, callback: Callable[[ParameterEvent], None]) -> ParameterEventCallbackHandle:
        """Call ``callback(event)`` with every event."""
        return self._callbacks.add_parameter_event_callback(callback)

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove a callback that `add_parameter_event_callback` added; raise RuntimeError when it was not."""
        self._callbacks.remove_parameter_event_callback(handle)

    def _resolve_path(self, node_path: str | None = None) -> str:
        """Return a node's full name; our own where None."""
        if not node_path:
            return self.node.get_fully_qualified_name()
        if node_path.startswith("/"):
            return node_path
        return f"{self.node.get_namespace().rstrip('/')}/{node_path}"
