"""Robot dynamics by MuJoCo: Jacobians, mass matrix, bias forces and inverse dynamics."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from dataclasses import replace

import mujoco
import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.gazebo import model_from_robot
from daidalos.description.joint import Joint, JointType
from daidalos.description.robot import Robot
from daidalos.description.world import Model
from daidalos.simulation.conversion.assets import Assets
from daidalos.simulation.conversion.build import add_model
from daidalos.simulation.errors import SimulationError, UnknownNameError

_log = logging.getLogger(__name__)
_TURNING = (JointType.REVOLUTE, JointType.CONTINUOUS)
_SIMPLE = (*_TURNING, JointType.PRISMATIC, JointType.FIXED, JointType.FLOATING)


class Dynamics:
    """Rigid-body dynamics of a robot with a fixed root.

    All coordinates are those of its movable joints; friction, damping, limits and whom joints mimic do not
    count. Not made for use from several threads at once.

    Parameters
    ----------
    robot : Robot or Model
        Of revolute, continuous, prismatic and fixed joints.
    gravity : tuple of 3 floats
        [m/s^2], in the root's frame.

    Attributes
    ----------
    joint_names : tuple of n strings
        The order of positions, velocities and efforts.

    Raises
    ------
    SimulationError
        When a joint has more than one degree of freedom, or the robot cannot be simulated.
    """

    def __init__(self, robot: Robot | Model, gravity: tuple[float, float, float] = (0.0, 0.0, -9.8)) -> None:
        model = model_from_robot(robot) if isinstance(robot, Robot) else robot
        for joint in model.joints.values():
            if joint.type not in _SIMPLE:
                raise SimulationError(f"joint {joint.name!r} is {joint.type.value}, which has no single coordinate")
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        spec.option.gravity = list(gravity)
        build = add_model(spec, Assets(spec), _held(model), "robot", Pose(), _log.debug)
        try:
            self._model = spec.compile()
        except ValueError as problem:
            raise SimulationError(f"robot {model.name!r} has no dynamics: {' '.join(str(problem).split())}") from None
        self._data = mujoco.MjData(self._model)
        self._bodies = {link: self._model.body(build.scoped(link)).id for link in build.bodies}
        moving = [(self._model.joint(added[0]), name) for name, added in build.joints.items() if added]
        moving.sort(key=lambda pair: int(pair[0].dofadr[0]))
        self.joint_names = tuple(name for _, name in moving)

    def positions(self, values: Mapping[str, float]) -> Array:
        """Return positions (n,) with the named joints set and the others at zero.

        Raises
        ------
        UnknownNameError
        """
        positions = np.zeros(len(self.joint_names))
        for name, value in values.items():
            if name not in self.joint_names:
                raise UnknownNameError("movable joint", name, self.joint_names)
            positions[self.joint_names.index(name)] = value
        return positions

    def jacobian(self, positions: Array, link: str, point: Iterable[float] = (0.0, 0.0, 0.0)) -> Array:
        """Return the Jacobian (6, n) of a point on a link: its linear velocity, then the link's angular one.

        Parameters
        ----------
        positions : array (n,)
            [rad, m].
        link : str
        point : 3 floats
            In the link's frame [m].

        Raises
        ------
        UnknownNameError
        """
        if link not in self._bodies:
            raise UnknownNameError("link", link, self._bodies)
        self._set(positions)
        body = self._bodies[link]
        place = self._data.xpos[body] + self._data.xmat[body].reshape(3, 3) @ np.array(list(point), dtype=float)
        jacobian = np.zeros((6, self._model.nv))
        mujoco.mj_jac(self._model, self._data, jacobian[:3], jacobian[3:], place, body)
        return jacobian

    def mass_matrix(self, positions: Array) -> Array:
        """Return the joint-space mass matrix (n, n) [kg m^2, kg]."""
        self._set(positions)
        mujoco.mj_crb(self._model, self._data)
        matrix = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_fullM(self._model, self._data, matrix)
        return matrix

    def bias(self, positions: Array, velocities: Array) -> Array:
        """Return the bias efforts (n,) of gravity, Coriolis and centrifugal forces [N m, N]."""
        return self.inverse(positions, velocities, np.zeros(len(self.joint_names)))

    def inverse(self, positions: Array, velocities: Array, accelerations: Array) -> Array:
        """Return the efforts (n,) for joint accelerations: M a + bias [N m, N]."""
        self._set(positions, velocities)
        self._data.qacc[:] = accelerations
        efforts = np.zeros(self._model.nv)
        mujoco.mj_rne(self._model, self._data, 1, efforts)
        return efforts

    def forward(self, positions: Array, velocities: Array, efforts: Array) -> Array:
        """Return the accelerations (n,) caused by efforts [rad/s^2, m/s^2]."""
        rest: Array = np.asarray(efforts, dtype=np.float64) - self.bias(positions, velocities)
        return np.asarray(np.linalg.solve(self.mass_matrix(positions), rest), dtype=np.float64)

    def _set(self, positions: Array, velocities: Array | None = None) -> None:
        self._data.qpos[:] = positions
        self._data.qvel[:] = 0.0 if velocities is None else velocities
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_comVel(self._model, self._data)


def _held(model: Model) -> Model:
    """Fix all roots of a model to the world."""
    held = {joint.child for joint in model.joints.values()}
    roots = [name for name in model.links if name not in held]
    fixed = {
        f"{name}::held": Joint(f"{name}::held", JointType.FIXED, "world", name, origin=model.links[name].pose)
        for name in roots
    }
    return replace(model, joints={**model.joints, **fixed}, static=False)
