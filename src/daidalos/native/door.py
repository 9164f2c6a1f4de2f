"""Functions and classes that the C++ library calls (``workspaces/native/cpp/src``).

A C++ node is an `rclpy` node whose publishers, subscriptions, services and clients carry bytes: names, remapping,
discovery, type hashes, QoS, parameters, time and logging are the same code for both languages. Messages cross the
border as CDR, everything else as numbers, text and lists.
"""

from __future__ import annotations

import atexit
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import rclpy
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.clock import JumpThreshold, ROSClock
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.log_output import OUTPUT, Record
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.node_graph import checked_name
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import get_default_context, remove_ros_args
from rosidl_runtime_py.utilities import get_message, get_service

from daidalos.native.endpoints import ClientEnd, PublisherEnd, ServiceEnd, SubscriptionEnd, profile

VERSION = 1
"""Number of this interface, which the library states, too."""


class OutdatedError(Exception):
    """The library was built for another version of this module."""


def init(arguments: list[str], domain: int, version: int) -> tuple[int, int]:
    """Initialize the context; return how many bytes a wide character takes on the wire, and the domain.

    Raises
    ------
    OutdatedError
        When the library does not fit.
    RuntimeError
        For arguments that cannot be understood.
    """
    if version != VERSION:
        raise OutdatedError("this program was built with another version of Daidalos: run 'colcon build' again")
    sys.argv = arguments or [""]
    rclpy.init(
        args=arguments,
        domain_id=domain if domain >= 0 else None,
        signal_handler_options=SignalHandlerOptions.NO,
    )
    context = get_default_context()
    assert context.handle is not None
    return context.handle.session.backend.wide, context.get_domain_id()


def shutdown() -> None:
    """Leave the graph."""
    rclpy.try_shutdown()


def finish() -> None:
    """Do what the interpreter would do at its end; the interpreter itself stays, as threads may be in it."""
    rclpy.try_shutdown()
    atexit._run_exitfuncs()


def without_ros_arguments(arguments: list[str]) -> list[str]:
    """Return the arguments without those of ROS."""
    return remove_ros_args(arguments)


def log(name: str, severity: int, text: str, file: str, function: str, line: int) -> None:
    """Send a log message, already found important enough, to the console, the log file and ``/rosout``."""
    where = OUTPUT.source_file(file)
    OUTPUT.write(Record(LoggingSeverity(severity), name, text, time.time_ns(), function, where, line))


def log_level(name: str) -> int:
    """Return the level that applies to a logger."""
    return int(OUTPUT.effective_level(name))


def set_log_level(name: str, level: int) -> None:
    """Set a logger's level."""
    OUTPUT.set_level(name, LoggingSeverity(level))


class _Upkeep(SingleThreadedExecutor):
    """Executor of a node's own callbacks (parameter services), which the C++ executor runs when told to."""

    def __init__(self) -> None:
        super().__init__()
        self._tell: Callable[[], None] | None = None
        put = self._put

        def put_and_tell(item: Any) -> None:
            put(item)
            if self._tell is not None:
                self._tell()

        self._put = put_and_tell

    def tell(self, function: Callable[[], None]) -> None:
        """Call a function when there is something to run, and at once if there is."""
        self._tell = function
        function()

    def run_ready(self) -> None:
        """Run all callbacks that are ready."""
        with suppress(ExternalShutdownException):
            while self._context.ok() and not self._ready.empty():
                self.spin_once(timeout_sec=0)


class CallbackToken:
    """Registration of a parameter callback."""

    def __init__(self, remove: Callable[[], None]) -> None:
        self.remove = remove


class Node:
    """Node of a C++ program; see `rclpy.node.Node` for the arguments."""

    def __init__(
        self,
        name: str,
        namespace: str,
        arguments: list[str],
        use_global_arguments: bool,
        rosout: bool,
        parameter_services: bool,
        overrides: list[bytes],
        allow_undeclared: bool,
        declare_overrides: bool,
        logger_service: bool,
    ) -> None:
        self._node = rclpy.create_node(
            name,
            namespace=namespace,
            cli_args=arguments,
            use_global_arguments=use_global_arguments,
            enable_rosout=rosout,
            start_parameter_services=parameter_services,
            parameter_overrides=[_parameter(one) for one in overrides],
            allow_undeclared_parameters=allow_undeclared,
            automatically_declare_parameters_from_overrides=declare_overrides,
            enable_logger_service=logger_service,
        )
        self._executor = _Upkeep()
        self._executor.add_node(self._node)
        self.run_ready = self._executor.run_ready

    def names(self) -> tuple[str, str, str, str]:
        """Return the name, the namespace, both together and the logger's name."""
        node = self._node
        return node.get_name(), node.get_namespace(), node.get_fully_qualified_name(), node.handle.logger_name()

    def watch(self, on_ready: Callable[[], None], on_time: Callable[[bool, int], None]) -> None:
        """Call `on_ready` when `run_ready` has work, and ``on_time(simulated, nanoseconds)`` when time jumps."""
        self._executor.tell(on_ready)
        clock = self._node.get_clock()
        assert isinstance(clock, ROSClock)

        def report(_: object = None) -> None:
            on_time(bool(clock.ros_time_is_active), clock.now().nanoseconds)

        threshold = JumpThreshold(
            min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1), on_clock_change=True
        )
        self._jumps = clock.create_jump_callback(threshold, post_callback=report)
        report()

    def destroy(self) -> None:
        """Leave the graph."""
        self._jumps.unregister()
        self._executor.shutdown()
        self._node.destroy_node()

    # Endpoints.

    def create_publisher(self, type_name: str, topic: str, qos: list[int]) -> PublisherEnd:
        """Publish on a topic."""
        return PublisherEnd(self._node.handle, get_message(type_name), self._name(topic), profile(qos))

    def create_subscription(
        self, type_name: str, topic: str, qos: list[int], on_ready: Callable[[], None]
    ) -> SubscriptionEnd:
        """Receive a topic's messages; `on_ready` is called when some came."""
        handle = self._node.handle
        return SubscriptionEnd(handle, get_message(type_name), self._name(topic), profile(qos), on_ready)

    def create_service(self, type_name: str, name: str, qos: list[int], on_ready: Callable[[], None]) -> ServiceEnd:
        """Serve a service; `on_ready` is called when a request came."""
        full = self._name(name, is_service=True)
        return ServiceEnd(self._node.handle, get_service(type_name), full, profile(qos), on_ready)

    def create_client(self, type_name: str, name: str, qos: list[int], on_ready: Callable[[], None]) -> ClientEnd:
        """Call a service; `on_ready` is called when a response came."""
        full = self._name(name, is_service=True)
        return ClientEnd(self._node.handle, get_service(type_name), full, profile(qos), on_ready)

    def _name(self, name: str, is_service: bool = False) -> str:
        return checked_name(self._node.handle, name, is_service=is_service)

    # The graph.

    def get_node_names(self) -> list[str]:
        """Return the full names of all nodes."""
        pairs = self._node.get_node_names_and_namespaces()
        return [f"{namespace.rstrip('/')}/{name}" for name, namespace in pairs]

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return all topics with their types."""
        return self._node.get_topic_names_and_types()

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return all services with their types."""
        return self._node.get_service_names_and_types()

    def count_publishers(self, topic: str) -> int:
        """Return how many publishers a topic has."""
        return self._node.count_publishers(topic)

    def count_subscribers(self, topic: str) -> int:
        """Return how many subscriptions a topic has."""
        return self._node.count_subscribers(topic)

    # Parameters, as the bytes of rcl_interfaces' messages.

    def declare_parameter(self, parameter: bytes, descriptor: bytes, ignore_override: bool) -> bytes:
        """Declare a parameter; one without a value has the type of its descriptor."""
        given = _parameter(parameter)
        described = deserialize_message(descriptor, ParameterDescriptor)
        value: Any = given.value
        if given.type_ is Parameter.Type.NOT_SET and described.type:
            value = Parameter.Type(described.type)
        return _bytes(self._node.declare_parameter(given.name, value, described, ignore_override))

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter."""
        self._node.undeclare_parameter(name)

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter was declared."""
        return self._node.has_parameter(name)

    def get_parameter(self, name: str) -> bytes:
        """Return a parameter."""
        return _bytes(self._node.get_parameter(name))

    def get_parameter_if_set(self, name: str) -> bytes | None:
        """Return a parameter, None where it has no value or was not declared."""
        if not self._node.has_parameter(name):
            return None
        parameter = self._node.get_parameter_or(name, None)
        return None if parameter is None or parameter.type_ is Parameter.Type.NOT_SET else _bytes(parameter)

    def get_parameters_by_prefix(self, prefix: str) -> list[bytes]:
        """Return the parameters whose names begin with a prefix and a dot; all for an empty one."""
        found = self._node.get_parameters_by_prefix(prefix)
        return [_bytes(parameter) for parameter in found.values() if parameter is not None]

    def set_parameters(self, parameters: list[bytes]) -> list[bytes]:
        """Set parameters one after the other."""
        results = self._node.set_parameters([_parameter(one) for one in parameters])
        return [serialize_message(result) for result in results]

    def set_parameters_atomically(self, parameters: list[bytes]) -> bytes:
        """Set all parameters or none."""
        return serialize_message(self._node.set_parameters_atomically([_parameter(one) for one in parameters]))

    def describe_parameter(self, name: str) -> bytes:
        """Return a parameter's descriptor."""
        return serialize_message(self._node.describe_parameter(name))

    def list_parameters(self, prefixes: list[str], depth: int) -> bytes:
        """Return the names of parameters."""
        return serialize_message(self._node.list_parameters(prefixes, depth))

    def add_parameters_callback(self, kind: str, callback: Callable[[list[bytes]], bytes]) -> CallbackToken:
        """Call a function before parameters are set (``on_set``), which may refuse, or afterwards (``post_set``)."""
        if kind == "on_set":

            def ask(parameters: list[Parameter[Any]]) -> SetParametersResult:
                answer = callback([_bytes(one) for one in parameters])
                return deserialize_message(answer, SetParametersResult)  # type: ignore[no-any-return]

            self._node.add_on_set_parameters_callback(ask)
            return CallbackToken(lambda: self._node.remove_on_set_parameters_callback(ask))

        def report(parameters: list[Parameter[Any]]) -> None:
            callback([_bytes(one) for one in parameters])

        self._node.add_post_set_parameters_callback(report)
        return CallbackToken(lambda: self._node.remove_post_set_parameters_callback(report))


def _parameter(data: bytes) -> Parameter[Any]:
    return Parameter.from_parameter_msg(deserialize_message(data, ParameterMessage))


def _bytes(parameter: Parameter[Any]) -> bytes:
    return serialize_message(parameter.to_parameter_msg())
