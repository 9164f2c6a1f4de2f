"""`ros2_control_node`: controllers on the hardware that a robot's description names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

from daidalos.common.extensions import ExtensionError
from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import ControlError
from daidalos.control.extensions import hardware_class, substitute_unknown
from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.ros2_control import HardwareInfo, read_hardware
from daidalos.nodes.controller_manager._manager_node import ControllerManagerNode
from daidalos.nodes.packages import package_share
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import UserError, fail, run

_MAX_LAG_NS = 1_000_000_000
"""Delay after which cycles that were missed are left out."""


class Ros2ControlNode(ControllerManagerNode):
    """Node that waits for ``robot_description``, then runs at ``update_rate`` of its clock."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("controller_manager", **kwargs)
        if self.settings.robot_description:
            self._begin(self.settings.robot_description)
        else:
            from std_msgs.msg import String

            self.create_subscription(String, "robot_description", self._on_description, LATCHED)
            self.get_logger().info("waiting for the topic 'robot_description'")

    def _on_description(self, message: Any) -> None:
        if self.manager is not None:
            self.get_logger().warning("another robot description came and is ignored")
            return
        try:
            self._begin(message.data)
        except UserError as error:
            # Without hardware there are no services, for which spawners would wait without end.
            self.get_logger().fatal(str(error))
            fail()

    def _begin(self, text: str) -> None:
        try:
            robot = urdf.parse(text, "robot_description", package_share)
            context = HardwareContext(self.update_rate, self.warn)
            hardware = [self._hardware(info, context) for info in read_hardware(robot)]
            if not hardware:
                raise ControlError("the robot description has no <ros2_control> element")
            self.start(robot, hardware)
        except (DescriptionError, ControlError, ExtensionError) as error:
            raise UserError(str(error)) from None
        self._cycles = _Cycles(self.update_rate)
        self.create_timer(1.0 / self.update_rate, self._tick, callback_group=MutuallyExclusiveCallbackGroup())

    def _hardware(self, info: HardwareInfo, context: HardwareContext) -> Hardware:
        known = substitute_unknown(info, self.warn)
        return hardware_class(known)(known, context)

    def _tick(self) -> None:
        """Run a cycle; as many as are due where the time is a simulator's, which goes in larger steps."""
        clock = self.get_clock()
        now_ns = clock.now().nanoseconds
        due = self._cycles.until(now_ns) if getattr(clock, "ros_time_is_active", False) else (now_ns,)
        for instant in due:
            self.publish(self.cycle(instant))


class _Cycles:
    """Instants at a rate, counted from the first time that is asked for.

    Parameters
    ----------
    rate : float
        [Hz].
    """

    def __init__(self, rate: float) -> None:
        self._period = 1e9 / rate
        self._start_ns, self._count = -1, 0

    def until(self, now_ns: int) -> Iterator[int]:
        """Yield the new instants up to now [ns]; a time jump restarts the sequence."""
        last = self._at(self._count - 1)
        if self._start_ns < 0 or not last <= now_ns < last + _MAX_LAG_NS:
            self._start_ns, self._count = now_ns, 0
        while self._at(self._count) <= now_ns:
            yield self._at(self._count)
            self._count += 1

    def _at(self, count: int) -> int:
        return self._start_ns + round(count * self._period)


def main() -> int:
    """Run the node."""

    def make() -> Ros2ControlNode:
        try:
            return Ros2ControlNode()
        except ControlError as error:
            raise UserError(str(error)) from None

    return run(make, threads=2)
