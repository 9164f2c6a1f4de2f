"""Waiting for one message."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from rclpy.impl.entities import SubscriptionHandle
from rclpy.impl.node_graph import checked_name
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from rclpy.node import Node


def wait_for_message(
    msg_type: Any,
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[bool, Any]:
    """Wait for the next message on a topic; nobody needs to spin the node.

    Parameters
    ----------
    msg_type
        Class of the message.
    node
        The node to subscribe with.
    topic
        The topic's name.
    qos_profile
        Quality of service; a number means KEEP_LAST with that depth.
    time_to_wait
        Seconds to wait at most; for ever where negative.

    Returns
    -------
    (bool, message or None)
        Whether there was one, and it.
    """
    profile = QoSProfile(depth=qos_profile) if isinstance(qos_profile, int) else qos_profile
    arrived = threading.Event()
    with node.handle as handle:
        subscription = SubscriptionHandle(handle, msg_type, checked_name(handle, topic, is_service=False), profile)
    subscription.set_on_ready(arrived.set)
    node.context.on_shutdown(arrived.set)
    try:
        arrived.wait(None if time_to_wait < 0 else time_to_wait)
        taken = subscription.impl.take()
        return (False, None) if taken is None else (True, taken[0])
    finally:
        subscription.destroy_when_not_in_use()
