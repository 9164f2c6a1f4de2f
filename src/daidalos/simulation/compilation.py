"""Compilation of a world's models into one MuJoCo model, which keeps the state of unchanged models."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Heightmap, Mesh
from daidalos.description.joint import Joint
from daidalos.description.world import Model, World
from daidalos.simulation.contracts import Component
from daidalos.simulation.conversion.assets import Assets
from daidalos.simulation.conversion.build import add_model
from daidalos.simulation.conversion.couplings import close_loop
from daidalos.simulation.conversion.options import set_options
from daidalos.simulation.conversion.preparation import PreparedMeshes, Progress
from daidalos.simulation.errors import SimulationError
from daidalos.simulation.forces import Forces
from daidalos.simulation.instance import Instance
from daidalos.simulation.physics import Physics
from daidalos.simulation.stage import Stage


class Compilation:
    """MuJoCo specification of a world, and the model last compiled from it.

    What is added or removed counts from the next `compile` or `recompile` on.

    Parameters
    ----------
    world : World
        Its physics count here; its models are added one by one.
    timestep : float
        Of MuJoCo [s].
    has_subscribers : callable
        Returns whether anyone listens to a topic.
    can_draw : callable
        Returns whether there is time for a camera's picture; see `Simulation`.
    warn : callable
        Called with a line for each thing that is left out or changed.

    Attributes
    ----------
    spec : MjSpec
    instances : dict
        The models by name, in the order in which they came.
    stage : Stage
        What cameras see of them.
    forces : Forces
        What pushes them from outside.
    number : int
        Counts the changes to what there is; a state from before one does not fit after it. What only weighs
        or rubs otherwise is no such change.
    """

    def __init__(
        self,
        world: World,
        timestep: float,
        has_subscribers: Callable[[str], bool],
        can_draw: Callable[[str, int], bool],
        warn: Callable[[str], None],
    ) -> None:
        self.spec: Any = mujoco.MjSpec()
        self._world = world
        self.instances: dict[str, Instance] = {}
        self.stage = Stage(world, warn)
        self.forces = Forces()
        self.number = 0
        self._layout = b""
        self._compiled_alone: Model | None = None
        self._assets = Assets(self.spec)
        self._has_subscribers = has_subscribers
        self._can_draw = can_draw
        self._warn = warn
        self._physics: Physics | None = None
        set_options(self.spec, world, timestep)

    @property
    def physics(self) -> Physics:
        """MuJoCo's model and data, replaced by every compilation."""
        if self._physics is None:
            raise SimulationError("the world is not compiled yet")
        return self._physics

    def prepare(self, models: Iterable[Model], progress: Progress | None = None) -> None:
        """Prepare the collision meshes of models that are about to be added, in parallel; see `prepare_meshes`."""
        self._assets.prepare(models, progress)

    def take_prepared(self, meshes: PreparedMeshes) -> None:
        """Take collision meshes of models that are about to be added; see `prepare_meshes`."""
        self._assets.take_prepared(meshes)

    def add(self, model: Model, pose: Pose, namespace: str, components: list[Component]) -> Instance:
        """Add a model, whose name must be free, with its components.

        Raises
        ------
        SimulationError
            When it cannot be simulated; it is not there then.
        """
        build = add_model(self.spec, self._assets, model, model.name, pose, self._warn)
        instance = Instance(build, namespace, components)
        self.instances[model.name] = instance
        try:
            for component in components:
                component.prepare(build)
            if components:
                build.keep_awake()
        except SimulationError:
            self.remove(instance)
            raise
        return instance

    def attach(self, component: Component, instance: Instance) -> None:
        """Add a component to a model that is compiled already."""
        self.number += 1
        instance.components.append(component)
        component.bind(instance)

    def add_joint(self, joint: Joint) -> None:
        """Add a joint between two models, or between the world and a model."""
        parent = self.spec.worldbody if joint.parent == "world" else self.spec.body(joint.parent)
        close_loop(self.spec, parent, self.spec.body(joint.child), joint, joint.name)

    def remove(self, instance: Instance) -> None:
        """Remove a model."""
        del self.instances[instance.name]
        instance.build.remove()
        self._assets.release(instance.build.assets)

    def compiles_alone(self, instance: Instance) -> bool:
        """Return whether a model is simple and compiles in a world of its own, so that it does in this one as well.

        Simple are models without sensors, plugins and meshes.

        Raises
        ------
        SimulationError
            With MuJoCo's words, in one line.
        """
        model = instance.model
        shapes = (collision.geometry for link in model.links.values() for collision in link.collisions)
        if instance.components or any(isinstance(shape, Mesh | Heightmap) for shape in shapes):
            return False
        nameless = replace(model, name="", pose=Pose())
        if nameless == self._compiled_alone:  # many are often alike
            return True
        spec: Any = mujoco.MjSpec()
        set_options(spec, self._world, float(self.spec.option.timestep))
        add_model(spec, Assets(spec), model, model.name, Pose(), lambda line: None)
        try:
            spec.compile()
        except ValueError as problem:
            raise SimulationError(_one_line(problem)) from None
        self._compiled_alone = nameless
        return True

    def compile(self) -> None:
        """Compile for the first time.

        Raises
        ------
        SimulationError
            With MuJoCo's words, in one line.
        """
        try:
            model = self.spec.compile()
        except ValueError as problem:
            raise SimulationError(_one_line(problem)) from None
        self._bind(model, mujoco.MjData(model))

    def recompile(self) -> None:
        """Compile after changes; unchanged models keep their state.

        Raises
        ------
        SimulationError
            With MuJoCo's words, in one line.
        """
        try:
            model, data = self.spec.recompile(self.physics.model, self.physics.data)
        except ValueError as problem:
            raise SimulationError(_one_line(problem)) from None
        self._bind(model, data)

    def _bind(self, model: Any, data: Any) -> None:
        layout = _layout(model)
        if layout != self._layout:
            self._layout = layout
            self.number += 1
        geoms = {
            model.geom(geom).id: (instance.name, info)
            for instance in self.instances.values()
            for geom, info in instance.build.geoms.items()
        }
        self._physics = Physics(model, data, geoms, self._has_subscribers, self.stage, self.forces, self._can_draw)
        self.forces.bind(self.instances)
        for instance in self.instances.values():
            instance.bind(self._physics)
        self.stage.bind(self.instances.values())


def _layout(model: Any) -> bytes:
    """Return a key that is equal for models with compatible states: names, sizes and attachments."""
    sizes = np.array((model.nq, model.nv, model.na, model.nu, model.nmocap, model.ngeom, model.nsensor, model.narena))
    return b"".join((model.names, sizes.tobytes(), model.body_pos.tobytes(), model.body_quat.tobytes()))


def _one_line(problem: ValueError) -> str:
    """Return the message of MuJoCo's error in one line."""
    return " ".join(str(problem).split()).removeprefix("Error: ")
