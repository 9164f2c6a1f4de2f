"""Nodes for containers: talker, listener, service server and service client."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.task import Future

from daidalos.nodes.hello_world import Adder, HelloListener, HelloTalker

_PERIOD_S = 2.0


class Talker(HelloTalker):
    """Node that publishes a sentence on ``chatter`` every second."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("talker", "chatter", 1.0, "Publishing: '{}'", first=1, **kwargs)


class Listener(HelloListener):
    """Logs each sentence."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("listener", "chatter", "I heard: [{}]", **kwargs)


class NodeLikeListener(Listener):
    """The same under the name of a component that in C++ only holds a node."""


class Server(Adder):
    """Server of ``add_two_ints``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("Server", **kwargs)


class Client(Node):
    """Client that requests the sum of 2 and 3 every two seconds."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("Client", **kwargs)
        from example_interfaces.srv import AddTwoInts

        self._request = AddTwoInts.Request(a=2, b=3)
        self._client = self.create_client(AddTwoInts, "add_two_ints")
        self.create_timer(_PERIOD_S, self.ask)

    def ask(self) -> None:
        """Send a request once the service is available, and log the response."""
        if self._client.service_is_ready():
            self._client.call_async(self._request).add_done_callback(self._notify)
        else:
            self.get_logger().info("Service not available, waiting again...")

    def _notify(self, answer: Future) -> None:
        self.get_logger().info(f"Got result: [{answer.result().sum}]")
