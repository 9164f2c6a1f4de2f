"""Factory of a node's publishers, subscriptions, services, clients and timers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.client import Client
from rclpy.clock import Clock, ROSClock
from rclpy.constants import S_TO_NS
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.guard_condition import GuardCondition
from rclpy.impl.entities import ClientHandle, NodeHandle, PublisherHandle, ServiceHandle, SubscriptionHandle
from rclpy.impl.node_graph import checked_name
from rclpy.impl.node_members import NodeMembers
from rclpy.impl.node_parameters import NodeParameters
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, qos_profile_services_default
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer
from rclpy.type_support import check_is_valid_msg_type, check_is_valid_srv_type

if TYPE_CHECKING:
    from rclpy.qos_overriding_options import QoSOverridingOptions
    from rclpy.subscription_content_filter_options import ContentFilterOptions


class NodeEntities(NodeMembers, NodeParameters):
    """The part of `Node` that makes what it consists of."""

    handle: NodeHandle
    _context: Context
    _default_callback_group: CallbackGroup
    _clock: ROSClock
    _logger: RcutilsLogger
    _rcl_client_class: type[Client] = Client

    @property
    def context(self) -> Context:
        """The node's context."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of entities that are given none: mutually exclusive."""
        return self._default_callback_group

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
        profile = depth_or_profile(qos_profile)
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
        callback
            Called with every message, and with its `MessageInfo` when it takes two arguments.
        raw
            Whether the callback gets the serialized bytes.
        content_filter_options
            Which messages are wanted; all where None.
        callback_group
            Of the callback and the event callbacks; the node's default where None.
        msg_type, topic, qos_profile, event_callbacks, qos_overriding_options
            As in `create_publisher`.

        Raises
        ------
        InvalidTopicNameException
            When the name breaks the rules.
        """
        profile = depth_or_profile(qos_profile)
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
        if callback is None:
            self._logger.warning(
                "the callback of a timer is None, so it calls nothing: pass the function itself, without parentheses"
            )
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
        """Create a rate for a loop at `frequency` hertz of a clock, by default the node's.

        Raises
        ------
        ValueError
            For a frequency that is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = Timer(None, None, int(S_TO_NS / frequency), clock or self._clock, context=self.context)
        rate: Rate = self._rcl_add("rate", Rate(timer, context=self.context))
        return rate


def depth_or_profile(profile: QoSProfile | int) -> QoSProfile:
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
