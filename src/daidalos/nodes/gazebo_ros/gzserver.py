"""`gzserver`: a world, its robots and their sensors, under the names of Gazebo's ROS packages."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args

from daidalos.description.errors import DescriptionError
from daidalos.nodes.conversions import time_message
from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError, run

if TYPE_CHECKING:
    from daidalos.description.world import World
    from daidalos.simulation import Simulation
    from daidalos.simulation.samples import Sample

_CLOCK_PERIOD_NS = 10_000_000
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class GzServer(Node):
    """Runs a simulation and connects it with the graph.

    Parameters
    ----------
    world : Path or None
        An SDF file; an empty world with a ground where None.
    paused : bool
        Whether to begin with time standing still.
    **kwargs
        Of `Node`.

    Raises
    ------
    DescriptionError, SimulationError
        When the world cannot be used.
    """

    def __init__(self, world: Path | None = None, paused: bool = False, **kwargs: Any) -> None:
        super().__init__("gazebo", **kwargs)
        from daidalos.nodes.gazebo_ros._pacing import PacedSimulation
        from daidalos.simulation import Simulation

        seed = self.declare_parameter("seed", 0).value
        factor = self.declare_parameter("real_time_factor", 1.0).value
        self._watched = self.declare_parameter("contact_monitor", "").value
        self._outgoing: dict[str, tuple[Any, Any]] = {}
        self._incoming: dict[str, Any] = {}
        self._contacts: dict[str, Any] = {}
        description = _load_world(world)
        simulation = Simulation(description, seed=seed, heard=self._is_heard, warn=self._warn)
        self._paced = PacedSimulation(simulation, self._publish, _CLOCK_PERIOD_NS, factor, self._on_failure)
        self._create_topics()
        self._connect(simulation)
        self._create_services()
        self._performance = self.create_timer(1.0, self._publish_performance, clock=_steady_clock())
        self._paced.start(paused=paused)
        name = world.name if world else "an empty world"
        self.get_logger().info(f"simulating {name}, {len(simulation.models)} models")

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)

    def _create_topics(self) -> None:
        from gazebo_msgs.msg import ContactsState, ModelStates, PerformanceMetrics
        from rosgraph_msgs.msg import Clock

        self._clock_publisher = self.create_publisher(Clock, "/clock", 10)
        self._states = self.create_publisher(ModelStates, "/gazebo/model_states", 10)
        self._metrics = self.create_publisher(PerformanceMetrics, "/performance_metrics", 10)
        self._contacts_publisher = self.create_publisher(ContactsState, "/gazebo/contacts", _LATCHED)

    def _create_services(self) -> None:
        from gazebo_msgs.srv import DeleteEntity, GetModelList, SpawnEntity
        from std_srvs.srv import Empty

        group = MutuallyExclusiveCallbackGroup()
        for kind, name, callback in (
            (SpawnEntity, "/spawn_entity", self._on_spawn),
            (DeleteEntity, "/delete_entity", self._on_delete),
            (GetModelList, "/get_model_list", self._on_list),
            (Empty, "/pause_physics", self._on_pause),
            (Empty, "/unpause_physics", self._on_unpause),
            (Empty, "/reset_simulation", self._on_reset),
            (Empty, "/reset_world", self._on_reset),
        ):
            self.create_service(kind, name, callback, callback_group=group)

    # The simulation's side: called on its thread.

    def _is_heard(self, topic: str) -> bool:
        entry = self._outgoing.get(topic)
        return entry is not None and entry[0].handle.impl.is_heard

    def _publish(self, now_ns: int, samples: list[Sample]) -> None:
        from rosgraph_msgs.msg import Clock

        self._clock_publisher.publish(Clock(clock=time_message(now_ns)))
        transforms = []
        for sample in samples:
            publisher, convert = self._outgoing[sample.topic]
            if sample.topic == "/tf":
                transforms.append(sample)
            else:
                publisher.publish(convert(sample))
        if transforms:
            self._publish_transforms(transforms)
        if self._states.handle.impl.is_heard and now_ns % 20_000_000 < _CLOCK_PERIOD_NS:
            self._publish_states()
        self._publish_contacts()

    def _publish_transforms(self, transforms: list[Any]) -> None:
        from tf2_msgs.msg import TFMessage

        from daidalos.nodes.gazebo_ros._messages import transform

        self._outgoing["/tf"][0].publish(TFMessage(transforms=[transform(one) for one in transforms]))

    def _publish_states(self) -> None:
        from gazebo_msgs.msg import ModelStates

        from daidalos.nodes.gazebo_ros._states import pose_message, twist_message

        simulation = self._paced.simulation
        names = list(simulation.models)
        self._states.publish(
            ModelStates(
                name=names,
                pose=[pose_message(simulation.pose(name)) for name in names],
                twist=[twist_message(*simulation.velocity(name)) for name in names],
            )
        )

    def _publish_contacts(self) -> None:
        """Tell what the watched models have touched, whenever that changes."""
        from daidalos.nodes.gazebo_ros._states import contacts_message

        touches = [(name, touch) for name, monitor in self._contacts.items() for touch in monitor.touches]
        if len(touches) != self._published_touches:
            self._published_touches = len(touches)
            self._contacts_publisher.publish(contacts_message(touches, self._paced.simulation.time_ns))

    _published_touches = 0

    def _on_failure(self, error: Exception) -> None:
        self.get_logger().error(f"{error}; the simulation is paused")

    # The graph's side.

    def _connect(self, simulation: Simulation) -> None:
        """Make a publisher or subscription for every topic of the simulation, and remove those it lost."""
        from daidalos.nodes.gazebo_ros._messages import INCOMING, OUTGOING

        wanted = simulation.publications
        for topic in [topic for topic in self._outgoing if topic not in wanted]:
            self.destroy_publisher(self._outgoing.pop(topic)[0])
        for topic, kind in wanted.items():
            if topic not in self._outgoing:
                entry = OUTGOING[kind]
                self._outgoing[topic] = (self.create_publisher(entry.message(), topic, 10), entry.convert)
        commands = simulation.subscriptions
        for topic in [topic for topic in self._incoming if topic not in commands]:
            self.destroy_subscription(self._incoming.pop(topic))
        for topic, command in commands.items():
            if topic not in self._incoming:
                accepted = INCOMING[command]
                take = self._taker(topic, accepted.convert)
                self._incoming[topic] = self.create_subscription(accepted.message(), topic, take, 10)

    def _taker(self, topic: str, convert: Callable[[Any], Any]) -> Callable[[Any], None]:
        def take(message: Any) -> None:
            command = convert(message)
            self._paced.post(lambda: self._paced.simulation.command(topic, command))

        return take

    def _on_spawn(self, request: Any, response: Any) -> Any:
        try:
            name = self._paced.call(lambda simulation: self._spawn(simulation, request))
        except Exception as error:  # the caller is told; the simulation goes on
            response.success = False
            response.status_message = str(error)
            return response
        response.success = True
        response.status_message = f"SpawnEntity: Successfully spawned entity [{name}]"
        self.get_logger().info(f"spawned '{name}'")
        return response

    def _spawn(self, simulation: Simulation, request: Any) -> str:
        from daidalos.nodes.gazebo_ros._states import pose_of

        pose = pose_of(request.initial_pose)
        if request.reference_frame and request.reference_frame != "world":
            pose = simulation.pose(*request.reference_frame.split("::")[:2]) @ pose
        description = _parse_entity(request.xml)
        name = simulation.spawn(description, request.name or None, pose, request.robot_namespace)
        self._connect(simulation)
        if name == self._watched:
            self._contacts[name] = simulation.monitor_contacts(name, ["ground_plane"])
        return name

    def _on_delete(self, request: Any, response: Any) -> Any:
        try:
            self._paced.call(lambda simulation: self._delete(simulation, request.name))
        except Exception as error:  # the caller is told; the simulation goes on
            response.success = False
            response.status_message = str(error)
            return response
        response.success = True
        response.status_message = f"Successfully deleted entity [{request.name}]"
        return response

    def _delete(self, simulation: Simulation, name: str) -> None:
        simulation.delete(name)
        self._contacts.pop(name, None)
        self._connect(simulation)

    def _on_list(self, request: Any, response: Any) -> Any:
        response.model_names = self._paced.call(lambda simulation: list(simulation.models))
        response.header.stamp = self.get_clock().now().to_msg()
        response.success = True
        return response

    def _on_pause(self, request: Any, response: Any) -> Any:
        self._paced.set_paused(True)
        return response

    def _on_unpause(self, request: Any, response: Any) -> Any:
        self._paced.set_paused(False)
        return response

    def _on_reset(self, request: Any, response: Any) -> Any:
        self._paced.call(lambda simulation: simulation.reset())
        return response

    def _publish_performance(self) -> None:
        from gazebo_msgs.msg import PerformanceMetrics

        message = PerformanceMetrics(real_time_factor=float(self._paced.measured_factor))
        message.header.stamp = time_message(self._paced.simulation.time_ns)
        self._metrics.publish(message)

    def destroy_node(self) -> None:
        """End the simulation and leave the graph."""
        self._paced.stop()
        super().destroy_node()


def _steady_clock() -> Any:
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType

    return Clock(clock_type=ClockType.STEADY_TIME)


def _load_world(path: Path | None) -> World:
    from daidalos.description import sdf
    from daidalos.description.sdf import load

    if path is None:
        return sdf.parse(_EMPTY_WORLD, "empty world")
    return load(path, resolve=package_share)


def _parse_entity(xml: str) -> Any:
    """Read a URDF or SDF document."""
    from daidalos.description import sdf, urdf

    head = xml.lstrip()[:2000]
    if "<robot" in head:
        return urdf.parse(xml, "the entity's description", package_share)
    return sdf.parse_model(xml, "the entity's description", package_share)


_EMPTY_WORLD = """<sdf version="1.6"><world name="default">
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
</world></sdf>"""


def _arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="gzserver", description="Simulate a world.")
    parser.add_argument("world", nargs="?", type=Path, help="an SDF file; an empty world by default")
    parser.add_argument("-u", "--pause", action="store_true", help="begin with time standing still")
    parser.add_argument("--verbose", action="store_true", help="say more")
    parser.add_argument(
        "-s",
        "--server-plugin",
        action="append",
        default=[],
        metavar="PLUGIN",
        help="ignored: the ROS interface is built in",
    )
    return parser.parse_args(list(arguments))


def main() -> int:
    """Run the node."""
    arguments = _arguments(remove_ros_args(sys.argv)[1:])
    if arguments.world and not arguments.world.is_file():
        print(f"error: there is no world file '{arguments.world}'", file=sys.stderr)
        return 2

    def make() -> Node:
        from daidalos.simulation.errors import SimulationError

        try:
            return GzServer(arguments.world, arguments.pause)
        except (DescriptionError, SimulationError) as error:
            raise UserError(str(error)) from None

    return run(make, threads=2)


if __name__ == "__main__":
    sys.exit(main())
