"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from enum import Enum
from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import EventHandler, SubscriptionEventCallbacks
from rclpy.impl.entities import SubscriptionHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.ready import ReadyHook
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from rclpy.subscription_content_filter_options import ContentFilterOptions


class MessageInfo(TypedDict):
    """Metadata of a message; stamps are Unix time in nanoseconds."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None
    publisher_gid: dict[str, Any] | None


class Subscription:
    """Subscription to a topic's messages; made by `Node.create_subscription`."""

    concurrent = False
    """Whether callbacks may overlap, in nodes for asyncio."""

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    class CallbackType(Enum):
        """Arguments of the callback."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        subscription_impl: SubscriptionHandle,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: SubscriptionEventCallbacks,
    ) -> None:
        self.__subscription = subscription_impl
        self._impl = subscription_impl.impl
        self._rcl_hook = ReadyHook(self)
        self._rcl_node: Any = None
        self.msg_type = msg_type
        self.topic = topic
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        self._take_one = self._impl.take_raw if raw else self._impl.take
        self._filter: ContentFilterOptions | None = None
        self.event_handlers: Sequence[EventHandler] = event_callbacks.create_event_handlers(
            callback_group, subscription_impl, topic
        )
        subscription_impl.set_on_ready(self._rcl_hook)

    def get_publisher_count(self) -> int:
        """Return how many publishers send messages here."""
        with self.handle:
            return self.__subscription.get_publisher_count()

    @property
    def handle(self) -> SubscriptionHandle:
        """What is behind the subscription."""
        return self.__subscription

    def destroy(self) -> None:
        """Destroy the handle; use `Node.destroy_subscription` instead."""
        for handler in self.event_handlers:
            handler.destroy()
        self.__subscription.destroy_when_not_in_use()

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        with self.handle:
            return self.__subscription.get_topic_name()

    @property
    def callback(self) -> Callable[..., Any]:
        """What is called with every message, and with its `MessageInfo` when it takes two arguments."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., Any]) -> None:
        self._callback = value
        self._callback_type = _callback_type(value)
        self._with_info = self._callback_type is Subscription.CallbackType.WithMessageInfo

    @property
    def logger_name(self) -> str:
        """The name that the subscription's node logs under."""
        return self.__subscription.node.logger_name()

    def set_content_filter(self, filter_expression: str, expression_parameters: Sequence[str] = ()) -> None:
        """Receive only messages that fulfil a condition; all again where the expression is empty.

        Parameters
        ----------
        filter_expression
            In the language of DDS 1.4, annex B, such as ``int32_value > %0 AND name LIKE 'test%'``.
        expression_parameters
            What ``%0``, ``%1`` ... stand for.

        Raises
        ------
        ContentFilterError
            When the expression cannot be understood, or does not fit the topic's type.
        """
        from rclpy.subscription_content_filter_options import ContentFilterOptions

        take = self._impl.take_raw if self.raw else self._impl.take
        if not filter_expression:
            self._filter, self._take_one = None, take
            return
        from rclpy.impl.content_filter import filtered

        self._take_one = filtered(take, self.msg_type, self.raw, filter_expression, expression_parameters)
        self._filter = ContentFilterOptions(filter_expression, list(expression_parameters))

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the condition that messages must fulfil; one with an empty expression where there is none."""
        from rclpy.subscription_content_filter_options import ContentFilterOptions

        return self._filter or ContentFilterOptions()

    @property
    def is_cft_enabled(self) -> bool:
        """Whether messages must fulfil a condition."""
        return self._filter is not None

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        taken = self._take_one()
        if taken is None:
            return None
        message, item = taken
        if self._with_info:
            return self._callback, (message, self._message_info(item))
        return self._callback, (message,)

    def _message_info(self, item: Any) -> MessageInfo:
        info = self._impl.info(item)
        return MessageInfo(
            source_timestamp=info.source_ns,
            received_timestamp=info.received_ns,
            publication_sequence_number=info.sequence,
            reception_sequence_number=None,
            publisher_gid={
                "implementation_identifier": self.__subscription.node.session.backend.identifier,
                "data": info.gid,
            },
        )

    def _rcl_has_more(self) -> bool:
        return bool(self._impl.queue)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.destroy()


def _callback_type(callback: Callable[..., Any]) -> Subscription.CallbackType:
    """Return by its signature whether a callback takes the message's info as well.

    Raises
    ------
    RuntimeError
        When it can be called with neither one nor two arguments.
    """
    try:
        signature = inspect.signature(callback)
    except (TypeError, ValueError):
        return Subscription.CallbackType.MessageOnly  # a built-in function
    for count, kind in (
        (1, Subscription.CallbackType.MessageOnly),
        (2, Subscription.CallbackType.WithMessageInfo),
    ):
        try:
            signature.bind(*[None] * count)
        except TypeError:
            continue
        return kind
    raise RuntimeError(
        "Subscription.__init__(): callback should be either be callable with one argument (to get only the message) "
        "or two (to get message and message info)"
    )


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(__name__, {"rclpy.impl.type_variables": ("MsgType",)})
