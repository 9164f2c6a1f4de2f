"""Watch over managed nodes: whether each is in the graph and answers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future

WATCH_PERIOD_S = 0.1
"""How often [s] the graph is looked at."""

_REQUESTS_IN_A_TIMEOUT = 2


class ServerWatch:
    """Watch over managed nodes by their service ``get_state``.

    Parameters
    ----------
    node : Node
        Asks.
    timeout : float
        Time [s] without an answer after which a node is down.
    client_of : callable
        Returns the client of a service by its type, the name of the node and that of the service.

    Attributes
    ----------
    clock : Clock
        Steady: a process answers in real time, whether the simulation goes on or not.
    """

    def __init__(self, node: Node, timeout: float, client_of: Callable[[Any, str, str], Any]) -> None:
        self._node = node
        self._timeout = timeout
        self._client_of = client_of
        self.clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._asked: dict[str, tuple[float, Future]] = {}

    def problem(self, names: Sequence[str]) -> tuple[str, str]:
        """Return which of some nodes is down and why, empty where none is; to be called every `WATCH_PERIOD_S`."""
        missing = self.missing(names)
        if missing:
            self._asked.clear()
            return missing[0], "it has ended"
        now = 1e-9 * self.clock.now().nanoseconds
        for name in names:
            since, answer = self._asked.get(name, (-self._timeout, None))
            if answer is not None and not answer.done():
                if now - since > self._timeout:
                    self._asked.clear()
                    return name, f"it has not answered for {self._timeout:g} s"
            elif now - since >= self._timeout / _REQUESTS_IN_A_TIMEOUT:
                self._asked[name] = (now, self._ask(name))
        return "", ""

    def missing(self, names: Sequence[str]) -> list[str]:
        """Return which of some nodes are not in the graph."""
        return [name for name in names if not self._client(name).service_is_ready()]

    async def all_return(self, names: Sequence[str], within: float) -> bool:
        """Wait until some nodes are in the graph and answer; return whether they are within a time [s]."""
        end = self.clock.now() + Duration(seconds=within)
        while self.clock.now() < end:
            if not self.missing(names):
                answers = [self._ask(name) for name in names]
                while self.clock.now() < end and not all(answer.done() for answer in answers):
                    await self._pause()
                return all(answer.done() for answer in answers)
            await self._pause()
        return False

    async def _pause(self) -> None:
        over = Future()
        timer = self._node.create_timer(WATCH_PERIOD_S, lambda: over.set_result(None), clock=self.clock)
        await over
        self._node.destroy_timer(timer)

    def _client(self, name: str) -> Any:
        from lifecycle_msgs.srv import GetState

        return self._client_of(GetState, name, "get_state")

    def _ask(self, name: str) -> Future:
        client = self._client(name)
        answer: Future = client.call_async(client.srv_type.Request())
        return answer


def stop_robot(node: Node) -> None:
    """Publish a velocity of zero on ``cmd_vel``, in each type that the topic has."""
    from geometry_msgs.msg import Twist, TwistStamped

    topic = node.resolve_topic_name("cmd_vel")
    types = dict(node.get_topic_names_and_types()).get(topic, [])
    for kind, name in ((Twist, "geometry_msgs/msg/Twist"), (TwistStamped, "geometry_msgs/msg/TwistStamped")):
        if name not in types:
            continue
        message = kind()
        if isinstance(message, TwistStamped):
            message.header.stamp = node.get_clock().now().to_msg()
        publisher = node.create_publisher(kind, topic, 1)
        publisher.publish(message)
        node.destroy_publisher(publisher)
