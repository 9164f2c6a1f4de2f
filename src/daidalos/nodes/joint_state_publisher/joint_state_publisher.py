"""`joint_state_publisher`: states of all joints of a robot, from other publishers and defaults."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args

from daidalos.description.joint import Mimic
from daidalos.description.joint_values import JointValues
from daidalos.nodes.description_files import parse_description, read_description
from daidalos.nodes.runner import UserError, run

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class JointStatePublisher(Node):
    """Node that publishes ``joint_states`` at ``rate`` once it has the robot description.

    Parameters of the node are those of ROS 2's: ``rate`` [Hz], ``publish_default_positions``,
    ``publish_default_velocities``, ``publish_default_efforts``, ``use_mimic_tags``,
    ``use_smallest_joint_limits``, ``source_list``, ``delta``, ``zeros.<joint>``,
    ``dependent_joints.<joint>.parent`` (``factor``, ``offset``), ``robot_description``.

    Parameters
    ----------
    description : str
        The robot's; without it the node waits for ``robot_description``.
    source : str
        Where the description comes from, for messages about its faults.
    name : str
    **kwargs
        Of `Node`.
    """

    def __init__(
        self,
        description: str = "",
        source: str = "robot_description",
        name: str = "joint_state_publisher",
        **kwargs: Any,
    ) -> None:
        super().__init__(
            name, allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True, **kwargs
        )
        from sensor_msgs.msg import JointState
        from std_msgs.msg import String

        self._values: JointValues | None = None
        self._publisher = self.create_publisher(JointState, "joint_states", 10)
        for source in self._setting("source_list", []):
            self.create_subscription(JointState, source, self._on_source, 10)
        text = description or self._setting("robot_description", "")
        if text:
            self.read(text, source if description else "robot_description")
        else:
            self.get_logger().info("Waiting for robot_description to be published on the robot_description topic...")
        self.create_subscription(String, "robot_description", self._on_description, _LATCHED)
        rate = float(self._setting("rate", 10.0))
        if rate <= 0:
            raise UserError(f"the parameter 'rate' should be positive, got {rate:g}")
        self._step = float(self._setting("delta", 0.0))
        self._direction: dict[str, float] = {}
        self.create_timer(1.0 / rate, self._publish)

    @property
    def values(self) -> JointValues | None:
        """Joint values; None without a robot description."""
        return self._values

    def read(self, text: str, source: str = "robot_description") -> None:
        """Read a robot description from any source.

        Raises
        ------
        UserError
        """
        robot = parse_description(text, source)
        zeros = {name: float(p.value) for name, p in self.get_parameters_by_prefix("zeros").items()}
        self._values = JointValues(
            robot,
            zeros,
            mimics=self._setting("use_mimic_tags", True),
            dependents=self._dependents(),
            soft=self._setting("use_smallest_joint_limits", True),
        )

    def _setting(self, name: str, default: Any) -> Any:
        """Return a parameter; declare it if it is not declared."""
        from rcl_interfaces.msg import ParameterDescriptor

        if not self.has_parameter(name):
            self.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True))
        return self.get_parameter(name).value

    def _dependents(self) -> dict[str, Mimic]:
        given: dict[str, dict[str, Any]] = {}
        for key, parameter in self.get_parameters_by_prefix("dependent_joints").items():
            joint, _, word = key.rpartition(".")
            given.setdefault(joint, {})[word] = parameter.value
        return {
            joint: Mimic(str(words["parent"]), float(words.get("factor", 1.0)), float(words.get("offset", 0.0)))
            for joint, words in given.items()
            if "parent" in words
        }

    def _on_description(self, message: Any) -> None:
        try:
            self.read(message.data)
        except UserError as error:
            self.get_logger().error(str(error))

    def _on_source(self, message: Any) -> None:
        if self._values is not None:
            self._values.take(message.name, message.position, message.velocity, message.effort)

    def _publish(self) -> None:
        from sensor_msgs.msg import JointState

        values = self._values
        if values is None or not values.names:
            return
        if self._step:
            self._wander(values)
        message = JointState(name=list(values.names))
        message.header.stamp = self.get_clock().now().to_msg()
        if self._setting("publish_default_positions", True):
            message.position = values.all_positions()
        if values.velocities or self._setting("publish_default_velocities", False):
            message.velocity = values.all_velocities()
        if values.efforts or self._setting("publish_default_efforts", False):
            message.effort = values.all_efforts()
        self._publisher.publish(message)

    def _wander(self, values: JointValues) -> None:
        """Move every joint by ``delta`` between its limits, to and fro."""
        for each in values.ranges:
            ahead = self._direction.setdefault(each.name, 1.0)
            position = values.positions[each.name] + ahead * self._step
            if not each.lower <= position <= each.upper:
                self._direction[each.name] = -ahead
                position = min(max(position, each.lower), each.upper)
            values.positions[each.name] = position


def description_from_arguments() -> dict[str, str]:
    """Return the description in the file that the command line names, if it does, and its source."""
    files = remove_ros_args(sys.argv)[1:]
    return {"description": read_description(Path(files[0])), "source": files[0]} if files else {}


def main() -> int:
    """Run the node."""
    return run(lambda: JointStatePublisher(**description_from_arguments()))
