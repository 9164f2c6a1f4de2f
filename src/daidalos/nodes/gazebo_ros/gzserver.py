"""`gzserver`: a world, its robots and their sensors, under the names of Gazebo's ROS packages."""

from __future__ import annotations

import math
import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args

from daidalos.common.rate_gate import RateGate
from daidalos.description.errors import DescriptionError
from daidalos.nodes.gazebo_ros._command_line import parse
from daidalos.nodes.gazebo_ros._worlds import find_world
from daidalos.nodes.runner import UserError, run
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import time_message

if TYPE_CHECKING:
    from daidalos.description.world import World
    from daidalos.samples.sensors import Sample
    from daidalos.simulation import Simulation

_CLOCK_RATE = 100.0
_STATES_RATE = 50.0
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True)
class Start:
    """How a simulation begins, and when it ends.

    Parameters
    ----------
    world : Path or None
        An SDF file; an empty world with a ground where None.
    paused : bool
        Whether to begin with time standing still.
    update_rate : float or None
        Steps in a second of real time [Hz], 0 for as many as can be; None leaves it to the world and the
        parameter ``real_time_factor``.
    steps : int or None
        After how many of them the process ends.
    """

    world: Path | None = None
    paused: bool = False
    update_rate: float | None = None
    steps: int | None = None


class GzServer(Node):
    """Runs a simulation and connects it with the graph.

    Parameters
    ----------
    start : Start
    quit_simulator : callable
        Ends the process.
    **kwargs
        Of `Node`.

    Raises
    ------
    DescriptionError, SimulationError
        When the world cannot be used.
    """

    def __init__(
        self,
        start: Start | None = None,
        quit_simulator: Callable[[], None] = lambda: signal.raise_signal(signal.SIGTERM),
        **kwargs: Any,
    ) -> None:
        super().__init__("gazebo", **kwargs)
        from daidalos.nodes.gazebo_ros._companions import Companions
        from daidalos.nodes.gazebo_ros._host import Host, read_world, wanted_speed
        from daidalos.nodes.gazebo_ros._pacing import PacedSimulation
        from daidalos.simulation import Simulation

        start = start or Start()
        seed = self.declare_parameter("seed", 0).value
        clock_rate = _positive(self.declare_parameter("publish_rate", _CLOCK_RATE))
        described = read_world(start.world)
        factor = self.declare_parameter("real_time_factor", wanted_speed(described.physics)).value
        self._watched = self.declare_parameter("contact_monitor", "").value
        self._outgoing: dict[str, tuple[Any, Any]] = {}
        self._incoming: dict[str, Any] = {}
        self._contacts: dict[str, Any] = {}
        self._offered: dict[str, Any] = {}
        self._warned: set[str] = set()

        def make(description: World) -> Simulation:
            return Simulation(description, seed=seed, has_subscribers=self._has_subscribers, warn=self._warn)

        simulation = make(described)
        if start.update_rate is not None:
            factor = start.update_rate * simulation.step_ns * 1e-9
        self._quit = quit_simulator
        self._end_ns = math.inf if start.steps is None else start.steps * simulation.step_ns
        self._clock_gate, self._states_gate = RateGate(clock_rate), RateGate(_STATES_RATE)
        # Who wants the time seldom does not want commands to wait for it.
        period_ns = max(simulation.step_ns, round(1e9 / max(clock_rate, _CLOCK_RATE)))
        self._paced = PacedSimulation(simulation, self._publish, period_ns, factor, self._on_failure)
        self._host = Host(self._paced, make, self._topics_changed)
        self._companions = Companions(self.context, self._warn)
        self._host.world_path = start.world
        self._create_topics(described)
        self._topics_changed(simulation)
        self._create_services()
        self.add_on_set_parameters_callback(self._on_set_parameters)
        self._performance = self.create_timer(1.0, self._publish_performance, clock=_steady_clock())
        self._paced.start(paused=start.paused)
        name = start.world.name if start.world else "an empty world"
        self.get_logger().info(f"simulating {name}, {len(simulation.models)} models")

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)

    def _warn_once(self, text: str) -> None:
        if text not in self._warned:
            self._warned.add(text)
            self._warn(text)

    def _create_topics(self, world: World) -> None:
        from gazebo_msgs.msg import ContactsState, LinkStates, ModelStates, PerformanceMetrics
        from rosgraph_msgs.msg import Clock

        from daidalos.nodes.gazebo_ros._host import state_namespaces

        self._clock_publisher = self.create_publisher(Clock, "/clock", 10)
        places = state_namespaces(world)
        self._states = [self.create_publisher(ModelStates, f"{place}/model_states", 10) for place in places]
        self._link_states = [self.create_publisher(LinkStates, f"{place}/link_states", 10) for place in places]
        self._metrics = self.create_publisher(PerformanceMetrics, "/performance_metrics", 10)
        self._contacts_publisher = self.create_publisher(ContactsState, "/gazebo/contacts", _LATCHED)

    def _create_services(self) -> None:
        from daidalos.nodes.gazebo_ros._editing_services import EditingServices
        from daidalos.nodes.gazebo_ros._gazebo_services import GazeboServices
        from daidalos.nodes.gazebo_ros._gz_services import GzServices
        from daidalos.nodes.gazebo_ros._standard_services import StandardServices

        group = MutuallyExclusiveCallbackGroup()
        GazeboServices(self, self._host, group)
        GzServices(self, self._host, group)
        EditingServices(self, self._host, group)
        StandardServices(self, self._host, group, self._quit)

    # The simulation's side: called on its thread.

    def _has_subscribers(self, topic: str) -> bool:
        entry = self._outgoing.get(topic)
        return entry is not None and entry[0].handle.has_subscribers

    def _publish(self, now_ns: int, samples: list[Sample]) -> None:
        from rosgraph_msgs.msg import Clock

        if self._clock_gate.is_due(now_ns) or self._paced.paused:
            self._clock_publisher.publish(Clock(clock=time_message(now_ns)))
        transforms = []
        for sample in samples:
            if sample.topic == "/tf":
                transforms.append(sample)
            elif sample.topic in self._outgoing:
                publisher, convert = self._outgoing[sample.topic]
                publisher.publish(convert(sample))
        if transforms:
            self._publish_transforms(transforms)
        if self._states_gate.is_due(now_ns):
            self._publish_states()
        self._publish_contacts()
        self._companions.publish()
        if now_ns >= self._end_ns:
            self._end_ns = math.inf
            self._paced.set_paused(True)
            self._quit()

    def _publish_transforms(self, transforms: list[Any]) -> None:
        from tf2_msgs.msg import TFMessage

        from daidalos.samples.messages import TRANSFORM

        self._outgoing["/tf"][0].publish(TFMessage(transforms=[TRANSFORM.to_message(one) for one in transforms]))

    def _publish_states(self) -> None:
        """Tell where models and links are, to whom it may concern."""
        from gazebo_msgs.msg import LinkStates, ModelStates

        simulation = self._paced.simulation
        models: list[tuple[str, str | None]] = [(name, None) for name in simulation.models]
        _publish_motions(simulation, self._states, ModelStates, models)
        if any(_has_subscribers(publisher) for publisher in self._link_states):
            links: list[tuple[str, str | None]] = [
                (name, link) for name in simulation.models for link in simulation.instance(name).model.links
            ]
            _publish_motions(simulation, self._link_states, LinkStates, links)

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
        from daidalos.samples.messages import MESSAGES, conversion_of
        from daidalos.samples.sensors import ImageSample

        wanted = simulation.publications
        for topic in [topic for topic in self._outgoing if topic not in wanted]:
            self.destroy_publisher(self._outgoing.pop(topic)[0])
        for topic, kind in wanted.items():
            conversion = conversion_of(kind)
            if conversion is None:
                self._warn_once(f"{topic} is not published: no message is known for {kind.__name__}")
            elif topic not in self._outgoing:
                self._outgoing[topic] = (
                    self.create_publisher(conversion.message_class, topic, 10),
                    conversion.to_message,
                )
                self.get_logger().debug(f"publishes {topic}")
        commands = simulation.subscriptions
        for topic in [topic for topic in self._incoming if topic not in commands]:
            self.destroy_subscription(self._incoming.pop(topic))
        for topic, command in commands.items():
            accepted = MESSAGES.get(command)
            if accepted is None:
                self._warn_once(f"{topic} is not listened to: no message is known for {command.__name__}")
            elif topic not in self._incoming:
                take = self._taker(topic, accepted.from_message)
                self._incoming[topic] = self.create_subscription(accepted.message_class, topic, take, 10)
                self.get_logger().debug(f"listens to {topic}")

        self._connect_switches(simulation)
        if ImageSample in wanted.values():
            # The first picture should not stop the world for seconds.
            warm_up_in_background("daidalos.simulation.rendering", self.get_logger())

    def _connect_switches(self, simulation: Simulation) -> None:
        """Offer the services of plugins."""
        from std_srvs.srv import Empty, SetBool

        wanted = simulation.switches
        for name in [name for name in self._offered if name not in wanted]:
            self.destroy_service(self._offered.pop(name))
        for name, switch in wanted.items():
            if name not in self._offered:
                kind = SetBool if switch.fixed is None else Empty
                self._offered[name] = self.create_service(kind, name, self._switcher(name))

    def _switcher(self, name: str) -> Callable[[Any, Any], Any]:
        def answer(request: Any, response: Any) -> Any:
            def work(simulation: Simulation) -> None:
                switch = simulation.switches[name]
                switch.take(bool(request.data) if switch.fixed is None else switch.fixed)

            self._paced.call(work)
            if hasattr(response, "success"):
                response.success = True
            return response

        return answer

    def _taker(self, topic: str, convert: Callable[[Any], Any]) -> Callable[[Any], None]:
        def take(message: Any) -> None:
            command = convert(message)
            self._paced.post(lambda: self._paced.simulation.command(topic, command))

        return take

    def _topics_changed(self, simulation: Simulation) -> None:
        """Follow models that came or went."""
        self._connect(simulation)
        self._companions.follow(simulation)
        for name in [name for name in self._contacts if name not in simulation.models]:
            del self._contacts[name]
        if self._watched in simulation.models and self._watched not in self._contacts:
            self._contacts[self._watched] = simulation.monitor_contacts(self._watched, ["ground_plane"])

    def _on_set_parameters(self, parameters: list[Any]) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            if parameter.name == "real_time_factor":
                if not 0.0 <= parameter.value < math.inf:
                    reason = (
                        f"a speed of {parameter.value:g} can not be; expected a factor, or 0 for as fast as possible"
                    )
                    return SetParametersResult(successful=False, reason=reason)
                self._paced.real_time_factor = float(parameter.value)
        return SetParametersResult(successful=True)

    def _publish_performance(self) -> None:
        from gazebo_msgs.msg import PerformanceMetrics

        message = PerformanceMetrics(real_time_factor=float(self._paced.measured_factor))
        message.header.stamp = time_message(self._paced.simulation.time_ns)
        self._metrics.publish(message)
        if self.count_publishers("/clock") > 1:
            self._warn_once("somebody else tells the time on /clock, too; does another simulator run?")

    def destroy_node(self) -> None:
        """End the simulation and leave the graph."""
        self._paced.stop()
        self._companions.close()
        super().destroy_node()


def _has_subscribers(publisher: Publisher) -> bool:
    return publisher.handle.has_subscribers


def _publish_motions(
    simulation: Simulation, publishers: list[Any], kind: Any, entities: list[tuple[str, str | None]]
) -> None:
    from daidalos.nodes.gazebo_ros._states import pose_message, twist_message

    listening = [publisher for publisher in publishers if _has_subscribers(publisher)]
    if not listening:
        return
    message = kind(
        name=["::".join(filter(None, entity)) for entity in entities],
        pose=[pose_message(simulation.pose(*entity)) for entity in entities],
        twist=[twist_message(*simulation.velocity(*entity)) for entity in entities],
    )
    for publisher in listening:
        publisher.publish(message)


def _steady_clock() -> Any:
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType

    return Clock(clock_type=ClockType.STEADY_TIME)


def _positive(parameter: Any) -> float:
    """Return a parameter's value, which must be more than nothing."""
    if not 0.0 < parameter.value < math.inf:
        raise UserError(f"the parameter {parameter.name} is {parameter.value:g}; expected a positive number")
    return float(parameter.value)


def serve(start: Start, seed: int | None = None, verbose: bool = False) -> int:
    """Run the node until the process is asked to end; return its exit status."""

    def make() -> Node:
        from daidalos.simulation.errors import SimulationError

        overrides: list[Parameter[int]] = [] if seed is None else [Parameter("seed", value=seed)]
        if verbose:
            set_logger_level("gazebo", LoggingSeverity.DEBUG)
        try:
            return GzServer(start, parameter_overrides=overrides)
        except (DescriptionError, SimulationError) as error:
            raise UserError(str(error)) from None

    return run(make, threads=2)


def main() -> int:
    """Run the node."""
    arguments = parse(remove_ros_args(sys.argv)[1:])
    try:
        world = find_world(arguments.world)
    except FileNotFoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return serve(Start(world, arguments.pause, steps=arguments.iters), arguments.seed, arguments.verbose)


if __name__ == "__main__":
    sys.exit(main())
