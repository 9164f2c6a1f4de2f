"""Service introspection with a state that a parameter sets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter


def follow_parameter(node: Node, name: str, configure: Callable[[Any], None]) -> None:
    """Declare a parameter ``disabled``, ``metadata`` or ``contents``, and configure introspection as it says."""
    from rcl_interfaces.msg import SetParametersResult
    from rclpy.service_introspection import ServiceIntrospectionState

    states = {
        "disabled": ServiceIntrospectionState.OFF,
        "metadata": ServiceIntrospectionState.METADATA,
        "contents": ServiceIntrospectionState.CONTENTS,
    }

    def judge(parameters: list[Parameter[Any]]) -> Any:
        faulty = [each for each in parameters if each.name == name and each.value not in states]
        return SetParametersResult(
            successful=not faulty, reason=f"{name} must be one of {', '.join(states)}" if faulty else ""
        )

    def follow(parameters: list[Parameter[Any]]) -> None:
        for parameter in parameters:
            if parameter.name == name:
                configure(states[parameter.value])

    node.add_on_set_parameters_callback(judge)
    node.add_post_set_parameters_callback(follow)
    node.declare_parameter(name, "disabled")
