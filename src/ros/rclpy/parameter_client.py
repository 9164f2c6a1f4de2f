"""Getting and setting the parameters of another node."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file
from rclpy.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from rclpy.subscription import Subscription
from rclpy.task import Future

if TYPE_CHECKING:
    from rclpy.qos_overriding_options import QoSOverridingOptions

Callback = Callable[[Future], None]


class AsyncParameterClient:
    """Client of the parameter services of a node; every call returns a future whose result is the response.

    Parameters
    ----------
    node
        The node to call with.
    remote_node_name
        Whose parameters.
    qos_profile
        Of the services.
    callback_group
        The node's default where None.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        from rcl_interfaces.srv import (
            DescribeParameters,
            GetParameters,
            GetParameterTypes,
            ListParameters,
            SetParameters,
            SetParametersAtomically,
        )

        self.remote_node_name = remote_node_name
        self.node = node
        self._clients = {
            name: node.create_client(
                kind, f"{remote_node_name}/{name}", qos_profile=qos_profile, callback_group=callback_group
            )
            for name, kind in (
                ("get_parameters", GetParameters),
                ("set_parameters", SetParameters),
                ("list_parameters", ListParameters),
                ("describe_parameters", DescribeParameters),
                ("get_parameter_types", GetParameterTypes),
                ("set_parameters_atomically", SetParametersAtomically),
            )
        }

    def services_are_ready(self) -> bool:
        """Return whether every service is there."""
        return all(client.service_is_ready() for client in self._clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait until every service is there; False when `timeout_sec` seconds pass first."""
        deadline = None if timeout_sec is None else time.monotonic() + timeout_sec
        for client in self._clients.values():
            left = None if deadline is None else max(deadline - time.monotonic(), 0.0)
            if not client.wait_for_service(left):
                return False
        return True

    def _call(self, name: str, request: Any, callback: Callback | None) -> Future:
        future = self._clients[name].call_async(request)
        if callback is not None:
            future.add_done_callback(callback)
        return future

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Callback | None = None
    ) -> Future:
        """List parameters below prefixes (all where None), down to a depth (any where None)."""
        from rcl_interfaces.srv import ListParameters

        request = ListParameters.Request()
        if prefixes:
            request.prefixes = prefixes
        if depth:
            request.depth = depth
        return self._call("list_parameters", request, callback)

    def get_parameters(self, names: list[str], callback: Callback | None = None) -> Future:
        """Request values."""
        from rcl_interfaces.srv import GetParameters

        return self._call("get_parameters", GetParameters.Request(names=names), callback)

    def set_parameters(self, parameters: Sequence[Any], callback: Callback | None = None) -> Future:
        """Set values one by one: `Parameter` objects or ``rcl_interfaces/msg/Parameter``."""
        from rcl_interfaces.srv import SetParameters

        return self._call("set_parameters", SetParameters.Request(parameters=_messages(parameters)), callback)

    def describe_parameters(self, names: list[str], callback: Callback | None = None) -> Future:
        """Request descriptors."""
        from rcl_interfaces.srv import DescribeParameters

        return self._call("describe_parameters", DescribeParameters.Request(names=names), callback)

    def get_parameter_types(self, names: list[str], callback: Callback | None = None) -> Future:
        """Request types."""
        from rcl_interfaces.srv import GetParameterTypes

        return self._call("get_parameter_types", GetParameterTypes.Request(names=names), callback)

    def set_parameters_atomically(self, parameters: Sequence[Any], callback: Callback | None = None) -> Future:
        """Set all values or none; see `set_parameters`."""
        from rcl_interfaces.srv import SetParametersAtomically

        request = SetParametersAtomically.Request(parameters=_messages(parameters))
        return self._call("set_parameters_atomically", request, callback)

    def delete_parameters(self, names: list[str], callback: Callback | None = None) -> Future:
        """Remove parameters."""
        return self.set_parameters([Parameter(name).to_parameter_msg() for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str, use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future:
        """Set the values that a file holds for the node, or all of them when it holds none for it.

        See `rclpy.parameter.parameter_dict_from_yaml_file`.
        """
        return self.set_parameters(self._from_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future:
        """Set all values that a file holds for the node, or none."""
        return self.set_parameters_atomically(self._from_file(parameter_file, use_wildcard), callback)

    def _from_file(self, path: str, use_wildcard: bool) -> list[Any]:
        try:
            found = parameter_dict_from_yaml_file(path, use_wildcard, target_nodes=[self.remote_node_name])
        except RuntimeError:  # nothing for the node: rclpy then sets what the file says of any
            found = parameter_dict_from_yaml_file(path, use_wildcard)
        return list(found.values())

    def on_parameter_event(
        self,
        callback: Callable[[Any], None],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Call a function with every ``rcl_interfaces/msg/ParameterEvent``."""
        from rcl_interfaces.msg import ParameterEvent

        return self.node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def _messages(parameters: Sequence[Any]) -> list[Any]:
    return [one.to_parameter_msg() if isinstance(one, Parameter) else one for one in parameters]
