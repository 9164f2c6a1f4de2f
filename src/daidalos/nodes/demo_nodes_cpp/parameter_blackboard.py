"""`parameter_blackboard`: stores parameters that other nodes set."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node


class ParameterBlackboard(Node):
    """Node that accepts every parameter, declared or not."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(
            "parameter_blackboard",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
            **kwargs,
        )
        count = len(self.get_parameters_by_prefix(""))
        self.get_logger().info(
            f"Parameter blackboard node named '{self.get_fully_qualified_name()}' ready, and serving "
            f"'{count}' parameters already!"
        )
