"""`ros2_control_node`: controllers on the hardware that a robot's description names."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.qos import DurabilityPolicy, QoSProfile

from daidalos.control.errors import ControlError
from daidalos.control.hardware.base import Hardware, HardwareSetting
from daidalos.control.plugins import hardware_class
from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.ros2_control import read_hardware
from daidalos.nodes.controller_manager._manager_node import ControllerManagerNode
from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError, run

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_LONGEST_LAG_NS = 1_000_000_000
"""Delay after which cycles that were missed are left out."""


class Ros2ControlNode(ControllerManagerNode):
    """Waits for ``robot_description``, then runs at ``update_rate`` of its clock."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("controller_manager", **kwargs)
        text = self._parameter("robot_description", "")
        if text:
            self._begin(text)
        else:
            from std_msgs.msg import String

            self.create_subscription(String, "robot_description", self._on_description, _LATCHED)
            self.get_logger().info("waiting for the topic 'robot_description'")

    def _on_description(self, message: Any) -> None:
        if self.manager is not None:
            self.get_logger().warning("another robot description came and is ignored")
            return
        try:
            self._begin(message.data)
        except UserError as error:
            self.get_logger().error(str(error))

    def _begin(self, text: str) -> None:
        try:
            robot = urdf.parse(text, "robot_description", package_share)
            setting = HardwareSetting(self.update_rate, self.warn)
            hardware: list[Hardware] = [hardware_class(info.plugin)(info, setting) for info in read_hardware(robot)]
            if not hardware:
                raise ControlError("the robot description has no <ros2_control> element")
            self.start(robot, hardware)
        except (DescriptionError, ControlError) as error:
            raise UserError(str(error)) from None
        self._period_ns = 1e9 / self.update_rate
        self._due_ns = 0.0
        self.create_timer(1.0 / self.update_rate, self._tick, callback_group=MutuallyExclusiveCallbackGroup())

    def _tick(self) -> None:
        """Run a cycle; as many as are due where the clock goes in larger steps."""
        clock = self.get_clock()
        simulated = getattr(clock, "ros_time_is_active", False)
        now_ns = clock.now().nanoseconds
        lag_ns = now_ns - self._due_ns
        jumped = not -self._period_ns < lag_ns < _LONGEST_LAG_NS
        if jumped or not simulated:
            self._due_ns = float(now_ns)
        while self._due_ns <= now_ns:
            self.publish(self.cycle(round(self._due_ns)))
            self._due_ns += self._period_ns


def main() -> int:
    """Run the node."""

    def make() -> Ros2ControlNode:
        try:
            return Ros2ControlNode()
        except ControlError as error:
            raise UserError(str(error)) from None

    return run(make, threads=2)


if __name__ == "__main__":
    sys.exit(main())
