"""`introspection_client`: calls a service repeatedly, with events on ``add_two_ints/_service_event``."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from daidalos.nodes.demo_nodes_py._introspection import follow_parameter


class IntrospectionClient(Node):
    """Client that calls ``add_two_ints`` twice a second; ``client_configure_introspection`` sets its events."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("introspection_client", **kwargs)
        from example_interfaces.srv import AddTwoInts
        from rclpy.qos import qos_profile_system_default

        self._client = self.create_client(AddTwoInts, "add_two_ints")
        self._answer: Any = None
        follow_parameter(
            self,
            "client_configure_introspection",
            lambda state: self._client.configure_introspection(self.get_clock(), qos_profile_system_default, state),
        )
        self.create_timer(0.5, self._ask)

    def _ask(self) -> None:
        from example_interfaces.srv import AddTwoInts

        if self._answer is not None and not self._answer.done():
            return
        if self._client.service_is_ready():
            self._answer = self._client.call_async(AddTwoInts.Request(a=2, b=3))
            self._answer.add_done_callback(
                lambda answer: self.get_logger().info(f"Result of add_two_ints: {answer.result().sum}")
            )
