"""Commands to plugins and controllers.

Units are SI. The commands of controllers that need more than these are in `daidalos.samples.controllers`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from daidalos.common.arrays import Array


@dataclass(frozen=True, eq=False)
class TwistCommand:
    """Commanded velocity in the frame of the base.

    Parameters
    ----------
    linear, angular : array (3,)
        [m/s, rad/s].
    """

    linear: Array = field(default_factory=lambda: np.zeros(3))
    angular: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True, eq=False)
class WrenchCommand:
    """Commanded force (3,) [N] and torque (3,) [N m]."""

    force: Array = field(default_factory=lambda: np.zeros(3))
    torque: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True)
class SignalCommand:
    """Trigger."""


@dataclass(frozen=True)
class FlagCommand:
    """Boolean command."""

    value: bool = False


@dataclass(frozen=True, eq=False)
class NumberCommand:
    """Commanded position, speed or effort of one joint."""

    value: float = 0.0


@dataclass(frozen=True, eq=False)
class PositionTrajectoryCommand:
    """Positions of joints over time.

    Parameters
    ----------
    joints : tuple of n strings
    times : array (k,)
        From the start [s].
    positions : array (k, n)
        [rad, m].
    """

    joints: tuple[str, ...]
    times: Array
    positions: Array
