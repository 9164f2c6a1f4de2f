"""`set_parameters_callback`: a parameter that sets another one, and a variable that follows a parameter."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

_LEADER, _FOLLOWER = "param1", "param2"
_FOLLOWING = 4.0


class SetParametersCallback(Node):
    """Declares ``param1`` and ``param2``; setting the first sets the second, whatever its value was."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("set_param_callback_node", **kwargs)
        self.tracked = {name: float(self.declare_parameter(name, 0.0).value or 0.0) for name in (_LEADER, _FOLLOWER)}
        self.add_pre_set_parameters_callback(self._before)
        self.add_on_set_parameters_callback(self._judge)
        self.add_post_set_parameters_callback(self._after)

    def _before(self, parameters: list[Parameter[Any]]) -> list[Parameter[Any]]:
        """Add what is to be set besides."""
        if any(parameter.name == _LEADER for parameter in parameters):
            return [*parameters, Parameter(_FOLLOWER, value=_FOLLOWING)]
        return parameters

    def _judge(self, parameters: list[Parameter[Any]]) -> Any:
        """Return whether the values are accepted."""
        from rcl_interfaces.msg import SetParametersResult

        faulty = [each.name for each in parameters if each.name in self.tracked and not isinstance(each.value, float)]
        return SetParametersResult(
            successful=not faulty, reason=f"{', '.join(faulty)} must be floating-point numbers" if faulty else ""
        )

    def _after(self, parameters: list[Parameter[Any]]) -> None:
        """Store the new values."""
        for parameter in parameters:
            if parameter.name in self.tracked:
                self.tracked[parameter.name] = parameter.value
                self.get_logger().info(f"{parameter.name} is now {parameter.value}")
