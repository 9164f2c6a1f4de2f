"""`joint_state_publisher`: states of all joints of a robot, from other publishers and defaults."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.description.joint import Mimic
from daidalos.description.joint_values import JointValues
from daidalos.nodes.description_files import parse_description, read_description
from daidalos.nodes.parameters import declare, declare_one, given_below
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import UserError, program_arguments, run


@dataclass(frozen=True)
class DependentJointParameters(Parameters):
    """Parameters of a joint that follows another one, below ``dependent_joints.<joint>``."""

    parent: str = parameter("", "Joint to follow; none where empty.")
    factor: float = parameter(1.0, "Factor of its position.", takes_integer=True)
    offset: float = parameter(0.0, "Added to its position.", unit="rad or m", takes_integer=True)


@dataclass(frozen=True)
class JointStatePublisherParameters(Parameters):
    """Parameters of ``joint_state_publisher`` and ``joint_state_publisher_gui``.

    ``zeros.<joint>`` is where a joint begins [rad or m].
    """

    rate: float = parameter(10.0, "Rate of joint states.", unit="Hz", above=0.0, read_only=True, takes_integer=True)
    publish_default_positions: bool = parameter(True, "Whether to publish positions that nobody gives.")
    publish_default_velocities: bool = parameter(False, "Whether to publish velocities that nobody gives.")
    publish_default_efforts: bool = parameter(False, "Whether to publish efforts that nobody gives.")
    use_mimic_tags: bool = parameter(True, "Whether joints with <mimic> follow others.", read_only=True)
    use_smallest_joint_limits: bool = parameter(True, "Whether joints stay in their soft limits.", read_only=True)
    source_list: tuple[str, ...] = parameter((), "Topics with states of joints.", read_only=True)
    delta: float = parameter(
        0.0, "How far all joints move at each state.", unit="rad or m", read_only=True, takes_integer=True
    )
    robot_description: str = parameter("", "Description of the robot; from the topic where empty.", read_only=True)


class JointStatePublisher(Node):
    """Node that publishes ``joint_states`` at ``rate`` once it has the robot description.

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
        super().__init__(name, allow_undeclared_parameters=True, **kwargs)
        from sensor_msgs.msg import JointState
        from std_msgs.msg import String

        self._values: JointValues | None = None
        self._publisher = self.create_publisher(JointState, "joint_states", 10)
        self._settings = declare(self, JointStatePublisherParameters, reconfigure=self._reconfigure)
        self._zeros = {
            joint: declare_one(self, f"zeros.{joint}", 0.0, "Where it begins.", unit="rad or m", takes_integer=True)
            for joint in given_below(self, "zeros")
        }
        self._dependents = self._read_dependents()
        for topic in self._settings.source_list:
            self.create_subscription(JointState, topic, self._on_source, 10)
        text = description or self._settings.robot_description
        if text:
            self.read(text, source if description else "robot_description")
        else:
            self.get_logger().info("Waiting for robot_description to be published on the robot_description topic...")
        self.create_subscription(String, "robot_description", self._on_description, LATCHED)
        self._direction: dict[str, float] = {}
        self.create_timer(1.0 / self._settings.rate, self._publish)

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
        try:
            self._values = JointValues(
                robot,
                self._zeros,
                mimics=self._settings.use_mimic_tags,
                dependents=self._dependents,
                soft=self._settings.use_smallest_joint_limits,
            )
        except ValueError as error:
            raise UserError(f"{source}: {error}") from None

    def _reconfigure(self, parameters: JointStatePublisherParameters) -> None:
        self._settings = parameters

    def _read_dependents(self) -> dict[str, Mimic]:
        joints = dict.fromkeys(name.rpartition(".")[0] for name in given_below(self, "dependent_joints"))
        given = {joint: declare(self, DependentJointParameters, f"dependent_joints.{joint}") for joint in joints}
        return {joint: Mimic(one.parent, one.factor, one.offset) for joint, one in given.items() if one.parent}

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
        if self._settings.delta:
            self._wander(values)
        message = JointState(name=list(values.names))
        message.header.stamp = self.get_clock().now().to_msg()
        if self._settings.publish_default_positions:
            message.position = values.all_positions()
        if values.velocities or self._settings.publish_default_velocities:
            message.velocity = values.all_velocities()
        if values.efforts or self._settings.publish_default_efforts:
            message.effort = values.all_efforts()
        self._publisher.publish(message)

    def _wander(self, values: JointValues) -> None:
        """Move every joint by ``delta`` between its limits, to and fro."""
        for each in values.ranges:
            ahead = self._direction.setdefault(each.name, 1.0)
            position = values.positions[each.name] + ahead * self._settings.delta
            if not each.lower <= position <= each.upper:
                self._direction[each.name] = -ahead
                position = min(max(position, each.lower), each.upper)
            values.positions[each.name] = position


def description_from_arguments() -> dict[str, str]:
    """Return the description in the file that the command line names, if it does, and its source."""
    files = program_arguments()
    return {"description": read_description(Path(files[0])), "source": files[0]} if files else {}


def main() -> int:
    """Run the node."""
    return run(lambda: JointStatePublisher(**description_from_arguments()))
