"""Simulation as seen by the services: models, worlds and time control."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.gazebo import model_from_robot
from daidalos.description.joint import JointType
from daidalos.description.world import Model
from daidalos.nodes.gazebo_ros._descriptions import read_entity
from daidalos.nodes.gazebo_ros._entities import find_entity
from daidalos.nodes.gazebo_ros._pacing import PacedSimulation
from daidalos.simulation import Simulation
from daidalos.simulation.conversion.preparation import Progress, prepare_meshes

if TYPE_CHECKING:
    from daidalos.description.robot import Robot
    from daidalos.description.world import World

_MAX_DELETED = 100
_ONE_NUMBER = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)


@dataclass(frozen=True)
class _Deleted:
    """Data to restore a deleted model."""

    model: Model
    pose: Pose
    namespace: str
    joints: dict[str, float]
    was_spawned: bool


class Host:
    """Common base of the services.

    Parameters
    ----------
    paced : PacedSimulation
    make : callable
        Makes a simulation of a world.
    topics_changed : callable
        Called with the simulation, between its steps, when models came or went.
    progress : callable
        Called with the number of collision meshes of a model that are ready, and of all of them.
    is_ending : callable
        Returns whether the process is asked to end, so that no model is prepared any more.
    """

    def __init__(
        self,
        paced: PacedSimulation,
        make: Callable[[World], Simulation],
        topics_changed: Callable[[Simulation], None],
        progress: Progress | None = None,
        is_ending: Callable[[], bool] = lambda: False,
    ) -> None:
        self.paced = paced
        self.world_path: Path | None = None
        self._make = make
        self._changed = topics_changed
        self._progress = progress
        self._is_ending = is_ending
        self._saved: Any = None
        self._stepping = threading.Lock()
        self.spawned: set[str] = set()
        self._deleted: dict[str, _Deleted] = {}

    def spawn(
        self, text: str, name: str | None, pose: Pose, reference: str = "", namespace: str = "", rename: bool = False
    ) -> str:
        """Add a model from a URDF or SDF document; return the name that it got.

        Raises
        ------
        DescriptionError, SimulationError
        """
        return self.insert(read_entity(text), name, pose, reference, namespace, rename)

    def insert(
        self,
        description: Robot | Model,
        name: str | None,
        pose: Pose,
        reference: str = "",
        namespace: str = "",
        rename: bool = False,
    ) -> str:
        """Add a model; return the name that it got. Its meshes are prepared while the simulation goes on.

        Raises
        ------
        DescriptionError, SimulationError
        """
        model = description if isinstance(description, Model) else model_from_robot(description)
        meshes = prepare_meshes((model,), self._progress, self._is_ending)

        def work(simulation: Simulation) -> str:
            goal = pose
            if reference not in ("", "world", "map"):
                entity = find_entity(simulation, reference)
                goal = simulation.pose(entity.model, entity.link) @ pose
            wanted = name or model.name
            unique = _unused(wanted, simulation.models) if rename else wanted
            spawned = simulation.spawn(model, unique, goal, namespace, meshes)
            self.spawned.add(spawned)
            self._changed(simulation)
            return spawned

        return self.paced.call(work)

    def scale(self, name: str, factors: Vector) -> None:
        """Make a model larger or smaller along its axes.

        Raises
        ------
        UnknownNameError, ValueError
        """

        def work(simulation: Simulation) -> None:
            simulation.scale(name, factors)
            self._changed(simulation)

        self.paced.call(work)

    def delete(self, name: str) -> None:
        """Remove a model.

        Raises
        ------
        UnknownNameError
        """

        def work(simulation: Simulation) -> None:
            deleted = self._as_it_is(simulation, name)
            simulation.delete(name)
            self._deleted.pop(name, None)
            self._deleted[name] = deleted
            if len(self._deleted) > _MAX_DELETED:
                del self._deleted[next(iter(self._deleted))]
            self.spawned.discard(name)
            self._changed(simulation)

        self.paced.call(work)

    def _as_it_is(self, simulation: Simulation, name: str) -> _Deleted:
        instance = simulation.instance(name)
        joints = {
            joint: simulation.joint(name, joint).position
            for joint, parts in instance.build.joints.items()
            if parts and instance.model.joints[joint].type in _ONE_NUMBER
        }
        return _Deleted(instance.model, instance.pose, instance.namespace, joints, name in self.spawned)

    def bring_back(self, name: str) -> None:
        """Restore a deleted model at its last pose, at rest.

        Raises
        ------
        LookupError
            When none of this name was deleted from this world.
        SimulationError
        """

        def work(simulation: Simulation) -> None:
            deleted = self._deleted.get(name)
            if deleted is None:
                raise LookupError(f"no model '{name}' was deleted from this world")
            simulation.spawn(deleted.model, name, deleted.pose, deleted.namespace)
            for joint, position in deleted.joints.items():
                simulation.set_joint(name, joint, position)
            del self._deleted[name]
            if deleted.was_spawned:
                self.spawned.add(name)
            self._changed(simulation)

        self.paced.call(work)

    @property
    def known_models(self) -> dict[str, Model]:
        """Descriptions of the models of the world, and of those that were deleted from it, by name."""
        deleted = {name: deleted.model for name, deleted in self._deleted.items()}
        simulation = self.paced.simulation
        return deleted | {name: simulation.instance(name).model for name in simulation.models}

    def delete_spawned(self) -> None:
        """Remove all models that were added after the start."""
        for name in sorted(self.spawned):
            self.delete(name)

    def complete_world(self) -> None:
        """Restore deleted models of the initial world to their initial poses.

        Raises
        ------
        SimulationError
            When another model has a name of them now.
        """

        def work(simulation: Simulation) -> None:
            for name, deleted in list(self._deleted.items()):
                if not deleted.was_spawned:
                    simulation.spawn(deleted.model, name, deleted.model.pose, deleted.namespace)
                    del self._deleted[name]
            self._changed(simulation)

        self.paced.call(work)

    def load_world(self, world: World, path: Path | None = None) -> None:
        """Exchange the world.

        Raises
        ------
        SimulationError
            When it cannot be simulated; the world is then the old one.
        """
        simulation = self._make(world)

        def work(_: Simulation) -> None:
            self.paced.replace(simulation)
            self.spawned.clear()
            self._deleted.clear()
            self._saved = None
            self.world_path = path
            self._changed(simulation)

        self.paced.call(work)

    def step(self, count: int, progress: Callable[[int], bool] = lambda done: True) -> int:
        """Make steps while time stands still; return how many were made.

        Parameters
        ----------
        count : int
        progress : callable
            Takes how many are done; False ends it.
        """
        done = 0
        with self._stepping:
            while done < count and progress(done):
                part = min(count - done, 100)
                self.paced.step(part)
                done += part
        return done

    def save_state(self) -> None:
        """Remember the state."""
        self._saved = self.paced.call(lambda simulation: simulation.save())

    def restore_state(self) -> None:
        """Restore the saved state.

        Raises
        ------
        SimulationError, LookupError
        """
        if self._saved is None:
            raise LookupError("no state was saved")
        self.paced.call(lambda simulation: simulation.restore(self._saved))


def _unused(name: str, taken: tuple[str, ...]) -> str:
    unique, number = name, 0
    while unique in taken:
        unique, number = f"{name}_{number}", number + 1
    return unique
