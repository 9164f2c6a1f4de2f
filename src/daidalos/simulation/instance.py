"""Model in a running simulation: its links and joints as indices of MuJoCo's arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.world import Model
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.errors import SimulationError, UnknownNameError
from daidalos.simulation.physics import Physics

if TYPE_CHECKING:
    from daidalos.simulation.contracts import Component


@dataclass(frozen=True)
class LinkView:
    """View of a link in the arrays."""

    physics: Physics
    body: int

    @property
    def pose(self) -> Pose:
        """Current pose of the link in the world."""
        self.physics.refresh_positions()
        data = self.physics.data
        x, y, z = data.xpos[self.body].tolist()
        qw, qx, qy, qz = data.xquat[self.body].tolist()
        return Pose((x, y, z), (qx, qy, qz, qw))

    @property
    def rotation(self) -> Array:
        """Current rotation (3, 3) of the link in the world."""
        self.physics.refresh_positions()
        rotation: Array = self.physics.data.xmat[self.body].reshape(3, 3)
        return rotation

    def velocity(self) -> tuple[Array, Array]:
        """Return linear velocity of the link's origin and angular velocity, in world axes."""
        self.physics.refresh_velocities()
        motion = np.zeros(6)
        mujoco.mj_objectVelocity(self.physics.model, self.physics.data, mujoco.mjtObj.mjOBJ_XBODY, self.body, motion, 0)
        return motion[3:], motion[:3]

    def inertial_motion(self) -> tuple[Array, Array, Array]:
        """Return angular velocity and specific force at the link's origin, in the link's axes.

        Returns
        -------
        rate : array (3,)
            Turn rate [rad/s].
        force : array (3,)
            Acceleration less gravity [m/s^2].
        spin_up : array (3,)
            Angular acceleration [rad/s^2].
        """
        self.physics.refresh_loads()
        model, data = self.physics.model, self.physics.data
        motion, change = np.zeros(6), np.zeros(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, self.body, motion, 1)
        mujoco.mj_objectAcceleration(model, data, mujoco.mjtObj.mjOBJ_XBODY, self.body, change, 1)
        return motion[:3], change[3:], change[:3]


@dataclass(frozen=True)
class JointView:
    """View of a joint's first degree of freedom in the arrays."""

    physics: Physics
    name: str
    qpos: int
    dof: int

    @property
    def position(self) -> float:
        """Position [rad] or [m]; full turns are counted."""
        return float(self.physics.data.qpos[self.qpos])

    @property
    def velocity(self) -> float:
        """Velocity [rad/s] or [m/s]."""
        return float(self.physics.data.qvel[self.dof])

    @property
    def effort(self) -> float:
        """Effort of the joint's actuators in the last step [N m] or [N]."""
        return float(self.physics.data.qfrc_actuator[self.dof])


class Instance:
    """Model in the simulation.

    Parameters
    ----------
    build : ModelBuild
    namespace : str
        Relative topics of its components go below it.
    components : list of Component
    """

    def __init__(self, build: ModelBuild, namespace: str, components: list[Component]) -> None:
        self.build = build
        self.name = build.name
        self.namespace = namespace
        self.components = components
        self._physics: Physics | None = None

    @property
    def model(self) -> Model:
        """Description of the model."""
        return self.build.model

    @property
    def physics(self) -> Physics:
        """MuJoCo's arrays, once the model is compiled."""
        if self._physics is None:
            raise SimulationError(f"model {self.name!r} is not compiled yet")
        return self._physics

    def bind(self, physics: Physics) -> None:
        """Update the indices after a compilation."""
        self._physics = physics
        for component in self.components:
            component.bind(self)

    def has_subscribers(self, topic: str) -> bool:
        """Return whether anyone listens to a topic."""
        return self.physics.has_subscribers(topic)

    def can_draw(self, topic: str, now_ns: int) -> bool:
        """Return whether there is time for the picture of a camera at a simulated time [ns]."""
        return self.physics.can_draw(topic, now_ns)

    def link(self, name: str) -> LinkView:
        """Return a link by its name in the description.

        Raises
        ------
        UnknownNameError
        """
        if name not in self.build.bodies:
            raise UnknownNameError("link", name, self.build.bodies)
        return LinkView(self.physics, self.physics.body(self.build.scoped(name)))

    def joint(self, name: str) -> JointView:
        """Return a movable joint by its name in the description.

        Raises
        ------
        UnknownNameError
        """
        if not self.build.joints.get(name):
            raise UnknownNameError("joint", name, [n for n, added in self.build.joints.items() if added])
        joint = self.physics.model.joint(self.build.joints[name][0])
        return JointView(self.physics, name, int(joint.qposadr[0]), int(joint.dofadr[0]))

    def actuator(self, name: str) -> int:
        """Return the index of an actuator in MuJoCo's controls."""
        return int(self.physics.model.actuator(name).id)

    @property
    def pose(self) -> Pose:
        """Current pose of the model's frame in the world; it moves with its first free link."""
        root = next(iter(self.build.free), None)
        if root is not None:
            return self.link(root).pose @ self.model.links[root].pose.inverse
        self.physics.refresh_positions()
        if not self.build.roots:
            return self.model.pose
        return LinkView(self.physics, self.physics.body(self.name)).pose

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper corner (3,) of the model's collisions in the world [m].

        Infinite shapes do not count; without any other the corners are the model's origin.
        """
        model, data = self.physics.model, self.physics.data
        self.physics.refresh_positions()
        corners = []
        for geom in (model.geom(name).id for name in self.build.geoms):
            if model.geom_rbound[geom] > 0:
                turn = data.geom_xmat[geom].reshape(3, 3)
                centre = data.geom_xpos[geom] + turn @ model.geom_aabb[geom, :3]
                reach = np.abs(turn) @ model.geom_aabb[geom, 3:]
                corners += [centre - reach, centre + reach]
        corners = corners or [np.array(self.pose.position)]
        return np.min(corners, axis=0), np.max(corners, axis=0)

    def place_joints(self) -> None:
        """Set joints whose limits exclude zero to their initial positions."""
        for name, position in self.build.start.items():
            self.physics.data.qpos[int(self.physics.model.joint(name).qposadr[0])] = position

    def set_pose(self, pose: Pose) -> None:
        """Move the free links of the model as a whole; joints keep their positions."""
        data, model, free = self.physics.data, self.physics.model, self.build.free
        root = next(iter(free), None)
        change = pose @ self.pose.inverse if len(free) > 1 else pose
        for link, joint in free.items():
            address = int(model.joint(joint).qposadr[0])
            moved = pose @ self.model.links[link].pose if link == root else change @ self.link(link).pose
            x, y, z, w = moved.orientation
            data.qpos[address : address + 7] = (*moved.position, w, x, y, z)

    def set_velocity(self, linear: Array, angular: Array) -> None:
        """Set the linear and angular velocity of the model as a rigid body, in world axes."""
        data, model = self.physics.data, self.physics.model
        for link, joint in self.build.free.items():
            address = int(model.joint(joint).dofadr[0])
            data.qvel[address : address + 3] = linear
            data.qvel[address + 3 : address + 6] = self.link(link).rotation.T @ angular
