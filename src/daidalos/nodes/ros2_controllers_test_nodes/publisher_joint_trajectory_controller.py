"""`publisher_joint_trajectory_controller`: sends goals to a trajectory controller in turn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.ros2_controllers_test_nodes._goals import GoalParameters, GoalPublisher
from daidalos.nodes.runner import UserError, run

_QUANTITIES = ("positions", "velocities", "accelerations", "effort")
_REACHED_AFTER_S = 4
_ANY_START = [-2 * math.pi, 2 * math.pi]


@dataclass(frozen=True)
class JointTrajectoryPublisherParameters(GoalParameters):
    """Parameters of ``publisher_joint_trajectory_controller``.

    ``<goal>.positions``, ``<goal>.velocities``, ``<goal>.accelerations`` and ``<goal>.effort`` are arrays with an
    element for each joint; one of them is enough. ``starting_point_limits.<joint>`` are a lower and an upper limit.
    """

    wait_sec_between_publish: float = parameter(6.0, "Time between goals.", unit="s", above=0.0, takes_integer=True)
    controller_name: str = parameter("position_trajectory_controller", "Controller to send goals to.")
    joints: tuple[str, ...] = parameter(("",), "Joints of the controller.")
    check_starting_point: bool = parameter(
        False, "Whether to send nothing unless the first state of the joints is within their limits."
    )


class JointTrajectoryPublisher(GoalPublisher):
    """Node that sends trajectories of one point, to be reached after 4 s."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("publisher_position_trajectory_controller", JointTrajectoryPublisherParameters, **kwargs)
        from trajectory_msgs.msg import JointTrajectory

        controller = self.settings.controller_name
        self._joints = [name for name in self.settings.joints if name]
        if not self._joints:
            raise UserError("the parameter 'joints' must name the controller's joints")
        self._is_at_start: bool | None = None
        self._limits: dict[str, list[float]] = {}
        if self.settings.check_starting_point:
            self._check_start()
        else:
            self._is_at_start = True
        goals = [goal for goal in map(self._goal, self.goal_names) if goal is not None]
        if not goals:
            raise UserError(f"none of the goals {', '.join(self.goal_names)} says where the joints are to go")
        topic = f"/{controller.lstrip('/')}/joint_trajectory"
        self._publisher = self.create_publisher(JointTrajectory, topic, 1)
        self.get_logger().info(f"sending {len(goals)} goals to '{topic}', one every {self.wait_s:g} s")
        self.start(goals)

    def send(self, goal: Any) -> None:
        """Publish a trajectory that leads to one goal."""
        from trajectory_msgs.msg import JointTrajectory

        self.get_logger().info(f"sending {goal}")
        self._publisher.publish(JointTrajectory(joint_names=self._joints, points=[goal]))

    def is_ready(self) -> bool:
        """Return whether the joints have been seen within the limits of the start."""
        if self._is_at_start is None:
            self.get_logger().warning("no goal is sent: nothing is heard of the joints on 'joint_states'")
        elif not self._is_at_start:
            self.get_logger().warning("no goal is sent: the joints started outside 'starting_point_limits'")
        return bool(self._is_at_start)

    def _goal(self, name: str) -> Any:
        """Return the point that parameters describe; None, with a warning, where they do not."""
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectoryPoint

        given = {quantity: self.numbers(f"{name}.{quantity}") for quantity in _QUANTITIES}
        fitting = {quantity: values for quantity, values in given.items() if len(values) == len(self._joints)}
        if not fitting:
            self.get_logger().warning(
                f"the goal '{name}' is left out: one of {', '.join(f'{name}.{each}' for each in _QUANTITIES)} "
                f"must hold {len(self._joints)} numbers, one for every joint"
            )
            return None
        return JointTrajectoryPoint(time_from_start=Duration(sec=_REACHED_AFTER_S), **fitting)

    def _check_start(self) -> None:
        from sensor_msgs.msg import JointState

        for joint in self._joints:
            parameter = f"starting_point_limits.{joint}"
            self._limits[joint] = self.numbers(parameter) or _ANY_START
            if len(self._limits[joint]) != 2:
                raise UserError(f"the parameter '{parameter}' must hold two numbers, the lower and the upper limit")
        self.create_subscription(JointState, "joint_states", self._on_state, 10)

    def _on_state(self, state: Any) -> None:
        if self._is_at_start is not None:
            return
        here = dict(zip(state.name, state.position, strict=False))
        limits = {joint: each for joint, each in self._limits.items() if joint in here}
        outside = [joint for joint, (lower, upper) in limits.items() if not lower <= here[joint] <= upper]
        for joint in outside:
            self.get_logger().warning(f"joint '{joint}' is at {here[joint]:g}, outside {self._limits[joint]}")
        self._is_at_start = not outside


def main() -> int:
    """Run the node."""
    return run(JointTrajectoryPublisher)
