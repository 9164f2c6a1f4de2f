"""Engine of a running world: compilation, steps, topics, and saving and restoring of its state."""

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

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.actors import actor_pose
from daidalos.description.world import Actor, Model, World
from daidalos.samples.sensors import Contact, Sample
from daidalos.simulation.actors import ActorMotion
from daidalos.simulation.applied_forces import apply_forces
from daidalos.simulation.assembly import check_world_plugins, make_components
from daidalos.simulation.compilation import Compilation
from daidalos.simulation.contacts import ContactMonitor, read_contacts
from daidalos.simulation.contracts import Component, ComponentContext, Switch
from daidalos.simulation.conversion.options import physics_step
from daidalos.simulation.conversion.preparation import Progress
from daidalos.simulation.errors import NameTakenError, SimulationError, UnknownNameError
from daidalos.simulation.forces import Forces
from daidalos.simulation.instance import Instance
from daidalos.simulation.overlaps import PERIOD_NS as OVERLAP_PERIOD_NS
from daidalos.simulation.overlaps import Overlaps
from daidalos.simulation.physics import Physics
from daidalos.simulation.schedule import Schedule
from daidalos.simulation.stage import Stage
from daidalos.simulation.state import State, copy_states, restore_states

_log = logging.getLogger(__name__)
_MONITOR_PERIOD_NS = 10_000_000


class Engine:
    """Running world: its time, topics and state.

    Its parameters are those of `Simulation`, which adds what users do to models.
    """

    def __init__(
        self,
        world: World | None = None,
        seed: int = 0,
        has_subscribers: Callable[[str], bool] | None = None,
        warn: Callable[[str], None] | None = None,
        progress: Progress | None = None,
        can_draw: Callable[[str, int], bool] = lambda topic, now_ns: True,
    ) -> None:
        self.world = World() if world is None else world
        self.seed = seed
        self.time_ns = 0
        self.warnings: list[str] = []
        self.has_subscribers = has_subscribers
        self._warn_user = _log.warning if warn is None else warn
        self._schedule = Schedule()
        self._monitors: list[ContactMonitor] = []
        self._waiting: dict[str, Instance] = {}
        self._overlaps = Overlaps()
        self._goal_ns = 0
        self._progress = progress
        self.step_ns, self._substeps = physics_step(self.world.physics)
        self._compilation = Compilation(self.world, self._timestep, self._has_subscribers, can_draw, self._warn)
        for line in self.world.warnings:
            self._warn(line)
        check_world_plugins(self.world, self._warn)
        self._populate()

    @property
    def physics(self) -> Physics:
        """MuJoCo's model and data, replaced whenever models are added or removed."""
        if self._waiting:
            self._add_waiting()
        return self._compilation.physics

    @property
    def stage(self) -> Stage:
        """Visible content for cameras: models, lights and sky."""
        return self.physics.stage

    @property
    def forces(self) -> Forces:
        """External forces."""
        return self._compilation.forces

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models in the world, in the order of insertion."""
        return tuple(self._compilation.instances)

    def instance(self, name: str) -> Instance:
        """Return a model in the simulation.

        Raises
        ------
        UnknownNameError
        """
        if name in self._waiting:
            self._add_waiting()
        try:
            return self._compilation.instances[name]
        except KeyError:
            raise UnknownNameError("model", name, self._compilation.instances) from None

    @property
    def components(self) -> list[Component]:
        """Sensors and plugins of all models."""
        instances = self._compilation.instances.values()
        return [component for instance in instances for component in instance.components]

    # Time

    def step(self, count: int = 1) -> list[Sample]:
        """Run a number of steps of `step_ns` and return the samples, sorted by stamp."""
        return self._run(self.time_ns + count * self.step_ns)

    def advance(self, duration_ns: int) -> list[Sample]:
        """Run for a time and return the samples, sorted by stamp.

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

    @property
    def gravity(self) -> Vector:
        """Gravity [m/s^2]."""
        x, y, z = (float(value) for value in self.physics.model.opt.gravity)
        return x, y, z

    @gravity.setter
    def gravity(self, gravity: Vector) -> None:
        self.physics.model.opt.gravity[:] = gravity
        self._compilation.spec.option.gravity = list(gravity)
        self.physics.wake()
        self.physics.changed()

    def set_step(self, seconds: float) -> None:
        """Set the length of a step.

        Raises
        ------
        ValueError
            When it is not positive.
        """
        if not seconds > 0:
            raise ValueError(f"a step should be longer than 0 s, got {seconds:g}")
        self.step_ns, self._substeps = physics_step(replace(self.world.physics, max_step_size=seconds))
        self._compilation.spec.option.timestep = self.physics.model.opt.timestep = self._timestep

    # Topics and services

    def command(self, topic: str, command: Any) -> int:
        """Pass a command to the subscribers of a topic; return their number.

        Raises
        ------
        TypeError
            When a subscriber wants another class of command.
        """
        takers = [sub for c in self.components for name, sub in c.subscriptions.items() if name == topic]
        for taker in takers:
            if not isinstance(command, taker.type):
                raise TypeError(f"{topic} takes {taker.type.__name__}, got {type(command).__name__}")
            taker.take(command)
        return len(takers)

    @property
    def publications(self) -> dict[str, type[Sample]]:
        """Topics of samples, with their classes."""
        return {topic: cls for c in self.components for topic, cls in c.publications.items()}

    @property
    def subscriptions(self) -> dict[str, type]:
        """Topics of commands, with their classes."""
        return {topic: sub.type for c in self.components for topic, sub in c.subscriptions.items()}

    @property
    def switches(self) -> dict[str, Switch]:
        """Services of plugins."""
        return {name: switch for c in self.components for name, switch in c.switches.items()}

    # State

    def contacts(self) -> list[Contact]:
        """Return the current contacts, one entry for each pair of collisions."""
        return read_contacts(self.physics)

    def monitor_contacts(self, model: str, ignore: Iterable[str] = ()) -> ContactMonitor:
        """Start to record the contacts of a model, however brief.

        Parameters
        ----------
        model : str
        ignore : iterable of str
            Names of models that do not count, such as the ground.
        """
        monitor = ContactMonitor(self.instance(model), frozenset(ignore))
        monitor.bind(self.physics)
        self._monitors.append(monitor)
        return monitor

    def save(self) -> State:
        """Return the state; it can be restored as long as the same models exist."""
        component_states = copy_states(self.components)
        # All of MuJoCo's data, since sleeping models are no part of its smaller states.
        physics = copy.copy(self.physics.data)
        return State(
            self.time_ns, physics, self._compilation.number, self._schedule.save(), component_states, self.forces.pushes
        )

    def restore(self, state: State) -> None:
        """Restore a saved state, bit for bit.

        Raises
        ------
        SimulationError
            When models came or went since.
        """
        if self._waiting or state.compilation != self._compilation.number:
            raise SimulationError("models were added or removed since the state was saved")
        mujoco.mj_copyData(self.physics.data, self.physics.model, state.physics)
        restore_states(self.components, state.component_states)
        self._schedule.restore(dict(state.clocks))
        self.time_ns = self._goal_ns = state.time_ns
        self.forces.clear(keep=state.pushes)
        self.physics.changed()

    def reset(self, keep_time: bool = False) -> None:
        """Reset all models to their initial poses, with newly started sensors and plugins.

        Parameters
        ----------
        keep_time : bool
            Go on from now instead of from zero.
        """
        now_ns = self.time_ns if keep_time else 0
        mujoco.mj_resetData(self.physics.model, self.physics.data)
        self.physics.data.time = now_ns * 1e-9
        self.time_ns = self._goal_ns = now_ns
        self.forces.clear()
        self.physics.changed()
        self._schedule.restart(now_ns)
        for instance in self._compilation.instances.values():
            instance.place_joints()
            for component in instance.components:
                component.random = component.context.stream()
                component.state = component.start()

    # Inside

    def _populate(self) -> None:
        self._compilation.prepare((*self.world.models, *(actor.model for actor in self.world.actors)), self._progress)
        for model in self.world.models:
            self._add(model, model.pose, "")
        for actor in self.world.actors:
            self._add(actor.model, actor_pose(actor, 0.0), "", actor)
        for joint in self.world.joints.values():
            self._compilation.add_joint(joint)
        try:
            self._compilation.compile()
        except SimulationError as problem:
            raise SimulationError(f"the world cannot be simulated: {problem}") from None
        for instance in self._compilation.instances.values():
            self._start(instance)

    def _add(self, model: Model, pose: Pose, namespace: str, actor: Actor | None = None) -> Instance:
        if model.name in self._compilation.instances:
            raise NameTakenError(model.name)
        for line in model.warnings:
            self._warn(line)
        context = partial(self._setting, model, namespace)
        components = make_components(model, context)
        if actor is not None:
            components.append(ActorMotion(actor, context("script")))
        return self._compilation.add(model, pose, namespace, components)

    def _recompile(self) -> None:
        """Compile after models were added or removed; all others keep their state."""
        self._compilation.recompile()
        waiting, self._waiting = self._waiting, {}
        for instance in waiting.values():
            instance.place_joints()
        for monitor in self._monitors:
            monitor.bind(self.physics)
        if self._overlaps:
            self._overlaps.soften(self.physics, ())

    def _insert(self, instance: Instance) -> None:
        """Compile the world with a new model, or leave that to the next use of the world where the model is simple."""
        if self._compilation.compiles_alone(instance):
            self._waiting[instance.name] = instance
        else:
            self._recompile()
            self._start(instance)
            self._soften_overlaps([instance])

    def _add_waiting(self) -> None:
        """Compile the world with the models that wait for it."""
        waiting = dict(self._waiting)
        try:
            self._recompile()
        except SimulationError as problem:
            for instance in waiting.values():
                self._drop(instance)
            self._recompile()
            names = ", ".join(waiting)
            raise SimulationError(f"{names} cannot be simulated and are removed: {problem}") from None
        self._soften_overlaps(waiting.values())

    def _start(self, instance: Instance) -> None:
        instance.place_joints()
        self.physics.changed()
        for component in instance.components:
            self._begin(component)

    def _soften_overlaps(self, instances: Iterable[Instance]) -> None:
        """Make models that were placed inside others leave them slowly."""
        names = {instance.name for instance in instances}
        self._overlaps.soften(self.physics, {geom for geom, (name, _) in self.physics.geoms.items() if name in names})

    def _begin(self, component: Component) -> None:
        component.state = component.start()
        self._schedule.add(component, self.time_ns)

    def _attach(self, component: Component, instance: Instance) -> None:
        self._compilation.attach(component, instance)
        self._begin(component)

    def _drop(self, instance: Instance) -> None:
        self._waiting.pop(instance.name, None)
        self._compilation.remove(instance)
        self._schedule.remove(instance.components)
        self._monitors = [monitor for monitor in self._monitors if monitor.instance is not instance]

    @property
    def _timestep(self) -> float:
        """MuJoCo's time step [s]."""
        return self.step_ns / self._substeps * 1e-9

    def _run(self, goal_ns: int) -> list[Sample]:
        substep_ns = self.step_ns // self._substeps
        samples: list[Sample] = []
        while self.time_ns + substep_ns <= goal_ns:
            due_ns = self._schedule.next_due()
            until_ns = goal_ns if due_ns is None else min(goal_ns, due_ns)
            count = max(1, min(-(-(until_ns - self.time_ns) // substep_ns), (goal_ns - self.time_ns) // substep_ns))
            if self._monitors:
                count = min(count, max(1, _MONITOR_PERIOD_NS // substep_ns))
            if self._overlaps:
                count = min(count, max(1, OVERLAP_PERIOD_NS // substep_ns))
            if self.forces.pushes:
                change_ns = self.forces.next_change(self.time_ns)
                count = 1 if change_ns <= self.time_ns + count * substep_ns else count
            apply_forces(self.forces, self.physics, self._compilation.instances, self.time_ns)
            self.physics.step(count)
            self.time_ns += count * substep_ns
            if self._overlaps:
                self._overlaps.update(self.physics)
            for monitor in self._monitors:
                monitor.record(self.physics.data, self.time_ns)
            for component in self._schedule.due(self.time_ns):
                samples.extend(component.update(self.time_ns))
        self._goal_ns = max(goal_ns, self._goal_ns)
        return samples

    def _has_subscribers(self, topic: str) -> bool:
        return self.has_subscribers is None or self.has_subscribers(topic)

    def _setting(self, model: Model, namespace: str, name: str) -> ComponentContext:
        stream = partial(_random_stream, self.seed, f"{model.name}::{name}")
        return ComponentContext(model, model.name, namespace, self.world, stream, self._warn)

    def _warn(self, line: str) -> None:
        self.warnings.append(line)
        self._warn_user(line)


def _random_stream(seed: int, name: str) -> np.random.Generator:
    """Return a random generator that depends only on a seed and a name."""
    digest = hashlib.sha256(name.encode()).digest()
    key = [int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4)]
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
