"""A world on MuJoCo that models can enter and leave while it runs: compiled, stepped, saved and restored."""

from __future__ import annotations

import copy
import hashlib
import logging
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.description.actors import actor_pose
from daidalos.description.gazebo import model_from_robot
from daidalos.description.joint import Joint
from daidalos.description.pose import Pose
from daidalos.description.robot import Robot
from daidalos.description.world import Actor, Model, World
from daidalos.simulation.actors import ActorMotion
from daidalos.simulation.assembly import check_world_plugins, make_components
from daidalos.simulation.component import Component, Setting, Switch
from daidalos.simulation.contacts import Contact, ContactMonitor, read_contacts
from daidalos.simulation.conversion.assets import Assets
from daidalos.simulation.conversion.build import add_model
from daidalos.simulation.conversion.couplings import close_loop
from daidalos.simulation.conversion.options import physics_step, set_options
from daidalos.simulation.errors import NameTakenError, SimulationError, UnknownNameError
from daidalos.simulation.forces import Forces
from daidalos.simulation.instance import Instance, JointView
from daidalos.simulation.physics import Physics
from daidalos.simulation.samples import Sample
from daidalos.simulation.schedule import Schedule
from daidalos.simulation.stage import Stage
from daidalos.simulation.state import State, memories_of, remember

Array = NDArray[np.float64]

_log = logging.getLogger(__name__)
_MONITOR_PERIOD_NS = 10_000_000


class Engine:
    """A world with its models, sensors and plugins, stepped by its caller.

    It never sleeps and never looks at the wall clock: pacing belongs to the caller. The same seed and
    the same calls give the same numbers. It is not made for use from several threads at once.

    Parameters
    ----------
    world : World or None
        None is an empty world.
    seed : int
        All random numbers derive from it, each component's from its own name.
    heard : callable or None
        Tells whether anyone listens to a topic; sensors to which nobody listens do not measure.
    warn : callable or None
        Takes a line for each thing that was left out or changed; None logs them. All lines are kept in
        `warnings`.

    Raises
    ------
    SimulationError
        When the world can not be simulated.
    """

    def __init__(
        self,
        world: World | None = None,
        seed: int = 0,
        heard: Callable[[str], bool] | None = None,
        warn: Callable[[str], None] | None = None,
    ) -> None:
        self.world = World() if world is None else world
        self.seed = seed
        self.time_ns = 0
        self.warnings: list[str] = []
        self.heard = heard
        self._warn_user = _log.warning if warn is None else warn
        self.stage = Stage(self.world, self._warn)
        self.forces = Forces()
        self._instances: dict[str, Instance] = {}
        self._schedule = Schedule()
        self._monitors: list[ContactMonitor] = []
        self._compilations = 0
        self._goal_ns = 0
        self._spec: Any = mujoco.MjSpec()
        self._assets = Assets(self._spec)
        self.step_ns, substeps = physics_step(self.world.physics)
        self._substeps = substeps
        set_options(self._spec, self.world, self.step_ns / substeps * 1e-9)
        for line in self.world.warnings:
            self._warn(line)
        check_world_plugins(self.world, self._warn)
        self._compile_first()

    @property
    def physics(self) -> Physics:
        """MuJoCo's model and data; replaced whenever models come or go."""
        return self._physics

    # Models

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models in the world, in the order in which they came."""
        return tuple(self._instances)

    def spawn(
        self,
        description: Robot | Model,
        name: str | None = None,
        pose: Pose | None = None,
        namespace: str = "",
    ) -> str:
        """Put a model into the running world.

        Parameters
        ----------
        description : Robot or Model
        name : str or None
            In the simulation; None takes the description's.
        pose : Pose or None
            Of the model's frame in the world; None takes the description's.
        namespace : str
            Relative topics of its plugins and sensors go below it.

        Returns
        -------
        str
            The name.

        Raises
        ------
        NameTakenError
            When a model of this name is there already.
        SimulationError, DescriptionError
            When it can not be simulated; the world is then as it was before.
        """
        model = model_from_robot(description) if isinstance(description, Robot) else description
        name = name or model.name
        instance = self._add(replace(model, name=name), pose or model.pose, namespace)
        try:
            self._recompile()
            self._start(instance)
        except (ValueError, SimulationError) as problem:
            self._drop(instance)
            self._recompile()
            raise SimulationError(f"model {name!r} can not be simulated: {_one_line(problem)}") from None
        return name

    def delete(self, name: str) -> None:
        """Take a model out of the world.

        Raises
        ------
        UnknownNameError
        """
        instance = self.instance(name)
        self._drop(instance)
        self._recompile()

    def instance(self, name: str) -> Instance:
        """Return a model in the simulation.

        Raises
        ------
        UnknownNameError
        """
        try:
            return self._instances[name]
        except KeyError:
            raise UnknownNameError("model", name, self._instances) from None

    def pose(self, model: str, link: str | None = None) -> Pose:
        """Return the true pose in the world of a model's frame, or of one of its links.

        Raises
        ------
        UnknownNameError
        """
        instance = self.instance(model)
        return instance.pose if link is None else instance.link(link).pose

    def velocity(self, model: str, link: str | None = None) -> tuple[Array, Array]:
        """Return the true linear [m/s] and angular [rad/s] velocity of a link, in world axes.

        Parameters
        ----------
        model : str
        link : str or None
            None takes the model's first link.
        """
        instance = self.instance(model)
        return instance.link(link or next(iter(instance.model.links))).velocity()

    def set_pose(self, model: str, pose: Pose) -> None:
        """Move a model, static or not; its velocity stays."""
        instance = self.instance(model)
        instance.set_pose(pose)
        self._physics.changed()
        if instance.build.base is not None:
            # What stands in the world is built into the compiled model.
            instance.build.place_base(pose)
            self._recompile()

    def set_velocity(self, model: str, linear: Iterable[float], angular: Iterable[float]) -> None:
        """Set a model's velocity in world axes [m/s, rad/s]."""
        linear, angular = np.array(list(linear), dtype=float), np.array(list(angular), dtype=float)
        self.instance(model).set_velocity(linear, angular)
        self._physics.changed()

    def set_joint(self, model: str, joint: str, position: float, velocity: float = 0.0) -> None:
        """Put a joint somewhere [rad, m], with a speed."""
        view = self.joint(model, joint)
        self._physics.data.qpos[view.qpos] = position
        self._physics.data.qvel[view.dof] = velocity
        self._physics.changed()

    def joint(self, model: str, joint: str) -> JointView:
        """Return a view on a joint: its position, velocity and effort."""
        return self.instance(model).joint(joint)

    # Time

    def step(self, count: int = 1) -> list[Sample]:
        """Run a number of steps of `step_ns` and return what was said, ordered by stamp."""
        return self._run(self.time_ns + count * self.step_ns)

    def advance(self, duration_ns: int) -> list[Sample]:
        """Run for a time and return what was said, ordered by stamp.

        Parameters
        ----------
        duration_ns : int
            What is left of it after the last whole step is added to the next call.

        Raises
        ------
        SimulationError
            When the physics diverge.
        """
        self._goal_ns += duration_ns
        return self._run(self._goal_ns)

    def command(self, topic: str, command: Any) -> int:
        """Hand a command to whoever subscribes to a topic; return how many did.

        Raises
        ------
        TypeError
            When a subscriber wants another class of command.
        """
        takers = [sub for c in self._components() for name, sub in c.subscriptions.items() if name == topic]
        for taker in takers:
            if not isinstance(command, taker.type):
                raise TypeError(f"{topic} takes {taker.type.__name__}, got {type(command).__name__}")
            taker.take(command)
        return len(takers)

    @property
    def publications(self) -> dict[str, type[Sample]]:
        """Topics that samples may have, with their classes."""
        return {topic: cls for c in self._components() for topic, cls in c.publications.items()}

    @property
    def subscriptions(self) -> dict[str, type]:
        """Topics that commands are taken from, with their classes."""
        return {topic: sub.type for c in self._components() for topic, sub in c.subscriptions.items()}

    @property
    def switches(self) -> dict[str, Switch]:
        """Services that plugins offer."""
        return {name: switch for c in self._components() for name, switch in c.switches.items()}

    # State

    def contacts(self) -> list[Contact]:
        """Return what touches now, one entry for each pair of collisions."""
        return read_contacts(self._physics)

    def monitor_contacts(self, model: str, ignore: Iterable[str] = ()) -> ContactMonitor:
        """Watch from now on what a model touches, however briefly.

        Parameters
        ----------
        model : str
        ignore : iterable of str
            Names of models that do not count, such as the ground.
        """
        monitor = ContactMonitor(self.instance(model), frozenset(ignore))
        monitor.bind(self._physics)
        self._monitors.append(monitor)
        return monitor

    def save(self) -> State:
        """Return the state; it can be restored as long as the same models are there."""
        memories = memories_of(self._components())
        # All of MuJoCo's data, since sleeping models are no part of its smaller states.
        physics = copy.copy(self._physics.data)
        return State(self.time_ns, physics, self._compilations, self._schedule.save(), memories, self.forces.pushes)

    def restore(self, state: State) -> None:
        """Go back to a saved state, bit for bit.

        Raises
        ------
        SimulationError
            When models came or went since.
        """
        if state.compilation != self._compilations:
            raise SimulationError("models came or went since the state was saved")
        mujoco.mj_copyData(self._physics.data, self._physics.model, state.physics)
        remember(self._components(), state.memories)
        self._schedule.restore(dict(state.clocks))
        self.time_ns = self._goal_ns = state.time_ns
        self.forces.clear(keep=state.pushes)
        self._physics.changed()

    def reset(self, keep_time: bool = False) -> None:
        """Put every model back to where it came in, with fresh sensors and plugins.

        Parameters
        ----------
        keep_time : bool
            Go on from now instead of from zero.
        """
        now_ns = self.time_ns if keep_time else 0
        mujoco.mj_resetData(self._physics.model, self._physics.data)
        self._physics.data.time = now_ns * 1e-9
        self.time_ns = self._goal_ns = now_ns
        self.forces.clear()
        self._physics.changed()
        self._schedule.restart(now_ns)
        for instance in self._instances.values():
            instance.place_joints()
            for component in instance.components:
                component.random = component.setting.stream()
                component.memory = component.start()

    # Inside

    def _add(self, model: Model, pose: Pose, namespace: str, actor: Actor | None = None) -> Instance:
        if model.name in self._instances:
            raise NameTakenError(model.name)
        for line in model.warnings:
            self._warn(line)

        def setting(name: str) -> Setting:
            return self._setting(model, namespace, name)

        components = make_components(model, setting)
        if actor is not None:
            components.append(ActorMotion(actor, setting("script")))
        build = add_model(self._spec, self._assets, model, model.name, pose, self._warn)
        instance = Instance(build, namespace, components)
        self._instances[model.name] = instance
        try:
            for component in components:
                component.prepare(build)
            if components:
                build.keep_awake()
        except SimulationError:
            self._drop(instance)
            raise
        return instance

    def _compile_first(self) -> None:
        for model in self.world.models:
            self._add(model, model.pose, "")
        for actor in self.world.actors:
            self._add(actor.model, actor_pose(actor, 0.0), "", actor)
        for joint in self.world.joints.values():
            self._add_joint_between_models(joint)
        try:
            model = self._spec.compile()
        except ValueError as problem:
            raise SimulationError(f"the world can not be simulated: {_one_line(problem)}") from None
        self._bind(model, mujoco.MjData(model))
        for instance in self._instances.values():
            self._start(instance)

    def _add_joint_between_models(self, joint: Joint) -> None:
        parent = self._spec.worldbody if joint.parent == "world" else self._spec.body(joint.parent)
        close_loop(self._spec, parent, self._spec.body(joint.child), joint, joint.name)

    def _recompile(self) -> None:
        """Compile after models came or went; everything that stays keeps its state."""
        self._bind(*self._spec.recompile(self._physics.model, self._physics.data))

    def _bind(self, model: Any, data: Any) -> None:
        self._compilations += 1
        geoms = {
            model.geom(geom).id: (instance.name, info)
            for instance in self._instances.values()
            for geom, info in instance.build.geoms.items()
        }
        self._physics = Physics(model, data, geoms, self._is_heard, self.stage, self.forces)
        self.forces.bind(self._instances)
        for instance in self._instances.values():
            instance.bind(self._physics)
        self.stage.bind(self._instances.values())
        for monitor in self._monitors:
            monitor.bind(self._physics)

    def _start(self, instance: Instance) -> None:
        instance.place_joints()
        self._physics.changed()
        for component in instance.components:
            component.memory = component.start()
            self._schedule.add(component, self.time_ns)

    def _drop(self, instance: Instance) -> None:
        del self._instances[instance.name]
        self._schedule.remove(instance.components)
        self._monitors = [monitor for monitor in self._monitors if monitor.instance is not instance]
        instance.build.remove()
        self._assets.release(instance.build.assets)

    def _attach(self, component: Component, instance: Instance) -> None:
        """Let a component act on a model that runs already; states saved before can not be restored."""
        self._compilations += 1
        instance.components.append(component)
        component.bind(instance)
        component.memory = component.start()
        self._schedule.add(component, self.time_ns)

    def _components(self) -> list[Component]:
        return [component for instance in self._instances.values() for component in instance.components]

    def _run(self, goal_ns: int) -> list[Sample]:
        substep_ns = self.step_ns // self._substeps
        samples: list[Sample] = []
        while self.time_ns + substep_ns <= goal_ns:
            due_ns = self._schedule.next_due()
            until_ns = goal_ns if due_ns is None else min(goal_ns, due_ns)
            count = max(1, min(-(-(until_ns - self.time_ns) // substep_ns), (goal_ns - self.time_ns) // substep_ns))
            if self._monitors:
                count = min(count, max(1, _MONITOR_PERIOD_NS // substep_ns))
            if self.forces.pushes:
                change_ns = self.forces.next_change(self.time_ns)
                count = 1 if change_ns <= self.time_ns + count * substep_ns else count
            self.forces.apply(self._physics, self.time_ns)
            self._physics.step(count)
            self.time_ns += count * substep_ns
            for monitor in self._monitors:
                monitor.look(self._physics.data, self.time_ns)
            for component in self._schedule.due(self.time_ns):
                samples.extend(component.update(self.time_ns))
        self._goal_ns = max(goal_ns, self._goal_ns)
        return samples

    def _is_heard(self, topic: str) -> bool:
        return self.heard is None or self.heard(topic)

    def _setting(self, model: Model, namespace: str, name: str) -> Setting:
        stream = partial(self._stream, f"{model.name}::{name}")
        return Setting(model, model.name, namespace, self.world, stream, self._warn)

    def _stream(self, name: str) -> np.random.Generator:
        """Return random numbers that depend on the seed and a name alone."""
        digest = hashlib.sha256(name.encode()).digest()
        key = [int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4)]
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=key))

    def _warn(self, line: str) -> None:
        self.warnings.append(line)
        self._warn_user(line)


def _one_line(problem: Exception) -> str:
    return " ".join(str(problem).split()).removeprefix("Error: ")
