"""Publishers."""

from __future__ import annotations

from collections.abc import Sequence
from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar, Self

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import EventHandler, PublisherEventCallbacks
from rclpy.impl.entities import PublisherHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.qos import QoSProfile


class Publisher:
    """Publisher of messages on a topic; made by `Node.create_publisher`."""

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    def __init__(
        self,
        publisher_impl: PublisherHandle,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks,
        callback_group: CallbackGroup,
    ) -> None:
        self.__publisher = publisher_impl
        self._send = publisher_impl.impl.publish
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.event_handlers: Sequence[EventHandler] = event_callbacks.create_event_handlers(
            callback_group, publisher_impl, topic
        )

    def publish(self, msg: Any) -> None:
        """Send a message, or one already serialized as bytes.

        Raises
        ------
        TypeError
            When `msg` is neither of the topic's type nor bytes.
        """
        if self.__publisher._please_destroy:
            with self.__publisher:
                """Raises InvalidHandle."""
        self._send(msg)

    def get_subscription_count(self) -> int:
        """Return how many subscriptions get the messages."""
        with self.handle:
            return self.__publisher.get_subscription_count()

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        with self.handle:
            return self.__publisher.get_topic_name()

    @property
    def handle(self) -> PublisherHandle:
        """What is behind the publisher."""
        return self.__publisher

    @property
    def logger_name(self) -> str:
        """The name that the publisher's node logs under."""
        return self.__publisher.node.logger_name()

    def destroy(self) -> None:
        """Destroy the handle; use `Node.destroy_publisher` instead."""
        for handler in self.event_handlers:
            handler.destroy()
        self.__publisher.destroy_when_not_in_use()

    def assert_liveliness(self) -> None:
        """Assert that the publisher is alive (for the liveliness policy MANUAL_BY_TOPIC)."""
        with self.handle:
            self.__publisher.assert_liveliness()

    def wait_for_all_acked(self, timeout: Duration = Duration(nanoseconds=-1)) -> bool:  # noqa: B008
        """Wait until every reliable subscription has acknowledged all messages; False when time ran out.

        A negative time-out means as long as it takes. It is True at once where nobody acknowledges: over zenoh, whose
        links lose nothing, and where the publisher is best effort.
        """
        with self.handle as publisher:
            limit = timeout.nanoseconds
            return publisher.impl.wait_for_acks(limit if limit >= 0 else None)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.destroy()


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(__name__, {"rclpy.impl.type_variables": ("MsgType",)})
