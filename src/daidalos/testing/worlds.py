"""Simulated worlds under test: their robots, obstacles, people and friction."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.common.suggestions import hint
from daidalos.nodes.gazebo_ros.built_in import find_model_file, find_world_file
from daidalos.testing.graph import PoseValue
from daidalos.testing.kept_world import running_server
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.signals import FIRST_S, Requirement, Signal

if TYPE_CHECKING:
    from daidalos.simulation import Simulation
    from daidalos.testing.crowds import Crowd

T = TypeVar("T")

_PERIOD_S = 0.05
"""Period [s] at which true poses and contacts are looked at."""

_GROUND = ("ground_plane", "ground")
_WAIT_S = 60.0
_HEIGHT = 1.75
_RADIUS = 0.25


class Robot:
    """Robot or model of the world.

    Parameters
    ----------
    world : World
    name : str
    namespace : str
        Of its topics.
    """

    def __init__(self, world: World, name: str, namespace: str = "") -> None:
        self.world = world
        self.name = name
        self.namespace = namespace.strip("/")
        self._pose: Signal | None = None
        self._touched: Signal | None = None
        self._publisher: Any = None

    @property
    def pose(self) -> Signal:
        """True pose in the world, as a signal of `PoseValue`."""
        if self._pose is None:
            self._pose = self.world.signal(
                f"the pose of '{self.name}'", lambda simulation: PoseValue.of(simulation.pose(self.name))
            )
        return self._pose

    @property
    def position(self) -> PoseValue:
        """True pose in the world now."""
        return self.world.read(lambda simulation: PoseValue.of(simulation.pose(self.name)))

    @property
    def speed(self) -> Signal:
        """True horizontal speed [m/s], as a signal."""

        def read(simulation: Simulation) -> float:
            linear, _ = simulation.velocity(self.name)
            return math.hypot(float(linear[0]), float(linear[1]))

        return self.world.signal(f"the speed of '{self.name}'", read)

    def distance_to(self, x: float, y: float) -> Signal:
        """Return the true horizontal distance [m] to a point, as a signal."""
        return self.pose.map(lambda pose: pose.distance_to(x, y), f"distance to ({x:g}, {y:g})")

    def touched(self, ignore: Sequence[str] = _GROUND) -> Signal:
        """Return the names of the models that it has touched so far, as a signal of tuples.

        Parameters
        ----------
        ignore : sequence of str
            Models that do not count, such as the ground.
        """
        if self._touched is None:
            monitor = self.world.read(lambda simulation: simulation.monitor_contacts(self.name, ignore))
            self._touched = self.world.signal(
                f"what '{self.name}' has touched",
                lambda simulation: tuple(dict.fromkeys(touch.other_model for touch in monitor.touches)),
            )
        return self._touched

    def never_touches(self, *, ignore: Sequence[str] = _GROUND) -> Requirement:
        """Require that it touches nothing from now on.

        Parameters
        ----------
        ignore : sequence of str
            Models that do not count, such as the ground.
        """
        return self.touched(ignore).always(equals=())

    def drive(self, linear: float = 0.0, angular: float = 0.0, *, seconds: float | None = None) -> None:
        """Publish a velocity on the robot's ``cmd_vel``.

        Parameters
        ----------
        linear : float
            Forwards [m/s].
        angular : float
            To the left [rad/s].
        seconds : float, optional
            Stop after so long, and return then; otherwise return at once.
        """
        from geometry_msgs.msg import Twist

        scenario = self.world.scenario
        topic = f"/{self.namespace}/cmd_vel" if self.namespace else "/cmd_vel"
        if self._publisher is None:
            self._publisher = scenario.node.create_publisher(Twist, topic, 10)
            if not scenario.wait_for_graph(lambda: self._publisher.get_subscription_count() > 0, FIRST_S):
                raise ScenarioFailure(f"nobody subscribes to '{topic}'")
        twist = Twist()
        twist.linear.x, twist.angular.z = float(linear), float(angular)
        self._publisher.publish(twist)
        if seconds is not None:
            scenario.sleep(seconds)
            self._publisher.publish(Twist())

    def move(self, x: float, y: float, z: float | None = None, yaw: float = 0.0) -> None:
        """Place it elsewhere in the world [m, rad]; it keeps its height where `z` is None."""

        def work(simulation: Simulation) -> None:
            height = simulation.pose(self.name).position[2] if z is None else z
            simulation.set_pose(self.name, Pose.from_xyz_rpy((x, y, height), (0.0, 0.0, yaw)))

        self.world.change(work)

    def push(self, force: tuple[float, float, float], *, seconds: float = 0.1, link: str | None = None) -> None:
        """Apply a force [N, world axes] to a link, its first where None, for some time [s]."""
        self.world.change(
            lambda simulation: simulation.push(self.name, link, force=force, duration_ns=round(1e9 * seconds))
        )

    def set_friction(self, friction: float, *, link: str | None = None) -> None:
        """Change the friction coefficient of its collisions, or of those of one link."""
        self.world.change(lambda simulation: simulation.set_friction(self.name, friction, link))

    def remove(self) -> None:
        """Remove it from the world."""
        self.world.host.delete(self.name)


class World:
    """Simulated world, started by `load` or by a launch file of the test.

    Parameters
    ----------
    scenario : Scenario
    nodes : Nodes
    """

    def __init__(self, scenario: Scenario, nodes: Nodes) -> None:
        self.scenario = scenario
        self._nodes = nodes
        self._robots: dict[str, Robot] = {}

    def load(self, world: str | Path = "", *, speed: float = 1.0) -> None:
        """Start the simulator with a world.

        Parameters
        ----------
        world : str or Path
            An SDF file, or the name of a built-in one, such as ``arena``; an empty world where empty.
        speed : float
            Simulated seconds of the world in a second of the run.

        Raises
        ------
        UserError
            When there is no such world.
        """
        words = [] if not world else [str(find_world_file(str(world)))]
        parameters = {"seed": self.scenario.seed, "real_time_factor": speed}
        self._nodes.run("gazebo_ros", "gzserver", *words, name="gazebo", parameters=parameters)
        self._wait_for_server()

    @property
    def host(self) -> Any:
        """The simulator as its services see it.

        Raises
        ------
        ScenarioFailure
            When no simulator starts.
        """
        return self._wait_for_server().host

    @property
    def is_running(self) -> bool:
        """Whether a simulator runs."""
        return running_server() is not None

    @property
    def simulation(self) -> Simulation:
        """The simulation itself; to be read only, as it goes on meanwhile. See `change`."""
        simulation: Simulation = self.host.paced.simulation
        return simulation

    def read(self, function: Callable[[Simulation], T]) -> T:
        """Return what a function reads of the simulation."""
        return function(self.simulation)

    def change(self, function: Callable[[Simulation], T]) -> T:
        """Call a function that changes the simulation, between two of its steps; return its result."""
        result: T = self.host.paced.call(function)
        return result

    def signal(self, name: str, function: Callable[[Simulation], Any]) -> Signal:
        """Return a signal of what a function reads of the simulation, twenty times a second."""
        signal = Signal(self.scenario, name)
        signal.push(self.read(function))
        scheduler = self.scenario.run.scheduler

        def look() -> None:
            while True:
                scheduler.sleep_until(scheduler.now_ns + round(1e9 * _PERIOD_S))
                server = running_server()  # not `read`, which would raise what the test itself is to be told
                if server is not None:
                    signal.push(function(server.host.paced.simulation))

        scheduler.spawn(look, self.scenario.program, name)
        return signal

    def spawn(
        self,
        model: str | Path,
        name: str = "",
        *,
        x: float = 0.0,
        y: float = 0.0,
        z: float = 0.01,
        yaw: float = 0.0,
        namespace: str = "",
    ) -> Robot:
        """Add a robot or model to the world.

        Parameters
        ----------
        model : str or Path
            A URDF, xacro or SDF file, or the name of a built-in robot: ``waffle`` or ``burger``.
        name : str
            In the world; that of the file where empty.
        x, y, z, yaw : float
            Where it stands [m, rad].
        namespace : str
            Of its topics.

        Raises
        ------
        UserError
            When there is no such model.
        """
        from daidalos.nodes.description_files import read_description

        path = find_model_file(str(model))
        wanted = name or (str(model) if str(model) != str(path) else path.name.partition(".")[0])
        pose = Pose.from_xyz_rpy((x, y, z), (0.0, 0.0, yaw))
        added = self.host.spawn(read_description(path), wanted, pose, "", namespace)
        return self._robot(added, namespace)

    def __getitem__(self, name: str) -> Robot:
        """Return a robot or model that is in the world.

        Raises
        ------
        UserError
            With similar names.
        """
        known = self.simulation.models
        if name not in known:
            raise UserError(f"there is no model '{name}' in the world{hint(name, known)}")
        return self._robot(name, "")

    def wait_for(self, name: str, within: float = _WAIT_S) -> Robot:
        """Wait until a model is in the world, such as one that a launch file spawns; return it.

        Raises
        ------
        ScenarioFailure
        """
        __tracebackhide__ = True
        until = self.scenario.now + within
        while name not in self.simulation.models:
            if self.scenario.now >= until:
                known = self.simulation.models
                raise ScenarioFailure(f"there was no model '{name}' within {within:g} s{hint(name, known)}")
            self.scenario.sleep(_PERIOD_S)
        return self._robot(name, "")

    def box(
        self, name: str, *, x: float, y: float, size: tuple[float, float, float] = (0.5, 0.5, 0.5), yaw: float = 0.0
    ) -> Robot:
        """Put a box of some edges [m] on the ground, heavy enough to stay."""
        from daidalos.description.geometry import Box

        return self._obstacle(name, Box(size), size[2], x, y, yaw)

    def walk(self, name: str, path: Sequence[tuple[float, float]], *, speed: float = 1.0, loop: bool = True) -> Robot:
        """Add a person who walks along a path [m] from now on, and pushes what is in the way.

        Parameters
        ----------
        name : str
        path : sequence of (float, float)
        speed : float
            [m/s].
        loop : bool
            Whether the person walks back to the first point and begins again.

        Raises
        ------
        UserError
            When the path has fewer than two points, or the speed is not positive.
        """
        from daidalos.description.geometry import Cylinder
        from daidalos.description.world import Actor

        if len(path) < 2 or not speed > 0.0:
            raise UserError(
                f"a person walks along 2 points or more at a positive speed, got {len(path)}, {speed:g} m/s"
            )

        def work(simulation: Simulation) -> None:
            model = _simple_model(name, Cylinder(_RADIUS, _HEIGHT), _HEIGHT, is_scripted=True)
            waypoints = _waypoints([*path, path[0]] if loop else list(path), speed)
            simulation.add_actor(
                Actor(name, model, waypoints=waypoints, loop=loop, delay_start=1e-9 * simulation.time_ns)
            )

        self.change(work)
        return self._robot(name, "")

    def crowd(
        self, count: int, *, speed: tuple[float, float] = (0.6, 1.4), avoid: Sequence[str] = (), name: str = "person"
    ) -> Crowd:
        """Add people who walk about from now on, and avoid each other, obstacles and robots; see `Crowd`.

        Parameters
        ----------
        count : int
        speed : tuple of two floats
            Slowest and fastest of them [m/s].
        avoid : sequence of str
            Robots that they keep away from, and never walk into.
        name : str
            Of their models, with a number after it.

        Raises
        ------
        UserError
            When there are none, the speeds are not two rising positive numbers, or there is no room.
        """
        from daidalos.description.geometry import Cylinder
        from daidalos.testing.crowds import PERSON_RADIUS, STEP_S, Crowd, ground_of

        if count < 1 or not 0.0 < speed[0] <= speed[1]:
            raise UserError(f"a crowd has people, and rising positive speeds, got {count}, {speed[0]:g}, {speed[1]:g}")
        names = [f"{name}_{number}" for number in range(count)]
        robots = [self[one].name for one in avoid]
        ground = self.read(lambda simulation: ground_of(simulation, [*robots, *_GROUND]))
        if ground.places().shape[0] < 40 * count:
            raise UserError(f"there is no room for {count} people in this world")
        clear = np.array([(one.x, one.y) for one in (self[robot].position for robot in robots)], dtype=float)
        crowd = Crowd(names, ground, robots, speed, self.scenario.seed, clear)
        for one, (x, y) in zip(names, crowd.positions.tolist(), strict=True):
            model = _simple_model(one, Cylinder(PERSON_RADIUS, _HEIGHT), _HEIGHT, is_scripted=True)
            self.host.insert(model, one, Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, 0.0)))
        scheduler = self.scenario.run.scheduler

        def go() -> None:
            while True:
                scheduler.sleep_until(scheduler.now_ns + round(1e9 * STEP_S))
                self.change(crowd.step)

        scheduler.spawn(go, self.scenario.program, f"{name}s")
        return crowd

    def _obstacle(self, name: str, shape: Any, height: float, x: float, y: float, yaw: float) -> Robot:
        model = _simple_model(name, shape, height, is_scripted=False)
        self.host.insert(model, name, Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw)))
        return self._robot(name, "")

    def _robot(self, name: str, namespace: str) -> Robot:
        return self._robots.setdefault(name, Robot(self, name, namespace))

    def _wait_for_server(self) -> Any:
        __tracebackhide__ = True
        if not self.scenario.wait_for_graph(self._is_ready, _WAIT_S):
            raise ScenarioFailure("no simulator has started; load a world, or launch a file that starts one")
        return running_server()

    def _is_ready(self) -> bool:
        server = self._nodes.started.get("gazebo")
        if server is not None and not server.is_alive:
            raise ScenarioFailure("the simulator has ended; its output says why")
        return running_server() is not None


def _simple_model(name: str, shape: Any, height: float, *, is_scripted: bool) -> Any:
    """Return a model of one shape that stands on the ground."""
    from daidalos.description.link import Collision, Inertial, Link, Material, Visual
    from daidalos.description.world import Model

    raised = Pose((0.0, 0.0, 0.5 * height))
    link = Link(
        "link",
        inertial=Inertial(mass=200.0, pose=raised, inertia=(50.0, 0.0, 0.0, 50.0, 0.0, 50.0)),
        visuals=(Visual(shape, raised, Material(color=(0.8, 0.45, 0.2, 1.0))),),
        collisions=(Collision(shape, raised, name="collision"),),
    )
    return Model(name, links={"link": link}, static=is_scripted, scripted=is_scripted)


def _waypoints(path: list[tuple[float, float]], speed: float) -> tuple[Any, ...]:
    """Return the waypoints of a walk; the person faces the way."""
    from daidalos.description.world import Waypoint

    time = 0.0
    found = []
    for (x1, y1), (x2, y2) in itertools.pairwise(path):
        yaw = math.atan2(y2 - y1, x2 - x1)
        found.append(Waypoint(time, Pose.from_xyz_rpy((x1, y1, 0.0), (0.0, 0.0, yaw))))
        time += max(math.hypot(x2 - x1, y2 - y1) / speed, 0.01)
        found.append(Waypoint(time - 0.005, Pose.from_xyz_rpy((x2, y2, 0.0), (0.0, 0.0, yaw))))
    return tuple(found)
