"""Joint motors that follow commanded positions, velocities or efforts of controllers."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import rotation_matrix
from daidalos.simulation.errors import UnknownNameError

if TYPE_CHECKING:
    from daidalos.simulation.conversion.model_build import ModelBuild
    from daidalos.simulation.instance import Instance

Indices = NDArray[np.intp]

SPEED_TIME = 0.0025
"""Time constant with which a driven wheel takes a speed [s]."""
DAMPING_TIME, POSITION_TIME = 0.00125, 0.005
"""Time constants with which a joint takes a speed and a position: critically damped [s]."""
_ROUND = 0.8
"""Required evenness of the mass around an axle for a wheel."""
MAX_LEAD = 0.05
"""Maximum lead of a velocity servo's reference over a blocked joint [rad, m]."""


class Mode(IntEnum):
    """Control mode of a joint's motor."""

    FREE = 0
    HOLD = 1
    POSITION = 2
    VELOCITY = 3
    EFFORT = 4


@dataclass
class DriveState:
    """State of n drives.

    Parameters
    ----------
    modes : array (n,) of int
        `Mode` of each.
    targets : array (n,)
        Position, speed or effort, as its mode says; NaN where there is none, and the joint is held.
    """

    modes: NDArray[np.int8]
    targets: Array


class JointDrives:
    """Motors on joints of one model.

    Positions are followed by a stiff servo whose reference moves evenly from one command to the next, so that a
    joint is where it was told one period later and moves without ripple. Speeds of wheels are held by a servo with
    a rotor as heavy as what it drives, so that wheels roll true; speeds of other joints by a reference that
    integrates the speed, which gravity does not bend.

    Parameters
    ----------
    efforts : mapping
        Joints with a motor: largest force or torque that it has [N, N m].
    names : sequence of str
        All joints whose state is asked for.
    spinning : collection of str
        Joints with a motor of which only speeds and efforts are commanded; those that turn wheels are driven as
        wheels.
    """

    def __init__(self, efforts: Mapping[str, float], names: Sequence[str], spinning: Collection[str] = ()) -> None:
        self.efforts = dict(efforts)
        self.names = tuple(names)
        self.driven = tuple(efforts)
        self._spinning = frozenset(spinning)
        self._wheels = np.zeros(len(self.driven), dtype=bool)
        self._applied: NDArray[np.int8] | None = None

    def start(self, hold: bool) -> DriveState:
        """Return the state without commands: joints held or free."""
        mode = Mode.HOLD if hold else Mode.FREE
        return DriveState(np.full(len(self.driven), mode, dtype=np.int8), np.full(len(self.driven), np.nan))

    def prepare(self, build: ModelBuild) -> None:
        """Add a position servo and a servo for velocities and efforts to each joint."""
        wheels = {joint: radius for joint in self._spinning if (radius := _wheel_radius(build, joint)) > 0.0}
        mass = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        self._wheels = np.array([joint in wheels for joint in self.driven], dtype=bool)
        self._actuators: list[tuple[str, str]] = []
        for joint in self.driven:
            if not build.joints.get(joint):
                raise UnknownNameError("movable joint", joint, [n for n, added in build.joints.items() if added])
            if joint in wheels:
                build.spec.joint(build.joints[joint][0]).armature = mass * wheels[joint] ** 2 / len(wheels)
            self._actuators.append(self._add(build, joint))

    def _add(self, build: ModelBuild, joint: str) -> tuple[str, str]:
        import mujoco

        names = []
        for kind in ("reference", "motor"):
            actuator = build.spec.add_actuator(
                name=f"{build.scoped(joint)}::{kind}",
                trntype=mujoco.mjtTrn.mjTRN_JOINT,
                target=build.joints[joint][0],
            )
            actuator.gaintype = mujoco.mjtGain.mjGAIN_FIXED
            actuator.biastype = mujoco.mjtBias.mjBIAS_AFFINE
            if kind == "reference":
                actuator.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
            actuator.gainprm[0] = 0.0
            effort = self.efforts[joint]
            if math.isfinite(effort):
                actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
                actuator.forcerange = [-effort, effort]
            names.append(str(actuator.name))
        return names[0], names[1]

    def bind(self, instance: Instance) -> None:
        """Find joints and servos in the compiled model."""
        self._instance = instance
        views = [instance.joint(name) for name in self.names]
        self._qpos = np.array([view.qpos for view in views], dtype=np.intp)
        self._dof = np.array([view.dof for view in views], dtype=np.intp)
        own = [instance.joint(name) for name in self.driven]
        self._own_qpos = np.array([view.qpos for view in own], dtype=np.intp)
        self._own_dof = np.array([view.dof for view in own], dtype=np.intp)
        model = instance.physics.model
        self._reference = np.array([instance.actuator(name) for name, _ in self._actuators], dtype=np.intp)
        self._motor = np.array([instance.actuator(name) for _, name in self._actuators], dtype=np.intp)
        self._act = np.array([int(model.actuator_actadr[place]) for place in self._reference], dtype=np.intp)
        inertia = np.array(model.dof_M0)[self._own_dof]
        self._damping = inertia / DAMPING_TIME
        self._stiffness = self._damping / POSITION_TIME
        self._speed_gain = inertia / SPEED_TIME
        self._applied = None

    # What is measured.

    @property
    def positions(self) -> Array:
        """Positions of all `names` [rad, m]."""
        return np.array(self._instance.physics.data.qpos[self._qpos])

    @property
    def velocities(self) -> Array:
        """Velocities of all `names` [rad/s, m/s]."""
        return np.array(self._instance.physics.data.qvel[self._dof])

    @property
    def efforts_now(self) -> Array:
        """Motor efforts of all `names` in the last step [N m, N]."""
        return np.array(self._instance.physics.data.qfrc_actuator[self._dof])

    def place(self, positions: Mapping[str, float]) -> None:
        """Set joints to positions at rest; the motors continue from there."""
        self._applied = None
        data = self._instance.physics.data
        for name, position in positions.items():
            view = self._instance.joint(name)
            data.qpos[view.qpos], data.qvel[view.dof] = position, 0.0
        self._instance.physics.changed()

    # What is commanded.

    def command(self, state: DriveState, period: float) -> None:
        """Apply the commands for a period.

        Parameters
        ----------
        state : DriveState
        period : float
            Until the next command [s].
        """
        idle = np.isnan(state.targets) & (state.modes >= Mode.POSITION)
        modes = np.where(idle, Mode.HOLD, state.modes).astype(np.int8)
        values = np.nan_to_num(state.targets)
        data = self._instance.physics.data
        at = data.qpos[self._own_qpos]
        if self._applied is None or not np.array_equal(modes, self._applied):
            self._apply(modes, at)
        servo = self._uses_reference(modes)
        reference = data.act[self._act]
        speed = np.where(modes == Mode.POSITION, (values - reference) / period, 0.0)
        turning = servo & (modes == Mode.VELOCITY)
        if turning.any():
            speed = np.where(turning, values, speed)
            reference = np.where(turning, np.clip(reference, at - MAX_LEAD, at + MAX_LEAD), reference)
            data.act[self._act] = reference
        model = self._instance.physics.model
        data.ctrl[self._reference] = speed
        model.actuator_biasprm[self._reference, 0] = np.where(servo, self._damping * speed, 0.0)
        data.ctrl[self._motor] = np.where(modes >= Mode.VELOCITY, values, 0.0)

    def _uses_reference(self, modes: NDArray[np.int8]) -> NDArray[np.bool_]:
        """Return for which joints the servo with a reference is active."""
        result: NDArray[np.bool_] = (modes == Mode.POSITION) | (
            ~self._wheels & ((modes == Mode.HOLD) | (modes == Mode.VELOCITY))
        )
        return result

    def _apply(self, modes: NDArray[np.int8], at: Array) -> None:
        """Set the gains of the modes; a newly used reference starts at the joint's position."""
        physics = self._instance.physics
        model, data = physics.model, physics.data
        servo = self._uses_reference(modes)
        before = servo & False if self._applied is None else self._uses_reference(self._applied)
        data.act[self._act] = np.where(servo & before, data.act[self._act], at)
        model.actuator_gainprm[self._reference, 0] = np.where(servo, self._stiffness, 0.0)
        model.actuator_biasprm[self._reference, 1] = np.where(servo, -self._stiffness, 0.0)
        model.actuator_biasprm[self._reference, 2] = np.where(servo, -self._damping, 0.0)
        rolls = self._wheels & ((modes == Mode.HOLD) | (modes == Mode.VELOCITY))
        pushes = modes == Mode.EFFORT
        model.actuator_gainprm[self._motor, 0] = np.where(rolls, self._speed_gain, np.where(pushes, 1.0, 0.0))
        model.actuator_biasprm[self._motor, 2] = np.where(rolls, -self._speed_gain, 0.0)
        self._applied = modes


def _wheel_radius(build: ModelBuild, name: str) -> float:
    """Return the radius of the wheel that a continuous joint turns, 0 without a wheel.

    A wheel is what lies evenly about its axle, whatever shape it is described by.
    """
    joint = build.model.joints.get(name)
    if joint is None or not joint.axes or math.isfinite(joint.axis.upper):
        return 0.0
    from daidalos.description.errors import DescriptionError
    from daidalos.description.meshes import triangles_of

    corners = []
    for collision in build.model.links[joint.child].collisions:
        try:
            vertices = triangles_of(collision.geometry).vertices
        except (DescriptionError, TypeError):
            continue  # what it cannot be made of is said where collisions are added
        turn = rotation_matrix(collision.pose.orientation)
        corners.append(vertices @ turn.T + np.array(collision.pose.position) - np.array(joint.anchor.position))
    if not corners:
        return 0.0
    points = np.concatenate(corners)
    axle = rotation_matrix(joint.anchor.orientation) @ np.array(joint.axis.xyz)
    across = np.linalg.svd(axle[None, :])[2][1:] @ points.T
    radius = float(np.max(np.linalg.norm(across, axis=0)))
    reach = min(*np.max(across, axis=1), *np.max(-across, axis=1))
    return radius if reach > _ROUND * radius else 0.0
