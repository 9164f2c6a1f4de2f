"""Nodes of the first tutorials: talker, listener, service server and service client."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile


class HelloTalker(Node):
    """Node that publishes ``Hello World: 0``, ``Hello World: 1`` and so on, and logs it.

    Parameters
    ----------
    name, topic
        The node's and the topic's.
    period_s
        Time from one message to the next.
    wording
        How it is logged; ``{}`` stands for what is said.
    first
        The first number.
    qos
        Quality of service, or the depth of the queue.
    """

    def __init__(
        self,
        name: str,
        topic: str,
        period_s: float,
        wording: str,
        *,
        first: int = 0,
        qos: QoSProfile | int = 10,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, **kwargs)
        from std_msgs.msg import String

        self.number = first
        self._wording = wording
        self._publisher = self.create_publisher(String, topic, qos)
        self.create_timer(period_s, self.talk)

    def talk(self) -> None:
        """Publish the next sentence."""
        from std_msgs.msg import String

        message = String(data=f"Hello World: {self.number}")
        self.number += 1
        self.get_logger().info(self._wording.format(message.data))
        self._publisher.publish(message)


class HelloListener(Node):
    """Logs what it hears; parameters as of `HelloTalker`, `raw` listens to bytes."""

    def __init__(
        self, name: str, topic: str, wording: str, *, qos: QoSProfile | int = 10, raw: bool = False, **kwargs: Any
    ) -> None:
        super().__init__(name, **kwargs)
        from std_msgs.msg import String

        self.received_count = 0
        self._wording = wording
        self.create_subscription(String, topic, self.hear, qos, raw=raw)

    def hear(self, message: Any) -> None:
        """Log a message."""
        self.received_count += 1
        text = message if isinstance(message, bytes) else message.data
        self.get_logger().info(self._wording.format(text))


class Adder(Node):
    """Server of ``add_two_ints``."""

    def __init__(self, name: str, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        from example_interfaces.srv import AddTwoInts

        self.adding = self.create_service(AddTwoInts, "add_two_ints", self._add)

    def _add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        return response


def request_sum(name: str, a: int, b: int, report: Callable[[Node, int], object]) -> None:
    """Call ``add_two_ints`` from a node of that name once it is available, and log the sum."""
    import rclpy
    from example_interfaces.srv import AddTwoInts

    rclpy.init()
    node = rclpy.create_node(name)
    try:
        client = node.create_client(AddTwoInts, "add_two_ints")
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info("service not available, waiting again...")
        answer = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(node, answer)
        report(node, answer.result().sum)
    finally:
        node.destroy_node()
