"""`joint_state_publisher_gui`: joints set by hand; each is a parameter with its limits, a slider in the studio."""

from __future__ import annotations

import random
from typing import Any

from daidalos.nodes.joint_state_publisher.joint_state_publisher import JointStatePublisher, description_from_arguments
from daidalos.nodes.studio_window import run_with_window

_PREFIX = "joints."


class JointStatePublisherGui(JointStatePublisher):
    """Joint state publisher whose joints are parameters ``joints.<name>`` within the joints' limits.

    ``~/center`` puts them back to where they began, ``~/randomize`` anywhere.
    """

    def __init__(self, description: str = "", source: str = "robot_description", **kwargs: Any) -> None:
        super().__init__(description, source, "joint_state_publisher_gui", **kwargs)
        from std_srvs.srv import Empty

        self._random = random.Random(0)
        self.create_service(Empty, "~/center", self._on_center)
        self.create_service(Empty, "~/randomize", self._on_randomize)
        self.add_post_set_parameters_callback(self._on_set)

    def read(self, text: str, source: str = "robot_description") -> None:
        """Read a robot description, and declare a parameter for each joint."""
        from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor

        super().read(text, source)
        values = self.values
        for each in values.ranges if values is not None else ():
            limits = [FloatingPointRange(from_value=each.lower, to_value=each.upper)]
            words = f"position of {each.name} [{each.unit}]"
            descriptor = ParameterDescriptor(description=words, floating_point_range=limits)
            name = _PREFIX + each.name
            if self.has_parameter(name):
                self.undeclare_parameter(name)
            self.declare_parameter(name, min(max(each.zero, each.lower), each.upper), descriptor)

    def _on_set(self, parameters: list[Any]) -> None:
        for parameter in parameters:
            if parameter.name.startswith(_PREFIX) and self.values is not None:
                self.values.take([parameter.name.removeprefix(_PREFIX)], [float(parameter.value)])

    def _on_center(self, request: Any, response: Any) -> Any:
        self._move({each.name: each.zero for each in self.values.ranges} if self.values is not None else {})
        return response

    def _on_randomize(self, request: Any, response: Any) -> Any:
        ranges = self.values.ranges if self.values is not None else ()
        self._move({each.name: self._random.uniform(each.lower, each.upper) for each in ranges})
        return response

    def _move(self, positions: dict[str, float]) -> None:
        from rclpy.parameter import Parameter

        self.set_parameters([Parameter(_PREFIX + name, value=value) for name, value in positions.items()])


def main() -> int:
    """Run the node with its window."""
    return run_with_window(
        lambda: JointStatePublisherGui(**description_from_arguments()),
        "joints",
        lambda node: {"node": node.get_fully_qualified_name()},
    )
