"""Admittance control: motion of a tip under forces as of a mass on a spring and a damper.

Hogan, *Impedance Control: An Approach to Manipulation*, Journal of Dynamic Systems, Measurement, and Control 107, 1985.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import quaternion_from_matrix, rotation_vector
from daidalos.control.chain import Chain


@dataclass(frozen=True, eq=False)
class AdmittanceLaw:
    """Admittance law along and about the axes of the control frame; each (6,), linear parts first.

    Parameters
    ----------
    selected : array of bool
        Where it yields.
    mass, damping, stiffness : array
        [kg, kg m^2], [N s/m, N m s/rad], [N/m, N m/rad].
    joint_damping : float
        Slows the joints' own drift [1/s].
    alpha : float
        Damping of the inverse kinematics near singular positions.
    """

    selected: NDArray[np.bool_]
    mass: Array
    damping: Array
    stiffness: Array
    joint_damping: float = 5.0
    alpha: float = 0.0005

    @classmethod
    def of_ratio(
        cls,
        selected: NDArray[np.bool_],
        mass: Array,
        damping_ratio: Array,
        stiffness: Array,
        joint_damping: float = 5.0,
        alpha: float = 0.0005,
    ) -> AdmittanceLaw:
        """Return the law whose damping is `damping_ratio` times the critical one over two."""
        damping = 2.0 * damping_ratio * np.sqrt(mass * stiffness)
        return cls(selected, mass, damping, stiffness, joint_damping, alpha)


@dataclass
class AdmittanceState:
    """Current compliant displacement of the tip.

    Parameters
    ----------
    joints, joint_velocities : array (n,)
        Offset of the joints, and its rate.
    offset, velocity, acceleration : array (6,)
        Of the tip in the base's axes.
    """

    joints: Array
    joint_velocities: Array
    offset: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def none(cls, count: int) -> AdmittanceState:
        """Return the state of a tip without offset."""
        return cls(np.zeros(count), np.zeros(count), np.zeros(6), np.zeros(6), np.zeros(6))


def advance(
    law: AdmittanceLaw,
    chain: Chain,
    state: AdmittanceState,
    reference: Array,
    control_rotation: Array,
    wrench: Array,
    period: float,
) -> AdmittanceState:
    """Return the state of the admittance law one period later.

    Parameters
    ----------
    law : AdmittanceLaw
    chain : Chain
    state : Yielding
    reference : array (n,)
        Where the joints would be without forces.
    control_rotation : array (3, 3)
        Of the control frame in the base.
    wrench : array (6,)
        On the tip, in the base's axes [N, N m].
    period : float
        [s].
    """
    wanted, turned = chain.pose(reference)
    position, rotation = chain.pose(reference + state.joints)
    offset = np.concatenate((position - wanted, rotation_vector(quaternion_from_matrix(rotation @ turned.T))))
    jacobian = chain.jacobian(reference + state.joints)
    velocity = jacobian @ state.joint_velocities

    def in_control_frame(values: Array) -> Array:
        return np.concatenate((control_rotation.T @ values[:3], control_rotation.T @ values[3:]))

    force = np.where(law.selected, in_control_frame(wrench), 0.0)
    pull = force - law.damping * in_control_frame(velocity) - law.stiffness * in_control_frame(offset)
    local = pull / law.mass
    acceleration = np.concatenate((control_rotation @ local[:3], control_rotation @ local[3:]))
    damped = jacobian.T @ jacobian + law.alpha * np.eye(jacobian.shape[1])
    joint_accelerations = np.linalg.solve(damped, jacobian.T @ acceleration)
    joint_accelerations = joint_accelerations - law.joint_damping * state.joint_velocities
    joint_velocities = state.joint_velocities + joint_accelerations * period
    return AdmittanceState(state.joints + joint_velocities * period, joint_velocities, offset, velocity, acceleration)


def without_weight(wrench: Array, rotation: Array, weight: float, centre: Array, down: Array) -> Array:
    """Return a sensor's wrench without the weight of the tool on it.

    Parameters
    ----------
    wrench : array (6,)
        In the sensor's axes.
    rotation : array (3, 3)
        Of the sensor in the base.
    weight : float
        Of the tool [N].
    centre : array (3,)
        Of the tool's mass, from the sensor, in the base's axes [m].
    down : array (3,)
        Direction of gravity in the base.

    Returns
    -------
    array (6,)
        In the base's axes.
    """
    turned = np.concatenate((rotation @ wrench[:3], rotation @ wrench[3:]))
    pull = weight * down
    return turned - np.concatenate((pull, np.cross(centre, pull)))
