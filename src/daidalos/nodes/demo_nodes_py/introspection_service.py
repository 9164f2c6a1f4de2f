"""`introspection_service`: adds integers, with events on ``add_two_ints/_service_event``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.demo_nodes_py._introspection import follow_parameter
from daidalos.nodes.hello_world import Adder


class IntrospectionService(Adder):
    """Server of ``add_two_ints``; ``service_configure_introspection`` sets its events."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("introspection_service", **kwargs)
        from rclpy.qos import qos_profile_system_default

        follow_parameter(
            self,
            "service_configure_introspection",
            lambda state: self.adding.configure_introspection(self.get_clock(), qos_profile_system_default, state),
        )
