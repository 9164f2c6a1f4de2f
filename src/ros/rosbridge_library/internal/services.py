"""Calls of services for clients."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.client import Client
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.task import Future

from rosbridge_library.internal.message_conversion import extract_values, populate_instance
from rosbridge_library.internal.ros_loader import get_service_class
from rosbridge_library.internal.waiting import named_values, when

SERVER_TIMEOUT_S = 1.0
"""Time in which a service that the graph shows must be reached."""
_clients: WeakKeyDictionary[Node, dict[tuple[str, str], Client]] = WeakKeyDictionary()
_clients_lock = threading.Lock()


class InvalidServiceException(Exception):
    """Error of a service that does not exist."""

    def __init__(self, service_name: str) -> None:
        super().__init__(f"Service {service_name} does not exist")


class ServiceCaller:
    """Call of a service.

    Parameters
    ----------
    service
        Name of the service.
    args
        Values of the request: by field, or a list in the order of the fields.
    success_callback, error_callback
        Called with the response as values for JSON, and with the error.
    node_handle
        Node that calls; it must be spun.
    server_timeout_s
        Time in which the service must be reached.
    """

    def __init__(
        self,
        service: str,
        args: Any,
        success_callback: Callable[[dict[str, Any]], Any],
        error_callback: Callable[[Exception], Any],
        node_handle: Node,
        server_timeout_s: float = SERVER_TIMEOUT_S,
    ) -> None:
        self.service = service
        self.args = args
        self.success = success_callback
        self.error = error_callback
        self.node_handle = node_handle
        self._server_timeout_s = server_timeout_s
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._future: Future | None = None

    def start(self) -> None:
        """Send the request; returns at once."""
        try:
            service, client, request = self._prepare()
        except Exception as error:
            self._end(self.error, error)
            return

        def send() -> None:
            try:
                future = self._future = client.call_async(request)
            except Exception as error:
                self._end(self.error, error)
            else:
                future.on_wake(lambda: self._receive(future))

        when(
            client.service_is_ready,
            self._server_timeout_s,
            send,
            lambda: self._end(self.error, InvalidServiceException(service)),
        )

    def run(self) -> None:
        """Call the service and wait for its response."""
        self.start()
        self.join()

    def join(self) -> None:
        """Wait for the response of a call that was started."""
        self._ended.wait()

    def give_up(self, error: Exception) -> None:
        """End the call with an error, unless it has ended."""
        if self._future is not None:
            self._future.cancel()
        self._end(self.error, error)

    def _prepare(self) -> tuple[str, Client, Any]:
        node = self.node_handle
        service = expand_topic_name(self.service, node.get_name(), node.get_namespace())
        types = dict(node.get_service_names_and_types()).get(service)
        if not types:
            raise InvalidServiceException(service)
        if len(types) > 1:
            node.get_logger().warning(f"More than one service type detected: {types}")
        kind = get_service_class(types[0])
        request = kind.Request()
        args_to_service_request_instance(service, request, self.args)
        return service, _client_of(node, service, types[0], kind), request

    def _receive(self, future: Future) -> None:
        if future.cancelled():
            return
        try:
            values = extract_values(future.result())
        except Exception as error:
            self._end(self.error, error)
        else:
            self._end(self.success, values)

    def _end(self, tell: Callable[[Any], Any], result: Any) -> None:
        with self._lock:
            if self._ended.is_set():
                return
            self._ended.set()
        tell(result)


def args_to_service_request_instance(service: str, inst: Any, args: Any) -> None:
    """Set fields of a request from values by field, or in the order of the fields."""
    populate_instance(named_values(inst.get_fields_and_field_types(), args), inst)


def call_service(
    node_handle: Node,
    service: str,
    args: Any = None,
    server_timeout_time: float = SERVER_TIMEOUT_S,
    sleep_time: float = 0.001,
) -> dict[str, Any]:
    """Call a service, wait for it, and return its response as values for JSON.

    Parameters
    ----------
    node_handle
        Node that calls; another thread must spin it.
    service, args
        See `ServiceCaller`.
    server_timeout_time
        Time in which the service must be reached, in seconds.
    sleep_time
        Without effect: the response is not polled for.

    Raises
    ------
    InvalidServiceException
        When there is no such service.
    """
    ended: list[Any] = []
    ServiceCaller(service, args, ended.append, ended.append, node_handle, server_timeout_time).run()
    if isinstance(ended[0], Exception):
        raise ended[0]
    values: dict[str, Any] = ended[0]
    return values


def _client_of(node: Node, service: str, type_name: str, kind: Any) -> Client:
    """Return a node's client of a service, which calls share: a new one for each would flood the graph."""
    with _clients_lock:
        clients = _clients.setdefault(node, {})
        client = clients.get((service, type_name))
        if client is None:
            client = node.create_client(kind, service, callback_group=ReentrantCallbackGroup())
            clients[service, type_name] = client
        return client
