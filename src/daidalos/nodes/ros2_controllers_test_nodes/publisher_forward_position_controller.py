"""`publisher_forward_position_controller`: sends goals to a position controller in turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.ros2_controllers_test_nodes._goals import GoalParameters, GoalPublisher
from daidalos.nodes.runner import UserError, run


@dataclass(frozen=True)
class ForwardPositionPublisherParameters(GoalParameters):
    """Parameters of ``publisher_forward_position_controller``.

    ``<goal>`` is the array of a goal's positions.
    """

    publish_topic: str = parameter("/position_commands", "Topic of the positions.")


class ForwardPositionPublisher(GoalPublisher):
    """Node that sends positions in turn."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("publisher_forward_position_controller", ForwardPositionPublisherParameters, **kwargs)
        from std_msgs.msg import Float64MultiArray

        topic = self.settings.publish_topic
        goals = [self.numbers(name) for name in self.goal_names]
        for name, goal in zip(self.goal_names, goals, strict=True):
            if not goal:
                raise UserError(f"the parameter '{name}' must hold the positions of that goal, as an array of numbers")
        self._publisher = self.create_publisher(Float64MultiArray, topic, 1)
        self.get_logger().info(f"sending {len(goals)} goals to '{topic}', one every {self.wait_s:g} s")
        self.start(goals)

    def send(self, goal: list[float]) -> None:
        """Publish the positions of one goal."""
        from std_msgs.msg import Float64MultiArray

        self.get_logger().info(f"sending {goal}")
        self._publisher.publish(Float64MultiArray(data=goal))


def main() -> int:
    """Run the node."""
    return run(ForwardPositionPublisher)
