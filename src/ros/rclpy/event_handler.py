"""Callbacks for events of publishers and subscriptions."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from enum import IntEnum
from typing import Any

import rclpy.logging
from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import PublisherHandle, SubscriptionHandle
from rclpy.impl.errors import UnsupportedEventTypeError as UnsupportedEventTypeError
from rclpy.impl.event_statuses import (
    IncompatibleTypeStatus,
    LivelinessChangedStatus,
    LivelinessLostStatus,
    MatchedStatus,
    MessageLostStatus,
    OfferedDeadlineMissedStatus,
    OfferedIncompatibleQosStatus,
    QoSPublisherEventType,
    QoSSubscriptionEventType,
    RequestedDeadlineMissedStatus,
    RequestedIncompatibleQosStatus,
)
from rclpy.impl.events import EventSource, TopicHandle, event_source
from rclpy.impl.ready import ReadyHook
from rclpy.qos import qos_policy_name_from_kind
from rclpy.waitable import Waitable

QoSOfferedDeadlineMissedInfo = OfferedDeadlineMissedStatus
QoSRequestedDeadlineMissedInfo = RequestedDeadlineMissedStatus
QoSLivelinessLostInfo = LivelinessLostStatus
QoSLivelinessChangedInfo = LivelinessChangedStatus
QoSMessageLostInfo = MessageLostStatus
QoSOfferedIncompatibleQoSInfo = OfferedIncompatibleQosStatus
QoSRequestedIncompatibleQoSInfo = RequestedIncompatibleQosStatus
QoSSubscriptionMatchedInfo = MatchedStatus
QoSPublisherMatchedInfo = MatchedStatus
IncompatibleTypeInfo = IncompatibleTypeStatus


class EventHandler(Waitable):
    """Handler that calls a function with the status of an event whenever it changes."""

    def __init__(
        self,
        *,
        callback_group: CallbackGroup,
        callback: Callable[[Any], Any],
        event_type: IntEnum,
        parent_impl: TopicHandle,
    ) -> None:
        super().__init__(callback_group)
        self.callback = callback
        self.event_type = event_type
        self._rcl_hook = ReadyHook(self)
        self._source: EventSource = event_source(parent_impl, event_type, self._rcl_hook)

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        status = self._source.take()
        return None if status is None else (self.callback, (status,))

    def _rcl_has_more(self) -> bool:
        return self._source.is_ready

    def destroy(self) -> None:
        """Call no more."""
        self._source.close()


class QoSEventHandler(EventHandler):
    """The old name of `EventHandler`."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        warnings.warn("QoSEventHandler is deprecated, use EventHandler instead.", DeprecationWarning, stacklevel=2)
        super().__init__(*args, **kwargs)


class _EventCallbacks:
    """Common base of publishers' and subscriptions' event callbacks."""

    use_default_callbacks: bool

    def _handlers(
        self,
        callbacks: dict[IntEnum, Callable[[Any], Any] | None],
        defaults: dict[IntEnum, Callable[[Any], None]],
        group: CallbackGroup,
        handle: TopicHandle,
    ) -> list[EventHandler]:
        """Return a handler for every function, and for every default in whose place there is none."""
        chosen = {kind: callback for kind, callback in callbacks.items() if callback is not None}
        if self.use_default_callbacks:
            chosen = defaults | chosen
        return [
            EventHandler(callback_group=group, callback=callback, event_type=kind, parent_impl=handle)
            for kind, callback in chosen.items()
        ]


class SubscriptionEventCallbacks(_EventCallbacks):
    """Functions to call at events of a subscription; by default incompatible publishers are warned of.

    Of another type is warned while no publisher of the topic has the subscription's own.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[Any], None] | None = None,
        incompatible_qos: Callable[[Any], None] | None = None,
        liveliness: Callable[[Any], None] | None = None,
        message_lost: Callable[[Any], None] | None = None,
        incompatible_type: Callable[[Any], None] | None = None,
        matched: Callable[[Any], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.incompatible_qos = incompatible_qos
        self.liveliness = liveliness
        self.message_lost = message_lost
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup, subscription: SubscriptionHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return a handler for every function."""
        with subscription:
            logger = rclpy.logging._root_logger.get_child(subscription.node.logger_name())

        def warn_of_qos(event: Any) -> None:
            policy = qos_policy_name_from_kind(event.last_policy_kind)
            logger.warn(
                f"New publisher discovered on topic '{topic_name}', offering incompatible QoS. No messages will be "
                f"received from it. Last incompatible policy: {policy}"
            )

        def warn_of_type(event: Any) -> None:
            # A bridge joins two types on one topic: each end has others of its own type there.
            if not subscription.get_publisher_count():
                logger.warn(f"Incompatible type on topic '{topic_name}', no messages will be received from it.")

        kinds = QoSSubscriptionEventType
        return self._handlers(
            {
                kinds.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: self.deadline,
                kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: self.incompatible_qos,
                kinds.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: self.liveliness,
                kinds.RCL_SUBSCRIPTION_MESSAGE_LOST: self.message_lost,
                kinds.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: self.incompatible_type,
                kinds.RCL_SUBSCRIPTION_MATCHED: self.matched,
            },
            {
                kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: warn_of_qos,
                kinds.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: warn_of_type,
            },
            callback_group,
            subscription,
        )


class PublisherEventCallbacks(_EventCallbacks):
    """Functions to call at events of a publisher; by default incompatible subscriptions are warned of.

    Of another type is warned while no subscription to the topic has the publisher's own.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[Any], None] | None = None,
        liveliness: Callable[[Any], None] | None = None,
        incompatible_qos: Callable[[Any], None] | None = None,
        incompatible_type: Callable[[Any], None] | None = None,
        matched: Callable[[Any], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.liveliness = liveliness
        self.incompatible_qos = incompatible_qos
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup, publisher: PublisherHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return a handler for every function."""
        with publisher:
            logger = rclpy.logging._root_logger.get_child(publisher.node.logger_name())

        def warn_of_qos(event: Any) -> None:
            policy = qos_policy_name_from_kind(event.last_policy_kind)
            logger.warn(
                f"New subscription discovered on topic '{topic_name}', requesting incompatible QoS. No messages will "
                f"be sent to it. Last incompatible policy: {policy}"
            )

        def warn_of_type(event: Any) -> None:
            # A bridge joins two types on one topic: each end has others of its own type there.
            if not publisher.get_subscription_count():
                logger.warn(f"Incompatible type on topic '{topic_name}', no messages will be sent to it.")

        kinds = QoSPublisherEventType
        return self._handlers(
            {
                kinds.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: self.deadline,
                kinds.RCL_PUBLISHER_LIVELINESS_LOST: self.liveliness,
                kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: self.incompatible_qos,
                kinds.RCL_PUBLISHER_INCOMPATIBLE_TYPE: self.incompatible_type,
                kinds.RCL_PUBLISHER_MATCHED: self.matched,
            },
            {
                kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: warn_of_qos,
                kinds.RCL_PUBLISHER_INCOMPATIBLE_TYPE: warn_of_type,
            },
            callback_group,
            publisher,
        )
