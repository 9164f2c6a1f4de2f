"""Waiting until something has come on some topics."""

from __future__ import annotations

import itertools
import os
import threading
from collections import deque
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_numbers = itertools.count()


class WaitForTopics:
    """Listener that waits until at least one message has come on each of some topics.

    It has a context and a node of its own, so it needs no `rclpy.init`. In a ``with`` statement it waits on the
    way in, and raises `RuntimeError` where a topic stays silent.

    Parameters
    ----------
    topic_tuples
        Names and message types.
    timeout
        How long to wait, s.
    messages_received_buffer_length
        How many messages of a topic are kept, the newest; all if None.
    trigger
        Called before the wait, when the topics are listened to: with the node, and with what `wait` was given.
    node_namespace
        The namespace of the node.
    qos_profile
        How the topics are listened to; the depth of their queues if a number.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, type[Any]]],
        timeout: float = 5.0,
        messages_received_buffer_length: int | None = 10,
        trigger: Callable[..., Any] | None = None,
        node_namespace: str | None = None,
        qos_profile: QoSProfile | int = 10,
    ) -> None:
        import rclpy
        from rclpy.context import Context

        from .message_pump import MessagePump

        topics = list(topic_tuples)
        if trigger is not None and not callable(trigger):
            raise TypeError("the trigger is not callable")
        self.timeout = timeout
        self.trigger = trigger
        self._messages: dict[str, deque[Any]] = {
            name: deque(maxlen=messages_received_buffer_length) for name, _ in topics
        }
        self._received: set[str] = set()
        self._all_received = threading.Event()
        self._context = Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node(
            f"_test_node_{os.getpid()}_{next(_numbers)}", namespace=node_namespace, context=self._context
        )
        for name, message_type in topics:
            self._node.create_subscription(message_type, name, self._listener(name), qos_profile)
        if not topics:
            self._all_received.set()
        self._pump = MessagePump(self._node, context=self._context)
        self._pump.start()

    def _listener(self, name: str) -> Callable[[Any], None]:
        def listen(message: Any) -> None:
            self._messages[name].append(message)
            self._received.add(name)
            if len(self._received) == len(self._messages):
                self._all_received.set()

        return listen

    def wait(self, *args: Any, **kwargs: Any) -> bool:
        """Wait until a message has come on every topic; return whether that was before the timeout.

        Parameters
        ----------
        *args, **kwargs
            Given to the trigger, after the node.
        """
        if self.trigger is not None:
            self.trigger(self._node, *args, **kwargs)
        return self._all_received.wait(self.timeout)

    def shutdown(self) -> None:
        """Listen no more; a second call does nothing."""
        if not self._context.ok():
            return
        self._pump.stop()
        self._node.destroy_node()
        self._context.try_shutdown()

    def topics_received(self) -> set[str]:
        """Return the topics on which something came."""
        return set(self._received)

    def topics_not_received(self) -> set[str]:
        """Return the topics that were silent."""
        return set(self._messages) - self._received

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the messages of a topic, the oldest first.

        Raises
        ------
        KeyError
            If the topic is not one of those that are listened to.
        """
        if topic_name not in self._messages:
            raise KeyError(f"'{topic_name}' is not one of the topics {', '.join(map(repr, self._messages))}")
        return list(self._messages[topic_name])

    def messages_received(self, topic_name: str) -> list[Any]:
        """Return what `received_messages` does."""
        return self.received_messages(topic_name)

    def __enter__(self) -> WaitForTopics:
        try:
            arrived = self.wait()
        except BaseException:
            self.shutdown()
            raise
        if not arrived:
            silent = self.topics_not_received()
            self.shutdown()
            raise RuntimeError(f"Did not receive messages on these topics: {', '.join(map(repr, sorted(silent)))}")
        return self

    def __exit__(self, *exception: object) -> None:
        self.shutdown()
