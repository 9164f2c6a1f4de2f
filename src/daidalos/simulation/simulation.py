"""The simulation as its users have it: an engine whose world can be pushed, weighed and changed while it runs."""

from __future__ import annotations

import math
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.description.link import Inertial, Surface
from daidalos.description.pose import Vector
from daidalos.description.scaling import scaled
from daidalos.simulation.conversion.contact import set_friction
from daidalos.simulation.conversion.options import physics_step
from daidalos.simulation.courses import Course, CourseFollower
from daidalos.simulation.engine import Engine
from daidalos.simulation.errors import SimulationError
from daidalos.simulation.forces import JointPush, Push
from daidalos.simulation.samples import TrajectoryCommand

Array = NDArray[np.float64]


class Simulation(Engine):
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
        """Push a link for a time.

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
        """Put an effort [N m, N] on a joint for a time; see `push`."""
        self.joint(model, joint)
        self.forces.add(JointPush(model, joint, effort, *self._span(delay_ns, duration_ns)))

    def stop_pushing(self, model: str, part: str) -> None:
        """End all pushes on a link or joint of a model."""
        mine = (model, part)
        kept = [p for p in self.forces.pushes if (p.model, p.joint if isinstance(p, JointPush) else p.link) != mine]
        self.forces.clear(keep=kept)

    def _span(self, delay_ns: int, duration_ns: int | None) -> tuple[float, float]:
        start = self.time_ns + max(0, delay_ns)
        return start, math.inf if duration_ns is None else start + duration_ns

    # Models

    def follow(self, model: str, course: TrajectoryCommand) -> None:
        """Put joints where a trajectory says from now on, in every step until its end, without any force.

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
        follower = next((c for c in instance.components if isinstance(c, CourseFollower)), None)
        if follower is None:
            follower = CourseFollower(self._setting(instance.model, instance.namespace, "course"))
            self._attach(follower, instance)
        follower.memory = Course(course, self.time_ns)

    def set_joint_properties(
        self, model: str, joint: str, damping: float | None, limits: tuple[float, float] | None
    ) -> None:
        """Change a joint's damping [N m s/rad] and limits [rad, m] while the world runs."""
        view = self.joint(model, joint)
        described = self._spec.joint(self.instance(model).build.joints[joint][0])
        if damping is not None:
            described.damping = [damping, 0.0, 0.0]
            self._physics.model.dof_damping[view.dof] = damping
        if limits is not None:
            described.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            described.range = sorted(limits)
        self._recompile()

    def set_link_properties(self, model: str, link: str, inertial: Inertial, gravity: bool) -> None:
        """Change what a link weighs, and whether gravity pulls at it, while the world runs.

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
        """Return the least and the greatest corner (3,) in the world of what is solid of a model [m].

        Infinite shapes do not count; without any other the corners are the model's origin.
        """
        instance = self.instance(model)
        self._physics.refresh_positions()
        compiled, data = self._physics.model, self._physics.data
        origin = np.array(instance.pose.position)
        corners = [origin, origin]
        for name in instance.build.geoms:
            geom = compiled.geom(name).id
            half = compiled.geom_aabb[geom, 3:]
            if compiled.geom_rbound[geom] > 0:
                turn = data.geom_xmat[geom].reshape(3, 3)
                centre, reach = data.geom_xpos[geom] + turn @ compiled.geom_aabb[geom, :3], np.abs(turn) @ half
                if corners[0] is origin:
                    corners = []
                corners += [centre - reach, centre + reach]
        return np.min(corners, axis=0), np.max(corners, axis=0)

    def scale(self, model: str, factor: float | Vector) -> None:
        """Make a model larger or smaller where it stands: its lowest point stays at its height.

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

    # The world

    @property
    def gravity(self) -> Vector:
        """[m/s^2]."""
        x, y, z = (float(value) for value in self._physics.model.opt.gravity)
        return x, y, z

    @gravity.setter
    def gravity(self, gravity: Vector) -> None:
        self._physics.model.opt.gravity[:] = gravity
        self._spec.option.gravity = list(gravity)
        self._physics.wake()
        self._physics.changed()

    def set_step(self, seconds: float) -> None:
        """Change the length of a step.

        Raises
        ------
        ValueError
            When it is not positive.
        """
        if not seconds > 0:
            raise ValueError(f"a step should be longer than 0 s, got {seconds:g}")
        self.step_ns, self._substeps = physics_step(replace(self.world.physics, max_step_size=seconds))
        timestep = self.step_ns / self._substeps * 1e-9
        self._spec.option.timestep = self._physics.model.opt.timestep = timestep

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
        surface = Surface(mu=friction, mu2=friction)
        for name, info in instance.build.geoms.items():
            if link is None or info.link == link:
                set_friction(self._spec.geom(name), surface)
        self._recompile()
