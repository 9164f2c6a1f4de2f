"""A subscription that needs no executor."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.impl.entities import SubscriptionHandle
from rclpy.impl.node_graph import checked_name
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.node import Node


class Inbox(Subscription):
    """Subscription that calls its callback on the thread that receives the messages.

    So they are there while another callback waits for them, and cost no round through the executor. Who calls
    `spin_once` counts on it to return when a message came, so the executor gets an empty piece of work for
    each; one that spins for good is left to sleep.
    """

    def __init__(self, handle: SubscriptionHandle, *arguments: Any) -> None:
        self._arrivals: deque[None] = deque(maxlen=100)
        super().__init__(handle, *arguments)
        handle.set_sink(self._receive)

    def _receive(self, message: Any) -> None:
        self._callback(message)
        node = self._rcl_node() if self._rcl_node is not None else None
        if not getattr(node.executor if node is not None else None, "_spins", False):
            self._arrivals.append(None)
            self._rcl_hook()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        if not self._arrivals:
            return None
        self._arrivals.popleft()
        return _do_nothing, ()

    def _rcl_has_more(self) -> bool:
        return bool(self._arrivals)


def _do_nothing() -> None:
    """Do nothing, in place of a callback that has already run."""


def create_inbox(
    node: Node,
    message_type: Any,
    topic: str,
    callback: Callable[[Any], None],
    qos: QoSProfile | int,
    group: CallbackGroup,
) -> Inbox:
    """Subscribe as `Node.create_subscription` does, but with an `Inbox`."""
    profile = qos if isinstance(qos, QoSProfile) else QoSProfile(depth=qos)
    with node.handle as handle:
        name = checked_name(handle, topic, is_service=False)
        subscription = SubscriptionHandle(handle, message_type, name, profile)
    inbox = Inbox(subscription, message_type, topic, callback, group, profile, False, SubscriptionEventCallbacks())
    for handler in inbox.event_handlers:
        node.add_waitable(handler)
    node._rcl_add("subscription", inbox, group)
    return inbox
