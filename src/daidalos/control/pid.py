"""PID control of several joints at once, with the gains and anti-windup strategies of ROS's control toolbox.

Åström and Hägglund, *Advanced PID Control*, ISA 2006, chapters 3.4 (parallel form) and 3.5 (windup).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter

STRATEGIES = ("none", "legacy", "back_calculation", "conditional_integration")


@dataclass(frozen=True)
class Gains(Parameters):
    """Gains of one loop: ``u = p e + i int(e) + d de/dt``.

    Anti-windup: ``none`` only clamps; ``legacy`` is the same, for old files; ``conditional_integration`` rests while
    the output is saturated and the error drives it further; ``back_calculation`` bleeds the integral by
    what was cut off.
    """

    p: float = parameter(0.0, "Proportional gain.")
    i: float = parameter(0.0, "Integral gain.")
    d: float = parameter(0.0, "Derivative gain.")
    i_clamp_max: float = parameter(math.inf, "Upper limit of the integral term, in units of the output.")
    i_clamp_min: float = parameter(-math.inf, "Lower limit of the integral term, in units of the output.")
    u_clamp_max: float = parameter(math.inf, "Upper limit of the output.")
    u_clamp_min: float = parameter(-math.inf, "Lower limit of the output.")
    antiwindup_strategy: str = parameter(
        "none", "What happens to the integral while the output is saturated.", choices=STRATEGIES
    )
    tracking_time_constant: float = parameter(
        0.0, "Time constant of back_calculation; 0 for sqrt(d / i), or p / i where d is 0.", unit="s", minimum=0.0
    )
    error_deadband: float = parameter(0.0, "Error up to which nothing is integrated.", minimum=0.0)


class Pid:
    """PID control of n independent loops.

    Parameters
    ----------
    gains : sequence of n Gains

    Attributes
    ----------
    p_term, i_term, d_term : array (n,)
        Parts of the last output.
    error, error_rate : array (n,)
        Of the last update.

    Raises
    ------
    ParameterError
        When a lower clamp is above the upper one.
    """

    def __init__(self, gains: Sequence[Gains]) -> None:
        self.set_gains(gains)
        self.reset()

    def set_gains(self, gains: Sequence[Gains]) -> None:
        """Set the gains without a change of the integrals; raises the same errors as the class."""
        for one in gains:
            for kind in ("i_clamp", "u_clamp"):
                lower, upper = getattr(one, f"{kind}_min"), getattr(one, f"{kind}_max")
                if lower > upper:
                    raise ParameterError(f"{kind}_min", f"is above {kind}_max: {lower:g} > {upper:g}")
        self._count = len(gains)
        names = ("p", "i", "d", "i_clamp_min", "i_clamp_max", "u_clamp_min", "u_clamp_max", "error_deadband")
        table = np.array([[getattr(one, name) for one in gains] for name in names]).reshape(len(names), -1)
        self._p, self._i, self._d, self._i_min, self._i_max, self._u_min, self._u_max, self._deadband = table
        self._conditional = np.array([one.antiwindup_strategy == "conditional_integration" for one in gains])
        self._back_calculation_rate = np.array([_back_calculation_rate(one) for one in gains])
        self._simple = not (self._conditional.any() or self._back_calculation_rate.any() or self._deadband.any())

    def reset(self, keep_integral: bool = False) -> None:
        """Reset integral and derivative."""
        if not keep_integral:
            self.i_term = np.zeros(self._count)
        self.p_term = np.zeros(self._count)
        self.d_term = np.zeros(self._count)
        self.error = np.zeros(self._count)
        self.error_rate = np.zeros(self._count)
        self._fresh = True

    def update(self, error: Array, period: float, error_rate: Array | None = None) -> Array:
        """Return the outputs (n,).

        Parameters
        ----------
        error : array (n,)
            Reference less measurement.
        period : float
            Time since the last update [s]; with 0 nothing is integrated.
        error_rate : array (n,) or None
            Its derivative; the difference to the last error where None.
        """
        if error_rate is None:
            known = not self._fresh and period > 0.0
            error_rate = (error - self.error) / period if known else np.zeros(self._count)
        self._fresh = False
        self.error, self.error_rate = error, error_rate
        self.p_term = self._p * error
        self.d_term = self._d * error_rate
        wanted = self.p_term + self.i_term + self.d_term
        change = self._i * error * period
        if not self._simple:
            change = self._allowed(change, error, wanted, period)
        self.i_term = np.minimum(np.maximum(self.i_term + change, self._i_min), self._i_max)
        output: Array = np.minimum(np.maximum(self.p_term + self.i_term + self.d_term, self._u_min), self._u_max)
        return output

    def _allowed(self, change: Array, error: Array, wanted: Array, period: float) -> Array:
        """Return the part of the integral's change that the anti-windup strategies allow."""
        saturated = np.minimum(np.maximum(wanted, self._u_min), self._u_max)
        further = (wanted != saturated) & (wanted * error > 0.0)
        change = np.where(self._conditional & further, 0.0, change)
        change = np.where(np.abs(error) < self._deadband, 0.0, change)
        allowed: Array = change + self._back_calculation_rate * (saturated - wanted) * period
        return allowed


def _back_calculation_rate(gains: Gains) -> float:
    """Return the rate [1/s] at which back calculation empties the integral."""
    if gains.antiwindup_strategy != "back_calculation" or gains.i == 0.0:
        return 0.0
    constant = gains.tracking_time_constant
    if constant == 0.0:
        constant = math.sqrt(abs(gains.d / gains.i)) if gains.d else abs(gains.p / gains.i)
    return 1.0 / constant if constant > 0.0 else 0.0
