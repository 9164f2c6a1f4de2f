"""Nodes."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.client import Client
from rclpy.clock import Clock, ROSClock
from rclpy.constants import S_TO_NS
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import NotInitializedException
from rclpy.guard_condition import GuardCondition
from rclpy.impl.entities import ClientHandle, NodeHandle, PublisherHandle, ServiceHandle, SubscriptionHandle
from rclpy.impl.errors import InvalidHandle
from rclpy.impl.node_graph import NodeGraph, checked_name
from rclpy.impl.node_parameters import NodeParameters
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
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.time_source import TimeSource
from rclpy.timer import Rate, Timer
from rclpy.type_description_service import TypeDescriptionService
from rclpy.type_support import check_for_type_support, check_is_valid_msg_type, check_is_valid_srv_type
from rclpy.utilities import get_default_context
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name
from rclpy.waitable import Waitable

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.qos_overriding_options import QoSOverridingOptions
    from rclpy.subscription_content_filter_options import ContentFilterOptions

HIDDEN_NODE_PREFIX = "_"
__all__ = ["HIDDEN_NODE_PREFIX", "PARAMETER_SEPARATOR_STRING", "S_TO_NS", "Node", "check_for_type_support"]


class Node(NodeParameters, NodeGraph):
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

    _rcl_client_class: type[Client] = Client
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
        self._rcl_members: dict[str, list[Any]] = {kind: [] for kind in _KINDS}
        self._default_callback_group = MutuallyExclusiveCallbackGroup()
        self.__handle = NodeHandle(self._context.handle, node_name, absolute, cli_args, use_global_arguments)
        self._logger = RcutilsLogger(self.__handle.logger_name(), owner=self)
        rosout_qos = _qos(rosout_qos_profile)
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
        found: dict[str, Parameter[Any]] = {}
        entries = self.handle.parameter_overrides
        if entries:
            from rclpy.impl.parameter_file import node_matches

            full = self.handle.get_fully_qualified_name()
            for node, name, value in entries:
                if node_matches(node, full):
                    found[name] = Parameter(name, value=value)
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
        if publisher is None or not (new or changed or deleted) or not publisher.handle.impl.is_heard:
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

    @property
    def context(self) -> Context:
        """The node's context."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of entities that are given none: mutually exclusive."""
        return self._default_callback_group

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

    @property
    def publishers(self) -> Iterator[Publisher]:
        """The node's publishers."""
        yield from self._rcl_members["publisher"]

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The node's subscriptions."""
        yield from self._rcl_members["subscription"]

    @property
    def clients(self) -> Iterator[Client]:
        """The node's clients."""
        yield from self._rcl_members["client"]

    @property
    def services(self) -> Iterator[Service]:
        """The node's services."""
        yield from self._rcl_members["service"]

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's timers."""
        yield from self._rcl_members["timer"]

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The node's guard conditions."""
        yield from self._rcl_members["guard"]

    @property
    def waitables(self) -> Iterator[Waitable]:
        """The node's waitables."""
        yield from self._rcl_members["waitable"]

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
        """Direct everything that becomes ready to an executor."""
        current = self.executor
        if current is not None and current is not executor:
            current.remove_node(self)
        self.__executor_weakref = weakref.ref(executor)
        for members in self._rcl_members.values():
            for entity in list(members):
                _attach(entity, executor)

    def _rcl_detach_executor(self, executor: Executor) -> None:
        if self.executor is executor:
            self.__executor_weakref = None
        for members in self._rcl_members.values():
            for entity in list(members):
                _detach(entity)

    def _wake_executor(self) -> None:
        executor = self.executor
        if executor is not None:
            executor.wake()

    def _rcl_add(self, kind: str, entity: Any, group: CallbackGroup | None = None) -> Any:
        """Take an entity in: it belongs to the node and is run by the node's executor."""
        if group is not None:
            group.add_entity(entity)
        entity._rcl_node = weakref.ref(self)
        self._rcl_members[kind].append(entity)
        executor = self.executor
        if executor is not None:
            _attach(entity, executor)
        return entity

    def _rcl_remove(self, kind: str, entity: Any) -> bool:
        members = self._rcl_members[kind]
        if entity not in members:
            return False
        members.remove(entity)
        _detach(entity)
        return True

    # Making and destroying entities.

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Publish on a topic.

        Parameters
        ----------
        msg_type
            Class of the messages.
        topic
            Its name, relative to the node unless it begins with a slash.
        qos_profile
            Quality of service; a number means KEEP_LAST with that depth.
        callback_group
            Of the event callbacks; the node's default where None.
        event_callbacks
            What to call at events.
        qos_overriding_options
            Which policies may be overridden by parameters.
        publisher_class
            The class to make.

        Raises
        ------
        InvalidTopicNameException
            When the name breaks the rules.
        """
        profile = _qos(qos_profile)
        group = callback_group or self.default_callback_group
        check_is_valid_msg_type(msg_type)
        with self.handle as handle:
            name = checked_name(handle, topic, is_service=False)
            profile = self._rcl_overridden_qos(Publisher, name, profile, qos_overriding_options)
            publisher_handle = PublisherHandle(handle, msg_type, name, profile)
        publisher = publisher_class(
            publisher_handle, msg_type, topic, profile, event_callbacks or PublisherEventCallbacks(), group
        )
        self._rcl_members["publisher"].append(publisher)
        for handler in publisher.event_handlers:
            self.add_waitable(handler)
        return publisher

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
    ) -> Subscription:
        """Receive a topic's messages.

        Parameters
        ----------
        msg_type
            Class of the messages.
        topic
            Its name, relative to the node unless it begins with a slash.
        callback
            Called with every message, and with its `MessageInfo` when it takes two arguments.
        qos_profile
            Quality of service; a number means KEEP_LAST with that depth.
        callback_group
            The node's default where None.
        event_callbacks
            What to call at events.
        qos_overriding_options
            Which policies may be overridden by parameters.
        raw
            Whether the callback gets the serialised bytes.
        content_filter_options
            Which messages are wanted; all where None.

        Raises
        ------
        InvalidTopicNameException
            When the name breaks the rules.
        """
        profile = _qos(qos_profile)
        group = callback_group or self.default_callback_group
        check_is_valid_msg_type(msg_type)
        with self.handle as handle:
            name = checked_name(handle, topic, is_service=False)
            profile = self._rcl_overridden_qos(Subscription, name, profile, qos_overriding_options)
            subscription_handle = SubscriptionHandle(handle, msg_type, name, profile)
        try:
            subscription = Subscription(
                subscription_handle,
                msg_type,
                topic,
                callback,
                group,
                profile,
                raw,
                event_callbacks or SubscriptionEventCallbacks(),
            )
            if content_filter_options is not None:
                subscription.set_content_filter(
                    content_filter_options.filter_expression, content_filter_options.expression_parameters
                )
        except Exception:
            subscription_handle.destroy_when_not_in_use()
            raise
        for handler in subscription.event_handlers:
            self.add_waitable(handler)
        self._rcl_add("subscription", subscription, group)
        return subscription

    def _rcl_overridden_qos(
        self, kind: type[Any], name: str, profile: QoSProfile, options: QoSOverridingOptions | None
    ) -> QoSProfile:
        if options is None:
            return profile
        from rclpy.qos_overriding_options import _declare_qos_parameters

        return _declare_qos_parameters(kind, self, name, profile, options)

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Call a service.

        Raises
        ------
        InvalidServiceNameException
            When the name breaks the rules.
        """
        group = callback_group or self.default_callback_group
        check_is_valid_srv_type(srv_type)
        with self.handle as handle:
            name = checked_name(handle, srv_name, is_service=True)
            client_handle = ClientHandle(handle, srv_type, name, qos_profile)
        client = self._rcl_client_class(self.context, client_handle, srv_type, srv_name, qos_profile, group)
        self._rcl_add("client", client, group)
        return client

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Serve a service with ``callback(request, response) -> response``.

        Raises
        ------
        InvalidServiceNameException
            When the name breaks the rules.
        """
        group = callback_group or self.default_callback_group
        check_is_valid_srv_type(srv_type)
        with self.handle as handle:
            name = checked_name(handle, srv_name, is_service=True)
            service_handle = ServiceHandle(handle, srv_type, name, qos_profile)
        service = Service(service_handle, srv_type, srv_name, callback, group, qos_profile)
        self._rcl_add("service", service, group)
        return service

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Call a function every `timer_period_sec` seconds of a clock, by default the node's."""
        if timer_period_sec < 0:
            raise ValueError(f"timer period must not be negative, got {timer_period_sec}")
        group = callback_group or self.default_callback_group
        timer = Timer(
            callback,
            group,
            int(float(timer_period_sec) * S_TO_NS),
            clock or self._clock,
            context=self.context,
            autostart=autostart,
        )
        self._rcl_add("timer", timer, group)
        return timer

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Call a function whenever the result is triggered."""
        group = callback_group or self.default_callback_group
        guard = GuardCondition(callback, group, context=self.context)
        self._rcl_add("guard", guard, group)
        return guard

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Return what lets a loop run at `frequency` hertz of a clock, by default the node's.

        Raises
        ------
        ValueError
            For a frequency that is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = Timer(None, None, int(S_TO_NS / frequency), clock or self._clock, context=self.context)
        rate = Rate(timer, context=self.context)
        self._rcl_members["rate"].append(rate)
        return rate

    def add_waitable(self, waitable: Waitable) -> None:
        """Have the node's executor wait for a waitable."""
        if not hasattr(waitable, "_rcl_hook"):
            from rclpy.impl.wait_set import adapt

            adapt(waitable)
        self._rcl_add("waitable", waitable)

    def remove_waitable(self, waitable: Waitable) -> None:
        """Undo `add_waitable`."""
        self._rcl_remove("waitable", waitable)
        self._wake_executor()

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Destroy a publisher; False when it is none of the node's."""
        if publisher not in self._rcl_members["publisher"]:
            return False
        self._rcl_members["publisher"].remove(publisher)
        for handler in publisher.event_handlers:
            self._rcl_remove("waitable", handler)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Destroy a subscription; False when it is none of the node's."""
        if not self._rcl_remove("subscription", subscription):
            return False
        for handler in subscription.event_handlers:
            self._rcl_remove("waitable", handler)
        subscription.destroy()
        return True

    def destroy_client(self, client: Client) -> bool:
        """Destroy a client; False when it is none of the node's."""
        return self._rcl_destroy_member("client", client)

    def destroy_service(self, service: Service) -> bool:
        """Destroy a service; False when it is none of the node's."""
        return self._rcl_destroy_member("service", service)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer; False when it is none of the node's."""
        return self._rcl_destroy_member("timer", timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition; False when it is none of the node's."""
        return self._rcl_destroy_member("guard", guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate; False when it is none of the node's."""
        if rate not in self._rcl_members["rate"]:
            return False
        self._rcl_members["rate"].remove(rate)
        rate.destroy()
        return True

    def _rcl_destroy_member(self, kind: str, entity: Any) -> bool:
        if not self._rcl_remove(kind, entity):
            return False
        entity.destroy()
        return True

    def destroy_node(self) -> None:
        """Leave the graph; everything the node made is destroyed with it. Does nothing the second time."""
        if self.handle.is_destroyed:
            return
        self._time_source.detach_node()
        executor = self.executor
        if executor is not None:
            executor._forget(self)
        self._parameter_event_publisher = None
        for rate in list(self._rcl_members["rate"]):
            self.destroy_rate(rate)
        for kind in _KINDS:
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

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self.handle.is_destroyed:
            self.destroy_node()


_KINDS = ("waitable", "publisher", "subscription", "client", "service", "timer", "guard", "rate")


def _qos(profile: QoSProfile | int) -> QoSProfile:
    """Return a profile; a number means KEEP_LAST with that depth.

    Raises
    ------
    TypeError, ValueError
        When it is neither.
    """
    if isinstance(profile, QoSProfile):
        return profile
    if not isinstance(profile, int):
        raise TypeError(f"Expected QoSProfile or int, but received {type(profile)!r}")
    if profile < 0:
        raise ValueError("history depth must be greater than or equal to zero")
    return QoSProfile(depth=profile)


def _attach(entity: Any, executor: Executor) -> None:
    hook = getattr(entity, "_rcl_hook", None)
    if hook is None:
        return  # publishers and rates run nothing
    hook.attach(executor._put)
    if isinstance(entity, Timer):
        entity.handle.attach(executor._schedule)
    elif hasattr(entity, "_rcl_adapter"):
        entity._rcl_adapter.attach(executor._schedule)


def _detach(entity: Any) -> None:
    hook = getattr(entity, "_rcl_hook", None)
    if hook is None:
        return
    hook.detach()
    if isinstance(entity, Timer):
        entity.handle.attach(None)
    elif hasattr(entity, "_rcl_adapter"):
        entity._rcl_adapter.attach(None)
