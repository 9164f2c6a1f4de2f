"""Elasticity of an arm: stiffness, backlash, damping, friction, masses and balancing per axis."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.jacobians import holding_torques
from daidalos.industry.robots.arm import Arm

PER_AXIS = (
    "stiffness", "backlash", "damping", "coulomb_friction", "breakaway_friction", "stribeck_speed", "viscous_friction",
    "mass", "balancing",
)  # fmt: skip
"""Quantities with one value per axis."""

TOOL_CENTRE = (0.0, 0.0, 0.25)
"""Centre of mass of a tool in tool0 where none is given [m]."""


@dataclass(frozen=True)
class Elasticity:
    """Elasticity of an arm; arrays have one value per axis.

    Attributes
    ----------
    stiffness : array of shape (6,)
        [Nm/rad]
    backlash : array of shape (6,)
        Whole play, from one flank to the other [rad].
    damping : array of shape (6,)
        Of the transmission [Nm s/rad].
    coulomb_friction, breakaway_friction : array of shape (6,)
        Of the bearings behind the gears, while moving and at the beginning of motion [Nm].
    stribeck_speed : array of shape (6,)
        Speed at which friction has fallen by 63 % of the difference of the two [rad/s].
    viscous_friction : array of shape (6,)
        [Nm s/rad]
    mass : array of shape (6,)
        Of links 1 to 6 [kg].
    centre_of_mass : array of shape (6, 3)
        In the frames of the links [m].
    balancing : array of shape (6,)
        Amplitude of the counterbalance, whose torque is amplitude * sin(angle) [Nm].
    uncertainty : dict of str to array
        Standard deviations of the quantities, in the same units.
    """

    stiffness: NDArray[np.float64]
    backlash: NDArray[np.float64]
    damping: NDArray[np.float64]
    coulomb_friction: NDArray[np.float64]
    breakaway_friction: NDArray[np.float64]
    stribeck_speed: NDArray[np.float64]
    viscous_friction: NDArray[np.float64]
    mass: NDArray[np.float64]
    centre_of_mass: NDArray[np.float64]
    balancing: NDArray[np.float64]
    uncertainty: dict[str, NDArray[np.float64]] = field(default_factory=dict)

    def friction(self, speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute the torques that overcome friction at joint speeds (..., 6) [rad/s], in [Nm].

        The curve is Stribeck's with an exponential (Armstrong-Helouvry, Dupont and Canudas de Wit, "A survey of models,
        analysis tools and compensation methods for the control of machines with friction", 1994).
        """
        excess = (self.breakaway_friction - self.coulomb_friction) * np.exp(-((speeds / self.stribeck_speed) ** 2))
        torques: NDArray[np.float64] = (
            np.sign(speeds) * (self.coulomb_friction + excess) + self.viscous_friction * speeds
        )
        return torques

    def gravity(self, arm: Arm, joints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute the torques that hold the links beside the counterbalance at joint angles (n, 6) [rad], in [Nm]."""
        held = holding_torques(arm, joints, self.mass, self.centre_of_mass)
        balanced: NDArray[np.float64] = held + self.balancing * np.sin(joints)
        return balanced

    def with_tool(self, mass: float, centre: tuple[float, float, float] = TOOL_CENTRE) -> Elasticity:
        """Return the elasticity with a tool on the flange.

        Parameters
        ----------
        mass : float
            Of the tool [kg].
        centre : tuple of float
            Its centre of mass in tool0 [m].
        """
        in_link = np.array([centre[2], centre[1], -centre[0]])  # tool0 is link 6 turned by 90 degrees about y
        masses, centres = self.mass.copy(), self.centre_of_mass.copy()
        masses[5] += mass
        if masses[5] > 0.0:
            centres[5] = (self.mass[5] * centres[5] + mass * in_link) / masses[5]
        return replace(self, mass=masses, centre_of_mass=centres)
