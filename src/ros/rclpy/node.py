"""Nodes."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, Self

from rclpy.callback_groups import CallbackGroup as CallbackGroup
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ROSClock
from rclpy.constants import S_TO_NS
from rclpy.context import Context
from rclpy.exceptions import NotInitializedException
from rclpy.impl.entities import NodeHandle
from rclpy.impl.errors import InvalidHandle
from rclpy.impl.errors import NodeNameNonExistentError as NodeNameNonExistentError
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.node_entities import NodeEntities, depth_or_profile
from rclpy.impl.node_graph import NodeGraph
from rclpy.impl.node_members import KINDS, attach, detach
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.impl.rosout import rosout
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from rclpy.parameter_service import ParameterService
from rclpy.publisher import Publisher
from rclpy.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from rclpy.time_source import TimeSource
from rclpy.type_description_service import TypeDescriptionService
from rclpy.type_support import check_for_type_support
from rclpy.utilities import get_default_context
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.impl.arguments import GivenParameter

HIDDEN_NODE_PREFIX = "_"
__all__ = [
    "HIDDEN_NODE_PREFIX",
    "PARAMETER_SEPARATOR_STRING",
    "S_TO_NS",
    "Node",
    "check_for_type_support",
    "qos_profile_services_default",
]


class Node(NodeEntities, NodeGraph):
    """A participant of the ROS graph: it publishes, subscribes, serves and calls.

    Parameters
    ----------
    node_name
        Its name.
    context
        The default context where None.
    cli_args
        Arguments for this node alone, as on the command line; they outweigh those of the process.
    namespace
        Put before its relative names.
    use_global_arguments
        Whether the process's arguments apply to it.
    enable_rosout
        Whether what it logs is published (or the QoS profile to do so with).
    start_parameter_services
        Whether others may get and set its parameters.
    parameter_overrides
        Initial values of parameters, instead of the declared ones.
    allow_undeclared_parameters
        Whether parameters may be set that were not declared.
    automatically_declare_parameters_from_overrides
        Whether overrides are declared by themselves.
    enable_logger_service
        Whether others may get and set the levels of its loggers.

    Raises
    ------
    NotInitializedException
        Before `rclpy.init`.
    InvalidNodeNameException, InvalidNamespaceException
        When a name breaks the rules.
    """

    _rcl_clock_class: type[ROSClock] = ROSClock

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool | QoSProfile = True,
        rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter[Any]] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self.__handle: NodeHandle | None = None
        self._context = context or get_default_context()
        if self._context.handle is None or not self._context.ok():
            raise NotInitializedException("cannot create node")
        validate_node_name(node_name)
        absolute = namespace or ""
        validate_namespace(absolute if absolute.startswith("/") else f"/{absolute}")
        self.__executor_weakref: weakref.ref[Executor] | None = None
        self._rcl_members: dict[str, list[Any]] = {kind: [] for kind in KINDS}
        self._default_callback_group = MutuallyExclusiveCallbackGroup()
        self.__handle = NodeHandle(self._context.handle, node_name, absolute, cli_args, use_global_arguments)
        self._logger = RcutilsLogger(self.__handle.logger_name(), owner=self)
        rosout_qos = depth_or_profile(rosout_qos_profile)
        self._rcl_rosout = rosout(self.__handle, enable_rosout, rosout_qos)
        self._rcl_init_parameters(self._rcl_overrides(parameter_overrides), allow_undeclared_parameters)
        self._parameter_event_publisher: Publisher | None = None
        self._rcl_create_parameter_event_publisher()
        self._clock = self._rcl_clock_class()
        if automatically_declare_parameters_from_overrides:
            overrides = [(name, one.value) for name, one in self._parameter_overrides.items()]
            self.declare_parameters("", overrides, ignore_override=True)
        self._time_source = TimeSource(node=self)
        self._time_source.attach_clock(self._clock)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)
        self._type_description_service = TypeDescriptionService(self)
        if enable_logger_service:
            from rclpy.logging_service import LoggingService

            self._logger_service = LoggingService(self)

    def _rcl_overrides(self, given: list[Parameter[Any]] | None) -> dict[str, Parameter[Any]]:
        """Return initial values: from files and the command line, the last outweighing, and in the end from code."""
        self._rcl_given: dict[str, GivenParameter] = {}
        entries = self.handle.parameter_overrides
        if entries:
            from rclpy.impl.parameter_file import node_matches

            full = self.handle.get_fully_qualified_name()
            self._rcl_given = {entry.name: entry for entry in entries if node_matches(entry.node, full)}
        for parameter in given or ():
            self._rcl_given.pop(parameter.name, None)
        found: dict[str, Parameter[Any]] = {
            name: Parameter(name, value=entry.value) for name, entry in self._rcl_given.items()
        }
        found.update({parameter.name: parameter for parameter in given or ()})
        return found

    def _rcl_create_parameter_event_publisher(self) -> None:
        from rcl_interfaces.msg import ParameterEvent

        self._parameter_event_publisher = self.create_publisher(
            ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )

    def _rcl_publish_parameter_event(
        self, new: list[Parameter[Any]], changed: list[Parameter[Any]], deleted: list[Parameter[Any]]
    ) -> None:
        publisher = self._parameter_event_publisher
        if publisher is None or not (new or changed or deleted) or not publisher.handle.has_subscribers:
            return
        from rcl_interfaces.msg import ParameterEvent

        publisher.publish(
            ParameterEvent(
                stamp=self._clock.now().to_msg(),
                node=self.get_fully_qualified_name(),
                new_parameters=[one.to_parameter_msg() for one in new],
                changed_parameters=[one.to_parameter_msg() for one in changed],
                deleted_parameters=[one.to_parameter_msg() for one in deleted],
            )
        )

    # What the node is.

    @property
    def handle(self) -> NodeHandle:
        """What is behind the node."""
        if self.__handle is None:
            raise InvalidHandle("the node was not created")
        return self.__handle

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    if not TYPE_CHECKING:  # for a type checker, a class with this method has every attribute

        def __getattr__(self, name: str) -> Any:
            """Raise an AttributeError that names a forgotten ``super().__init__``."""
            kind = type(self).__name__
            text = f"'{kind}' object has no attribute '{name}'"
            if "_default_callback_group" not in self.__dict__:
                text = f"'{kind}' is not a node yet: its __init__ has to call super().__init__('its_name') first"
            raise AttributeError(text, name=name, obj=self)

    def get_name(self) -> str:
        """Return the node's name."""
        with self.handle as handle:
            return handle.get_node_name()

    def get_namespace(self) -> str:
        """Return the node's namespace."""
        with self.handle as handle:
            return handle.get_namespace()

    def get_fully_qualified_name(self) -> str:
        """Return the node's name with its namespace."""
        with self.handle as handle:
            return handle.get_fully_qualified_name()

    def get_clock(self) -> Clock:
        """Return the node's clock, which follows ``/clock`` when the parameter ``use_sim_time`` is true."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger."""
        return self._logger

    # The executor.

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks."""
        return self.__executor_weakref() if self.__executor_weakref is not None else None

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.executor
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        self.__executor_weakref = None
        if new_executor is not None and new_executor.add_node(self):
            self.__executor_weakref = weakref.ref(new_executor)

    def _rcl_attach_executor(self, executor: Executor) -> None:
        """Attach all entities of the node to an executor."""
        current = self.executor
        if current is not None and current is not executor:
            current.remove_node(self)
        self.__executor_weakref = weakref.ref(executor)
        for members in self._rcl_members.values():
            for entity in list(members):
                attach(entity, executor)

    def _rcl_detach_executor(self, executor: Executor) -> None:
        if self.executor is executor:
            self.__executor_weakref = None
        for members in self._rcl_members.values():
            for entity in list(members):
                detach(entity)

    def _wake_executor(self) -> None:
        executor = self.executor
        if executor is not None:
            executor.wake()

    def destroy_node(self) -> None:
        """Destroy the node with everything that it created. Does nothing the second time."""
        if self.handle.is_destroyed:
            return
        self._time_source.detach_node()
        executor = self.executor
        if executor is not None:
            executor._forget(self)
        self._parameter_event_publisher = None
        for rate in list(self._rcl_members["rate"]):
            self.destroy_rate(rate)
        for kind in KINDS:
            members, self._rcl_members[kind] = self._rcl_members[kind], []
            for entity in members:
                if hasattr(entity, "destroy"):
                    entity.destroy()
        if self._rcl_rosout is not None:
            self._rcl_rosout.destroy()
        self.handle.destroy_when_not_in_use()
        self._wake_executor()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        if not self.handle.is_destroyed:
            self.destroy_node()


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "rcl_interfaces.msg": (
                "FloatingPointRange",
                "IntegerRange",
                "ListParametersResult",
                "ParameterDescriptor",
                "ParameterEvent",
                "ParameterType",
                "ParameterValue",
                "SetParametersResult",
            ),
            "rclpy.callback_groups": ("ReentrantCallbackGroup",),
            "rclpy.client": ("Client",),
            "rclpy.event_handler": ("PublisherEventCallbacks", "SubscriptionEventCallbacks"),
            "rclpy.exceptions": (
                "InvalidParameterTypeException",
                "InvalidParameterValueException",
                "InvalidTopicNameException",
                "ParameterAlreadyDeclaredException",
                "ParameterImmutableException",
                "ParameterNotDeclaredException",
                "ParameterUninitializedException",
            ),
            "rclpy.executors": ("Executor",),
            "rclpy.expand_topic_name": ("expand_topic_name",),
            "rclpy.guard_condition": ("GuardCondition",),
            "rclpy.impl.type_variables": ("MsgType", "SrvType", "SrvTypeRequest", "SrvTypeResponse"),
            "rclpy.logging": ("get_logger",),
            "rclpy.qos_overriding_options": ("QoSOverridingOptions",),
            "rclpy.service": ("Service",),
            "rclpy.subscription": ("MessageInfo", "Subscription"),
            "rclpy.timer": ("Rate", "Timer"),
            "rclpy.topic_endpoint_info": ("TopicEndpointInfo",),
            "rclpy.validate_full_topic_name": ("validate_full_topic_name",),
            "rclpy.validate_parameter_name": ("validate_parameter_name",),
            "rclpy.validate_topic_name": ("validate_topic_name",),
            "rclpy.waitable": ("Waitable",),
        },
    )
