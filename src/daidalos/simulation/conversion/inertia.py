"""Physically valid mass properties for MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, Quaternion, multiply, quaternion_from_matrix
from daidalos.description.link import Inertial

MIN_MASS = 1e-3
MIN_INERTIA = 1e-9


@dataclass(frozen=True)
class PrincipalInertia:
    """Mass, centre of mass and inertia about the principal axes.

    Parameters
    ----------
    mass : float
        [kg].
    position : tuple of 3 floats
        Centre of mass in the link [m].
    orientation : tuple of 4 floats
        Principal axes in the link, x, y, z, w.
    moments : array (3,)
        [kg m^2].
    changed : str
        What had to be changed, empty when nothing.
    """

    mass: float
    position: tuple[float, float, float]
    orientation: Quaternion
    moments: NDArray[np.float64]
    changed: str = ""


def principal_inertia(inertial: Inertial) -> PrincipalInertia:
    """Return mass properties in principal axes, corrected where they are physically impossible.

    Moments are raised until each is positive and none is larger than the other two together.
    """
    xx, xy, xz, yy, yz, zz = inertial.inertia
    moments, axes = np.linalg.eigh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    orientation = multiply(inertial.pose.orientation, quaternion_from_matrix(axes))
    changed = ""
    if moments[0] < MIN_INERTIA:
        if moments[0] < -1e-12 or moments[2] < MIN_INERTIA:
            changed = f"the inertia has moments {_words(moments)}, raised to at least {MIN_INERTIA:g}"
        moments = np.maximum(moments, MIN_INERTIA)
    excess = (1 + 1e-6) * moments[2] - moments[0] - moments[1]
    if excess > 0:
        if excess > 1e-3 * moments[2]:
            changed = f"no body has the moments of inertia {_words(moments)}; the smaller ones were raised"
        moments = moments + np.array([0.5, 0.5, 0.0]) * excess
    return PrincipalInertia(inertial.mass, inertial.pose.position, orientation, moments, changed)


def min_inertia() -> PrincipalInertia:
    """Return the mass properties of a moving link without mass."""
    pose = Pose()
    return PrincipalInertia(MIN_MASS, pose.position, pose.orientation, np.full(3, 1e-6))


def _words(moments: NDArray[np.float64]) -> str:
    return ", ".join(f"{moment:.3g}" for moment in moments)
