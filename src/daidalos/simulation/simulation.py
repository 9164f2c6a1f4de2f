"""Public interface of the simulator: models are added, removed, moved and changed while it runs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, Vector
from daidalos.description.actors import actor_pose
from daidalos.description.gazebo import model_from_robot
from daidalos.description.link import Inertial
from daidalos.description.robot import Robot
from daidalos.description.scaling import scaled
from daidalos.description.world import Actor, Model
from daidalos.samples.commands import PositionTrajectoryCommand
from daidalos.simulation.conversion.preparation import PreparedMeshes
from daidalos.simulation.engine import Engine
from daidalos.simulation.errors import SimulationError
from daidalos.simulation.forces import JointPush, Push
from daidalos.simulation.instance import Instance, JointView
from daidalos.simulation.trajectory_follower import ActiveTrajectory, TrajectoryFollower


class Simulation(Engine):
    """World with its models, sensors and plugins, stepped by its caller.

    It never sleeps and never looks at the wall clock: pacing belongs to the caller. The same seed and
    the same calls give the same numbers. It is not made for use from several threads at once.

    Parameters
    ----------
    world : World or None
        None is an empty world.
    seed : int
        All random numbers derive from it, each component's from its own name.
    has_subscribers : callable or None
        Returns whether anyone listens to a topic; sensors to which nobody listens do not measure.
    warn : callable or None
        Called with a line for each thing that was left out or changed; None logs them. All lines are kept in
        `warnings`.
    progress : callable or None
        Called with the number of collision meshes that are ready, and of all of them, every two seconds while
        the world is loaded and models are spawned.
    can_draw : callable
        Called with the topic of a camera whose picture is due and the simulated time [ns]; the picture is dropped
        where it returns False, which cameras that wait for a trigger do not ask.

    Raises
    ------
    SimulationError
        When the world cannot be simulated.
    """

    # Models

    def spawn(
        self,
        description: Robot | Model,
        name: str | None = None,
        pose: Pose | None = None,
        namespace: str = "",
        meshes: PreparedMeshes | None = None,
    ) -> str:
        """Add a model to the running world.

        Parameters
        ----------
        description : Robot or Model
        name : str or None
            In the simulation; None takes the description's.
        pose : Pose or None
            Of the model's frame in the world; None takes the description's.
        namespace : str
            Relative topics of its plugins and sensors go below it.
        meshes : PreparedMeshes or None
            What `prepare_meshes` returned for the model, maybe in another thread; None prepares them here.

        Returns
        -------
        str
            The name.

        Raises
        ------
        NameTakenError
            When a model of this name is there already.
        SimulationError, DescriptionError
            When it cannot be simulated; the world is then as it was before.
        """
        model = model_from_robot(description) if isinstance(description, Robot) else description
        name = name or model.name
        if meshes is None:
            self._compilation.prepare((model,), self._progress)
        else:
            self._compilation.take_prepared(meshes)
        self._insert_or_drop(self._add(replace(model, name=name), pose or model.pose, namespace))
        return name

    def add_actor(self, actor: Actor) -> None:
        """Add a figure that follows a script, whose times count from the simulation's beginning.

        Raises
        ------
        NameTakenError
            When a model of this name is there already.
        SimulationError
            When it cannot be simulated; the world is then as it was before.
        """
        self._compilation.prepare((actor.model,), self._progress)
        self._insert_or_drop(self._add(actor.model, actor_pose(actor, 1e-9 * self.time_ns), "", actor))

    def _insert_or_drop(self, instance: Instance) -> None:
        try:
            self._insert(instance)
        except (ValueError, SimulationError) as problem:
            self._drop(instance)
            self._recompile()
            raise SimulationError(f"model {instance.name!r} cannot be simulated: {problem}") from None

    def delete(self, name: str) -> None:
        """Remove a model from the world.

        Raises
        ------
        UnknownNameError
        """
        instance = self.instance(name)
        self._drop(instance)
        self._recompile()

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
        self.physics.changed()
        if instance.build.base is not None:
            # Static models are part of the compiled model.
            instance.build.place_base(pose)
            self._recompile()
        self._soften_overlaps([instance])

    def set_velocity(self, model: str, linear: Iterable[float], angular: Iterable[float]) -> None:
        """Set a model's velocity in world axes [m/s, rad/s]."""
        linear, angular = np.array(list(linear), dtype=float), np.array(list(angular), dtype=float)
        self.instance(model).set_velocity(linear, angular)
        self.physics.changed()

    def set_joint(self, model: str, joint: str, position: float, velocity: float = 0.0) -> None:
        """Set a joint's position [rad, m] and velocity."""
        view = self.joint(model, joint)
        self.physics.data.qpos[view.qpos] = position
        self.physics.data.qvel[view.dof] = velocity
        self.physics.changed()

    def joint(self, model: str, joint: str) -> JointView:
        """Return a view on a joint: its position, velocity and effort."""
        return self.instance(model).joint(joint)

    def follow(self, model: str, course: PositionTrajectoryCommand) -> None:
        """Set joints to the positions of a trajectory in every step until its end, without forces.

        Raises
        ------
        UnknownNameError
        ValueError
            When it has no points, or its times do not rise.
        """
        instance = self.instance(model)
        for name in course.joints:
            instance.joint(name)
        if not len(course.times) or (np.diff(course.times) <= 0).any():
            raise ValueError("the trajectory should have points at times that rise")
        follower = next((c for c in instance.components if isinstance(c, TrajectoryFollower)), None)
        if follower is None:
            follower = TrajectoryFollower(self._setting(instance.model, instance.namespace, "course"))
            self._attach(follower, instance)
        follower.state = ActiveTrajectory(course, self.time_ns)

    def set_joint_properties(
        self, model: str, joint: str, damping: float | None, limits: tuple[float, float] | None
    ) -> None:
        """Change a joint's damping [N m s/rad] and limits [rad, m] while the world runs."""
        self.joint(model, joint)
        self.instance(model).build.set_joint(joint, damping, limits)
        self._recompile()

    def set_link_properties(self, model: str, link: str, inertial: Inertial, gravity: bool) -> None:
        """Change a link's mass properties, and whether gravity acts on it, while the world runs.

        Raises
        ------
        UnknownNameError
        ValueError
            When the mass is not positive.
        """
        instance = self.instance(model)
        instance.link(link)
        if not inertial.mass > 0:
            raise ValueError(f"a mass should be positive, got {inertial.mass:g}")
        instance.build.set_inertial(link, inertial, gravity)
        self._recompile()

    def bounds(self, model: str) -> tuple[Array, Array]:
        """Return the lower and upper corner (3,) of a model's collisions in the world [m].

        Infinite shapes do not count; without any other the corners are the model's origin.
        """
        return self.instance(model).bounds

    def scale(self, model: str, factor: float | Vector) -> None:
        """Scale a model in place; its lowest point keeps its height.

        Parameters
        ----------
        model : str
        factor : float or tuple of 3 floats
            Of all its lengths, or of those along its axes where it has one link.

        Raises
        ------
        UnknownNameError, ValueError, SimulationError
        """
        instance = self.instance(model)
        larger = scaled(instance.model, factor)
        pose, namespace = instance.pose, instance.namespace
        bottom = float(self.bounds(model)[0][2])
        self.delete(model)
        try:
            self.spawn(larger, model, pose, namespace)
            x, y, z = pose.position
            self.set_pose(model, replace(pose, position=(x, y, z + bottom - float(self.bounds(model)[0][2]))))
        except SimulationError:
            self.spawn(instance.model, model, pose, namespace)
            raise

    def set_friction(self, model: str, friction: float, link: str | None = None) -> None:
        """Change the friction of a model's collisions, or of those of one of its links.

        Raises
        ------
        UnknownNameError
        ValueError
            When it is negative.
        """
        if not friction >= 0:
            raise ValueError(f"friction should not be negative, got {friction:g}")
        instance = self.instance(model)
        if link is not None:
            instance.link(link)
        instance.build.set_friction(friction, link)
        self._recompile()

    # Forces

    def push(
        self,
        model: str,
        link: str | None = None,
        force: Vector = (0.0, 0.0, 0.0),
        torque: Vector = (0.0, 0.0, 0.0),
        point: Vector = (0.0, 0.0, 0.0),
        delay_ns: int = 0,
        duration_ns: int | None = None,
        follows: bool = False,
    ) -> None:
        """Apply a force to a link for a time.

        Parameters
        ----------
        model : str
        link : str or None
            None takes the model's first link.
        force, torque : tuple of 3 floats
            In world axes, or in the link's when it `follows` that [N, N m].
        point : tuple of 3 floats
            Where the force acts, in the link's frame [m].
        delay_ns : int
            From now until it begins.
        duration_ns : int or None
            How long; None is until `stop_pushing`.
        follows : bool

        Raises
        ------
        UnknownNameError
        """
        instance = self.instance(model)
        link = link or next(iter(instance.model.links))
        instance.link(link)
        self.forces.add(Push(model, link, force, torque, point, *self._span(delay_ns, duration_ns), follows))

    def push_joint(
        self, model: str, joint: str, effort: float, delay_ns: int = 0, duration_ns: int | None = None
    ) -> None:
        """Apply an effort [N m, N] to a joint for a time; see `push`."""
        self.joint(model, joint)
        self.forces.add(JointPush(model, joint, effort, *self._span(delay_ns, duration_ns)))

    def stop_pushing(self, model: str, part: str) -> None:
        """Remove all pushes on a link or joint of a model."""
        mine = (model, part)
        kept = [p for p in self.forces.pushes if (p.model, p.joint if isinstance(p, JointPush) else p.link) != mine]
        self.forces.clear(keep=kept)

    def _span(self, delay_ns: int, duration_ns: int | None) -> tuple[float, float]:
        start = self.time_ns + max(0, delay_ns)
        return start, math.inf if duration_ns is None else start + duration_ns
