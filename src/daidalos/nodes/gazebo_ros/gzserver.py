"""`gzserver`: simulation of a world with its robots and sensors, under the names of Gazebo's ROS packages."""

from __future__ import annotations

import math
import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar
from weakref import WeakSet

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.rate_gate import RateGate
from daidalos.description.errors import DescriptionError
from daidalos.nodes.asset_folders import record_model_path
from daidalos.nodes.gazebo_ros._command_line import parse
from daidalos.nodes.gazebo_ros._worlds import find_world
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import UserError, program_arguments, run
from daidalos.samples.fields import time_message

if TYPE_CHECKING:
    from daidalos.description.world import World
    from daidalos.nodes.gazebo_ros._host import Host
    from daidalos.samples.sensors import Sample
    from daidalos.simulation import Simulation

_CLOCK_RATE = 100.0

RUNNING: WeakSet[GzServer] = WeakSet()
"""Servers of this process, for those who share it with them in lock-step."""


@dataclass(frozen=True)
class Start:
    """Initial settings of a simulation, and its end.

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


@dataclass(frozen=True)
class GzServerParameters(Parameters):
    """Parameters of ``gzserver``."""

    seed: int = parameter(0, "Seed of all noise.", read_only=True)
    publish_rate: float = parameter(
        _CLOCK_RATE, "Rate of ``/clock``.", unit="Hz", above=0.0, below=math.inf, read_only=True
    )
    real_time_factor: float = parameter(
        1.0,
        "Simulated seconds in a second, 0 for as many as can be; by default the world's.",
        minimum=0.0,
        below=math.inf,
    )
    contact_monitor: str = parameter("", "Model whose contacts are published.", read_only=True)


class GzServer(Node):
    """Node that runs a simulation and connects it to the graph.

    Parameters
    ----------
    start : Start or callable
        Called, where it is a function, when the node can declare parameters.
    quit_simulator : callable
        Ends the process.
    **kwargs
        Of `Node`.

    Raises
    ------
    DescriptionError, SimulationError
        When the world cannot be used.
    """

    THREADS: ClassVar[int] = 2
    """Callbacks that run at a time: commands go on while a service waits for the simulation."""

    def __init__(
        self,
        start: Start | Callable[[], Start] | None = None,
        quit_simulator: Callable[[], None] = lambda: signal.raise_signal(signal.SIGTERM),
        **kwargs: Any,
    ) -> None:
        super().__init__("gazebo", **kwargs)
        from gazebo_msgs.msg import PerformanceMetrics
        from rosgraph_msgs.msg import Clock

        from daidalos.nodes.gazebo_ros._companions import Companions
        from daidalos.nodes.gazebo_ros._connections import Connections
        from daidalos.nodes.gazebo_ros._descriptions import read_world, wanted_speed
        from daidalos.nodes.gazebo_ros._host import Host
        from daidalos.nodes.gazebo_ros._pacing import PacedSimulation
        from daidalos.nodes.gazebo_ros._state_topics import StateTopics
        from daidalos.simulation import Simulation

        start = (start() if callable(start) else start) or Start()
        described = read_world(start.world)
        by_default = {"real_time_factor": wanted_speed(described.physics)}
        settings = declare(self, GzServerParameters, reconfigure=self._reconfigure, defaults=by_default)
        clock_rate, factor = settings.publish_rate, settings.real_time_factor
        self._connections = connections = Connections(self)

        def make(description: World) -> Simulation:
            return Simulation(
                description,
                seed=settings.seed,
                has_subscribers=connections.has_subscribers,
                warn=self._warn,
                progress=self._report_loading,
                can_draw=connections.has_time_to_draw,
            )

        simulation = make(described)
        if start.update_rate is not None:
            factor = start.update_rate * simulation.step_ns * 1e-9
        self._quit = quit_simulator
        self._end_ns = math.inf if start.steps is None else start.steps * simulation.step_ns
        self._clock_gate = RateGate(clock_rate)
        # Who wants the time seldom does not want commands to wait for it.
        period_ns = max(simulation.step_ns, round(1e9 / max(clock_rate, _CLOCK_RATE)))
        self._paced = connections.paced = PacedSimulation(
            simulation, self._publish, period_ns, factor, self._on_failure
        )
        self._host = Host(self._paced, make, self._topics_changed, self._report_loading, lambda: not self.context.ok())
        self._companions = Companions(self.context, self._warn)
        self._host.world_path = start.world
        self._clock_publisher = self.create_publisher(Clock, "/clock", 10)
        self._metrics = self.create_publisher(PerformanceMetrics, "/performance_metrics", 10)
        self._states = StateTopics(self, described, settings.contact_monitor)
        self._topics_changed(simulation)
        self._create_services()
        self._performance = self.create_timer(1.0, self._publish_performance, clock=_steady_clock())
        self._paced.start(paused=start.paused)
        RUNNING.add(self)
        name = start.world.name if start.world else "an empty world"
        self.get_logger().info(f"simulating {name}, {len(simulation.models)} models")

    @property
    def host(self) -> Host:
        """The simulation as the services see it."""
        return self._host

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)

    def _report_loading(self, done: int, count: int) -> None:
        self.get_logger().info(f"preparing the meshes of collisions, kept for the next start: {done} of {count}")

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

    def _publish(self, now_ns: int, samples: list[Sample]) -> None:
        from rosgraph_msgs.msg import Clock

        is_due = self._clock_gate.is_due(now_ns) or self._paced.paused
        if is_due and self._clock_publisher.handle.has_subscribers:
            self._clock_publisher.publish(Clock(clock=time_message(now_ns)))
        self._connections.publish(samples)
        self._states.publish(self._paced.simulation, now_ns)
        self._companions.publish()
        if now_ns >= self._end_ns:
            self._end_ns = math.inf
            self._paced.set_paused(True)
            self._quit()

    def _on_failure(self, error: Exception) -> None:
        self.get_logger().error(f"{error}; the simulation is paused")

    # The graph's side.

    def _topics_changed(self, simulation: Simulation) -> None:
        """Follow models that came or went."""
        self._connections.follow(simulation)
        self._companions.follow(simulation)
        self._states.follow(simulation)

    def _reconfigure(self, parameters: GzServerParameters) -> None:
        self._paced.real_time_factor = parameters.real_time_factor

    def _publish_performance(self) -> None:
        from gazebo_msgs.msg import PerformanceMetrics

        message = PerformanceMetrics(real_time_factor=float(self._paced.measured_factor))
        message.header.stamp = time_message(self._paced.simulation.time_ns)
        self._metrics.publish(message)
        if self.count_publishers("/clock") > 1:
            self._connections.warn_once("somebody else tells the time on /clock, too; does another simulator run?")

    def destroy_node(self) -> None:
        """End the simulation and leave the graph."""
        self._paced.stop()
        self._companions.close()
        super().destroy_node()


def _steady_clock() -> Any:
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType

    return Clock(clock_type=ClockType.STEADY_TIME)


def serve(start: Start, seed: int | None = None, verbose: bool = False) -> int:
    """Run the node until the process is asked to end; return its exit status."""

    def make() -> Node:
        from daidalos.simulation.errors import SimulationError

        record_model_path()
        overrides: list[Parameter[int]] = [] if seed is None else [Parameter("seed", value=seed)]
        if verbose:
            set_logger_level("gazebo", LoggingSeverity.DEBUG)
        try:
            return GzServer(start, parameter_overrides=overrides)
        except (DescriptionError, SimulationError) as error:
            raise UserError(str(error)) from None

    return run(make, threads=GzServer.THREADS)


def main() -> int:
    """Run the node."""
    arguments = parse(program_arguments())
    try:
        world = find_world(arguments.world)
    except FileNotFoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return serve(Start(world, arguments.pause, steps=arguments.iters), arguments.seed, arguments.verbose)
